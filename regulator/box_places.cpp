// SPDX-License-Identifier: Apache-2.0
#include "regulator/box_places.h"

#include <algorithm>
#include <cmath>

#include "regulator/projected_motion.h"

namespace talisman::regulator {

using layers::Affine2;
using layers::dvec2;
using layers::dvec3;
using layers::dvec4;
using layers::RectD;

namespace {

constexpr double kAround_texels = 1;  ///< the antialiased edge, and what a bilinear look-up reads

}  // namespace

std::vector<dvec3> box_corners(const LayerContent& content, const ContentView& seen) {
  std::vector<dvec3> corners;
  corners.reserve(kBoxCorners * content.boxes.size());
  for (const ContentBox& box : content.boxes) {
    const PlaceMap& map = seen.screen_from_part[box.part];
    for (std::size_t k = 0; k < kBoxCorners; ++k)
      corners.push_back(map * dvec4(k & 1 ? box.hi.x : box.lo.x, k & 2 ? box.hi.y : box.lo.y,
                                    k & 4 ? box.hi.z : box.lo.z, 1));
  }
  return corners;
}

dvec3 mapped(const Affine2& map, const dvec3& place) {
  return {map.a * place.x + map.b * place.y + map.tx * place.z,
          map.c * place.x + map.d * place.y + map.ty * place.z, place.z};
}

namespace {

using Corners = std::array<dvec3, kBoxCorners>;

struct BoxView {
  dvec2 size;
  double margin, near_m;
};

/// Sides of the rectangle on which all places lie, one bit each, and whether they are before the near plane. Half-spaces,
/// since near the eye's plane quotients are far off.
struct BoxSides {
  unsigned common = 0x1f;
  bool all_before = true;
  RectD bounds;
};

BoxSides sides_of(const Corners& places, const BoxView& view) {
  BoxSides sides;
  for (const dvec3& p : places) {
    const bool is_before = p.z > view.near_m;
    sides.common &= static_cast<unsigned>(p.x < -view.margin * p.z) |
                    static_cast<unsigned>(p.x > (view.size.x + view.margin) * p.z) << 1 |
                    static_cast<unsigned>(p.y < -view.margin * p.z) << 2 |
                    static_cast<unsigned>(p.y > (view.size.y + view.margin) * p.z) << 3 |
                    static_cast<unsigned>(!is_before) << 4;
    sides.all_before = sides.all_before && is_before;
    if (is_before) sides.bounds.include(dvec2(p) / p.z);
  }
  return sides;
}

/// Of the part before the near plane, where its edges meet that.
void include_cut(const Corners& places, double near_m, RectD& bounds) {
  for (unsigned k = 0; k < kBoxCorners; ++k)
    for (const unsigned axis : {1u, 2u, 4u}) {
      const dvec3 &a = places[k], &b = places[k | axis];
      if ((a.z > near_m) == (b.z > near_m)) continue;
      const double share = (near_m - a.z) / (b.z - a.z);
      bounds.include((dvec2(a) + share * dvec2(b - a)) / near_m);
    }
}

/// Of a box that is cut by the near plane: its eighths, as often as that tells what of it is seen.
void include_eighths(const Corners& places, const BoxView& view, int times, RectD& bounds) {
  const BoxSides sides = sides_of(places, view);
  if (sides.common != 0) return;
  if (sides.all_before || times == 0) {
    RectD seen = sides.bounds;
    if (!sides.all_before && view.near_m > 0) include_cut(places, view.near_m, seen);
    bounds.include(seen.lo);
    bounds.include(seen.hi);
    return;
  }
  for (unsigned eighth = 0; eighth < kBoxCorners; ++eighth) {
    Corners part;
    for (unsigned k = 0; k < kBoxCorners; ++k) {
      // Half way from corner `eighth` to corner k, along each axis on which they differ.
      dvec3 sum(0, 0, 0);
      for (unsigned c = 0; c < kBoxCorners; ++c) {
        double weight = 1;
        for (const unsigned axis : {1u, 2u, 4u}) {
          const bool differs = ((eighth ^ k) & axis) != 0, other = ((eighth ^ c) & axis) != 0;
          weight *= differs ? 0.5 : other ? 0.0 : 1.0;
        }
        if (weight > 0) sum += weight * places[c];
      }
      part[k] = sum;
    }
    include_eighths(part, view, times - 1, bounds);
  }
}

}  // namespace

BoxReach box_reach(BoxCorners corners, const Affine2& map, dvec2 size, double margin, double near_m) {
  constexpr int kTimesHalved = 2;
  const BoxView view{size, margin, near_m};
  Corners places;
  for (std::size_t k = 0; k < kBoxCorners; ++k) {
    places[k] = mapped(map, corners[k]);
    if (!std::isfinite(places[k].x + places[k].y + places[k].z))
      return {BoxSight::Unbounded, {{-margin, -margin}, size + margin}};
  }
  const BoxSides sides = sides_of(places, view);
  if (sides.common != 0) return {};
  if (sides.all_before) return {BoxSight::Inside, sides.bounds};
  BoxReach reach;
  include_eighths(places, view, kTimesHalved, reach.bounds);
  if (!reach.bounds.empty()) reach.sight = BoxSight::Unbounded;
  return reach;
}

RectD box_bounds(BoxCorners corners, const Affine2& map) {
  RectD bounds;
  for (const dvec3& corner : corners)
    if (const dvec3 p = mapped(map, corner); p.z > 0) bounds.include(dvec2(p) / p.z);
  return bounds;
}

ChunkRect chunks_in(const layers::RectD& bounds, layers::ivec2 count) {
  const auto chunk = [](double texel, int most) {
    return static_cast<int>(std::clamp(std::floor(texel / kRefreshChunk), -1.0, double(most)));
  };
  return {std::max(chunk(bounds.lo.x - kAround_texels, count.x), 0),
          std::max(chunk(bounds.lo.y - kAround_texels, count.y), 0),
          std::min(chunk(bounds.hi.x + kAround_texels, count.x) + 1, count.x),
          std::min(chunk(bounds.hi.y + kAround_texels, count.y) + 1, count.y)};
}

double apart_px(BoxCorners corners_a, const Affine2& map_a, BoxCorners corners_b) {
  static const DisplayScale in_px(layers::CameraState{}, {2, 2});  // places are pixels already
  std::array<dvec4, kBoxCorners> a, b;
  const auto as_clip = [](const dvec3& p) { return dvec4(p.x, p.y, p.z, p.z); };
  for (std::size_t k = 0; k < kBoxCorners; ++k) {
    a[k] = as_clip(mapped(map_a, corners_a[k]));
    b[k] = as_clip(corners_b[k]);
  }
  const ProjectedMotion motion = projected_motion(a, b, in_px);
  return motion.bounded ? std::min(motion.px, warp::kHugePx) : warp::kHugePx;
}

}  // namespace talisman::regulator
