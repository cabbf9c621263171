// SPDX-License-Identifier: Apache-2.0
#include "fiducials/place_floor.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "layers/inline_vector.h"

namespace talisman::fiducials {

namespace {

using layers::dvec2;
using layers::dvec4;

/// Coordinates beyond this are not looked at: their rounding would no longer be small.
constexpr double kLargest_px = 1e6;
constexpr double kRounding_px = 1e-6;
/// Of ŷ, how much must not be in line with x̂.
constexpr double kLeastAcross = 1e-3;

using Column = layers::InlineVector<double, layers::Correspondences::kRoom>;

/// By point: is it a corner of the surface?
layers::InlineVector<char, layers::Correspondences::kRoom> corners_of(const layers::Polyhedron& hull,
                                                                      std::size_t points) {
  layers::InlineVector<char, layers::Correspondences::kRoom> is_corner;
  for (std::size_t i = 0; i < points; ++i) is_corner.push_back(0);
  for (const auto& triangle : hull.triangles)
    for (const int corner : triangle)
      if (static_cast<std::size_t>(corner) < points) is_corner[corner] = 1;
  return is_corner;
}

/// Is the point matched for certain: on the display now, and within the display or beside it then?
bool is_matched(const layers::LayerState& state, const dvec4& clip, double displays) {
  return clip.w > state.camera.near_m * (1 + 1e-6) && std::abs(clip.x) <= displays * clip.w &&
         std::abs(clip.y) <= displays * clip.w;
}

void centre(Column& column) {
  double mean = 0;
  for (std::size_t i = 0; i < column.size(); ++i) mean += column[i];
  mean /= static_cast<double>(column.size());
  for (std::size_t i = 0; i < column.size(); ++i) column[i] -= mean;
}

double dot(const Column& a, const Column& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// Takes the part along the unit vector away, twice: what is left is orthogonal to rounding.
void remove(const Column& unit, Column& from) {
  for (int pass = 0; pass < 2; ++pass) {
    const double along = dot(unit, from);
    for (std::size_t i = 0; i < from.size(); ++i) from[i] -= along * unit[i];
  }
}

/// To unit length; false where there is too little of it.
bool normalize(Column& column, double least) {
  const double length = std::sqrt(dot(column, column));
  if (!(length > least)) return false;
  for (std::size_t i = 0; i < column.size(); ++i) column[i] /= length;
  return true;
}

/// Where points were and where they are, by coordinate.
struct PlacePairs {
  Column x, y, u, v;

  /// False where a coordinate is too large for rounding to be small.
  bool add(const dvec2& then, const dvec2& now) {
    x.push_back(then.x);
    y.push_back(then.y);
    u.push_back(now.x);
    v.push_back(now.y);
    return std::max({std::abs(then.x), std::abs(then.y), std::abs(now.x), std::abs(now.y)}) < kLargest_px;
  }

  double floor_px() {
    if (x.size() < 4) return 0;
    for (Column* column : {&x, &y, &u, &v}) centre(*column);
    if (dot(y, y) > dot(x, x)) std::swap(x, y);
    if (!normalize(x, kRounding_px)) return 0;
    const double across = std::sqrt(dot(y, y));
    remove(x, y);
    if (!normalize(y, std::max(kLeastAcross * across, kRounding_px))) return 0;
    for (Column* column : {&u, &v}) {
      remove(x, *column);
      remove(y, *column);
    }
    const double rms = std::sqrt((dot(u, u) + dot(v, v)) / static_cast<double>(x.size()));
    return std::max(0.0, rms * (1 - 1e-6) - kRounding_px);
  }
};

}  // namespace

double affine_floor_px(const layers::LayerState& then, const layers::LayerState& now,
                       const layers::Polyhedron& hull) {
  const std::size_t points = now.clip_points.size();
  if (points != then.clip_points.size()) return 0;
  const auto is_corner = corners_of(hull, points);
  PlacePairs pairs;
  for (std::size_t i = 0; i < points; ++i) {
    if (!is_corner[i] || !is_matched(now, now.clip_points[i], 1) || !is_matched(then, then.clip_points[i], 2))
      continue;
    if (!pairs.add(layers::screen_from_clip(then.clip_points[i], then.view.display_px),
                   layers::screen_from_clip(now.clip_points[i], now.view.display_px)))
      return 0;
  }
  return pairs.floor_px();
}

double affine_floor_px(const layers::Correspondences& matched) {
  PlacePairs pairs;
  for (std::size_t i = 0; i < matched.then_px.size(); ++i)
    if (!pairs.add(matched.then_px[i], matched.now_px[i])) return 0;
  return pairs.floor_px();
}

}  // namespace talisman::fiducials
