// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/latency/reprojection.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/matrix.hpp>

#include "sequences/pipeline/latency/last_warp.h"

namespace talisman::sequences {

namespace {

using layers::CameraState;
using layers::dmat3;
using layers::dvec2;
using layers::dvec3;
using layers::ivec2;

constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();

std::size_t index_of(ivec2 size, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(x);
}

ivec2 size_of(const DepthPicture& picture) { return {picture.color.width, picture.color.height}; }

/// What of W's pixels is known while they are covered.
struct Covered {
  std::vector<double> inverse_depth, distance;  ///< of what won: 1/d'; from the pixel's centre
  explicit Covered(std::size_t pixels)
      : inverse_depth(pixels, -1), distance(pixels, std::numeric_limits<double>::infinity()) {}

  /// Nearer wins; of the same depth what is nearer to the centre.
  bool take(std::size_t pixel, double inverse, double from_centre) {
    const double held = inverse_depth[pixel];
    if (inverse < held || (inverse == held && from_centre >= distance[pixel])) return false;
    inverse_depth[pixel] = inverse;
    distance[pixel] = from_centre;
    return true;
  }
};

SourceMap empty_map(ivec2 size) {
  return {size, std::vector<dvec2>(index_of(size, 0, size.y), dvec2(kNowhere))};
}

SourceMap turned_map(const PixelMap& back, ivec2 size) {
  SourceMap map = empty_map(size);
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const dvec3 q = back({x + 0.5, y + 0.5}, 0);
      const dvec2 p = dvec2(q) / q.z;
      if (q.z > 0 && p.x >= 0 && p.y >= 0 && p.x <= size.x && p.y <= size.y)
        map.source[index_of(size, x, y)] = p;
    }
  return map;
}

/// Lays one pixel of D over those of W that it covers.
void lay_over(const dvec3& q, double inverse_depth, ivec2 size, Covered& covered) {
  if (!(q.z > 1e-9)) return;
  const dvec2 at = dvec2(q) / q.z;
  const double half = 0.5 * std::clamp(1 / q.z, 1.0, 64.0) + 0.01;
  if (!(at.x + half > 0 && at.y + half > 0 && at.x - half < size.x && at.y - half < size.y)) return;
  const int x0 = std::max(0, static_cast<int>(std::ceil(at.x - half - 0.5)));
  const int x1 = std::min(size.x - 1, static_cast<int>(std::floor(at.x + half - 0.5)));
  const int y0 = std::max(0, static_cast<int>(std::ceil(at.y - half - 0.5)));
  const int y1 = std::min(size.y - 1, static_cast<int>(std::floor(at.y + half - 0.5)));
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x)
      covered.take(index_of(size, x, y), inverse_depth / q.z, std::hypot(x + 0.5 - at.x, y + 0.5 - at.y));
}

SourceMap depth_map(const DepthPicture& drawn, const PixelMap& there, const PixelMap& back) {
  const ivec2 size = size_of(drawn);
  Covered covered(drawn.inverse_depth.size());
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const double inverse = drawn.inverse_depth[index_of(size, x, y)];
      lay_over(there({x + 0.5, y + 0.5}, inverse), inverse, size, covered);
    }
  SourceMap map = empty_map(size);
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const double inverse = covered.inverse_depth[index_of(size, x, y)];
      if (inverse < 0) continue;
      const dvec3 p = back({x + 0.5, y + 0.5}, inverse);
      map.source[index_of(size, x, y)] = glm::clamp(dvec2(p) / p.z, dvec2(0), dvec2(size));
    }
  return map;
}

double inverse_depth_at(const DepthPicture& picture, const dvec2& p) {
  const ivec2 size = size_of(picture);
  const int x = std::clamp(static_cast<int>(p.x), 0, size.x - 1);
  const int y = std::clamp(static_cast<int>(p.y), 0, size.y - 1);
  return picture.inverse_depth[index_of(size, x, y)];
}

/// The hole at `x` of a row takes the farther of the two sides; false: the row has none.
bool stretch_into(const SourceMap& open, const DepthPicture& drawn, int x, int y, dvec2& source) {
  int left = x, right = x;
  while (left >= 0 && open.is_hole(index_of(open.size_px, left, y))) --left;
  while (right < open.size_px.x && open.is_hole(index_of(open.size_px, right, y))) ++right;
  const bool has_left = left >= 0, has_right = right < open.size_px.x;
  if (!has_left && !has_right) return false;
  const dvec2 a = has_left ? open.source[index_of(open.size_px, left, y)] : dvec2(0);
  const dvec2 b = has_right ? open.source[index_of(open.size_px, right, y)] : dvec2(0);
  const bool takes_left =
      has_left && (!has_right || inverse_depth_at(drawn, a) <= inverse_depth_at(drawn, b));
  source = takes_left ? a : b;
  return true;
}

SourceMap filled(const SourceMap& open, const DepthPicture& drawn) {
  SourceMap map = open;
  const ivec2 size = open.size_px;
  std::vector<char> is_filled(static_cast<std::size_t>(size.y), 1);
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const std::size_t at = index_of(size, x, y);
      if (open.is_hole(at) && !stretch_into(open, drawn, x, y, map.source[at]))
        is_filled[static_cast<std::size_t>(y)] = 0;
    }
  for (int y = 0; y < size.y; ++y) {
    if (is_filled[static_cast<std::size_t>(y)] != 0) continue;
    for (int off = 1; off < size.y; ++off) {
      const int row = y - off >= 0 && is_filled[static_cast<std::size_t>(y - off)] != 0 ? y - off : y + off;
      if (row >= size.y || is_filled[static_cast<std::size_t>(row)] == 0) continue;
      for (int x = 0; x < size.x; ++x) map.source[index_of(size, x, y)] = map.source[index_of(size, x, row)];
      break;
    }
  }
  return map;
}

/// A corner of the grid: where it is in D, and in W.
struct Corner {
  dvec2 at;
  dvec3 q;
  double inverse_depth = 0;
};

Corner corner_of(const DepthPicture& drawn, const PixelMap& there, int column, int row) {
  const ivec2 size = size_of(drawn);
  const dvec2 at{std::min(column * kGridCell_px, size.x), std::min(row * kGridCell_px, size.y)};
  const double inverse = inverse_depth_at(drawn, at);
  return {at, there(at, inverse), inverse};
}

double twice_area(const dvec2& a, const dvec2& b, const dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Draws a triangle of the grid. What lies on an edge may be drawn from both sides: the same place.
void draw_triangle(const std::array<Corner, 3>& corners, Covered& covered, SourceMap& map) {
  std::array<dvec2, 3> p;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(corners[k].q.z > 1e-9)) return;
    p[k] = dvec2(corners[k].q) / corners[k].q.z;
  }
  const double area = twice_area(p[0], p[1], p[2]);
  if (!(std::fabs(area) > 1e-12)) return;
  const dvec2 lo = glm::min(p[0], glm::min(p[1], p[2])), hi = glm::max(p[0], glm::max(p[1], p[2]));
  const ivec2 size = map.size_px;
  if (!(hi.x > 0 && hi.y > 0 && lo.x < size.x && lo.y < size.y)) return;
  const int x1 = static_cast<int>(std::min(hi.x, size.x - 1.0)),
            y1 = static_cast<int>(std::min(hi.y, size.y - 1.0));
  for (int y = static_cast<int>(std::max(lo.y, 0.0)); y <= y1; ++y)
    for (int x = static_cast<int>(std::max(lo.x, 0.0)); x <= x1; ++x) {
      const dvec2 at{x + 0.5, y + 0.5};
      const dvec3 share =
          dvec3(twice_area(p[1], p[2], at), twice_area(p[2], p[0], at), twice_area(p[0], p[1], at)) / area;
      if (!(std::min({share.x, share.y, share.z}) >= -1e-12)) continue;
      double weight = 0, inverse = 0;
      dvec2 source(0);
      for (int k = 0; k < 3; ++k) {
        const Corner& corner = corners[static_cast<std::size_t>(k)];
        const double of = share[k] / corner.q.z;
        weight += of;
        source += of * corner.at;
        inverse += of * corner.inverse_depth;
      }
      if (covered.take(index_of(size, x, y), inverse, 0)) map.source[index_of(size, x, y)] = source / weight;
    }
}

SourceMap grid_map(const DepthPicture& drawn, const PixelMap& there) {
  const ivec2 size = size_of(drawn);
  SourceMap map = empty_map(size);
  Covered covered(drawn.inverse_depth.size());
  const auto cells = [](int length) { return (length + kGridCell_px - 1) / kGridCell_px; };
  for (int row = 0; row < cells(size.y); ++row)
    for (int column = 0; column < cells(size.x); ++column) {
      const Corner a = corner_of(drawn, there, column, row), b = corner_of(drawn, there, column + 1, row);
      const Corner c = corner_of(drawn, there, column + 1, row + 1),
                   d = corner_of(drawn, there, column, row + 1);
      draw_triangle({a, b, c}, covered, map);
      draw_triangle({a, c, d}, covered, map);
    }
  return map;
}

/// Where the mesh carries the place `p` of D: in its triangle q is linear.
dvec3 on_grid(const DepthPicture& drawn, const PixelMap& there, const dvec2& p) {
  const int column = static_cast<int>(std::max(p.x, 0.0)) / kGridCell_px;
  const int row = static_cast<int>(std::max(p.y, 0.0)) / kGridCell_px;
  const Corner a = corner_of(drawn, there, column, row), c = corner_of(drawn, there, column + 1, row + 1);
  const dvec2 share = (p - a.at) / glm::max(c.at - a.at, dvec2(1e-9));
  const Corner third = share.x >= share.y ? corner_of(drawn, there, column + 1, row)
                                          : corner_of(drawn, there, column, row + 1);
  const double along = std::max(share.x, share.y), across = std::min(share.x, share.y);
  return a.q + along * (third.q - a.q) + across * (c.q - third.q);
}

}  // namespace

std::string_view name(Reprojection reprojection) {
  switch (reprojection) {
    case Reprojection::Turned:
      return "homography";
    case Reprojection::Depth:
      return "depth, holes open";
    case Reprojection::Filled:
      return "depth, stretched";
    case Reprojection::Grid:
      return "grid by depth";
  }
  return "";
}

DepthPicture depth_picture(const chunker::PlanBuffer& buffer, layers::vec3 background) {
  const ivec2 size = buffer.size_px();
  const chunker::Sprite sprite = buffer.sprite();
  chunker::PlacedSprite placed;
  placed.sprite = &sprite;
  DepthPicture picture;
  picture.color = chunker::composite({&placed, 1}, size, background).frame;
  picture.inverse_depth.assign(index_of(size, 0, size.y), 0);
  picture.part.assign(picture.inverse_depth.size(), -1);
  constexpr int kSide = chunker::kChunkSize;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const chunker::DepthChunk* depth = buffer.depth(y / kSide * buffer.chunks().x + x / kSide);
      if (depth == nullptr) continue;
      const std::size_t texel = index_of({kSide, kSide}, x % kSide, y % kSide);
      if (!(depth->z[texel] > 0)) continue;
      picture.inverse_depth[index_of(size, x, y)] = depth->z[texel];
      picture.part[index_of(size, x, y)] = static_cast<std::int32_t>(depth->part[texel]);
    }
  return picture;
}

PixelMap pixel_map(const CameraState& drawn, const CameraState& shown, ivec2 size_px) {
  PixelMap map;
  map.turn = turned_picture(drawn, shown, size_px);
  const dvec3 way = dvec3(drawn.world_from_camera[3]) - dvec3(shown.world_from_camera[3]);
  const dvec3 ray = glm::transpose(dmat3(shown.world_from_camera)) * way;
  const double focal = size_px.y / (2 * std::tan(shown.fov_y_rad / 2));
  map.way = {focal * ray.x - size_px.x / 2.0 * ray.z, -focal * ray.y - size_px.y / 2.0 * ray.z, -ray.z};
  return map;
}

SourceMap source_map(Reprojection reprojection, const DepthPicture& drawn, const CameraState& from,
                     const CameraState& to) {
  const ivec2 size = size_of(drawn);
  const PixelMap there = pixel_map(from, to, size), back = pixel_map(to, from, size);
  switch (reprojection) {
    case Reprojection::Turned:
      return turned_map(back, size);
    case Reprojection::Depth:
      return depth_map(drawn, there, back);
    case Reprojection::Filled:
      return filled(depth_map(drawn, there, back), drawn);
    case Reprojection::Grid:
      return grid_map(drawn, there);
  }
  return {};
}

chunker::Frame reprojected(const chunker::Frame& picture, const SourceMap& map, layers::vec3 background) {
  chunker::Frame frame = chunker::composite({}, map.size_px, background).frame;
  const int last_x = picture.width - 1, last_y = picture.height - 1;
  for (std::size_t pixel = 0; pixel < map.source.size(); ++pixel) {
    if (map.is_hole(pixel)) continue;
    const dvec2 p = glm::clamp(map.source[pixel] - 0.5, dvec2(0), dvec2(last_x, last_y));
    const int x = static_cast<int>(p.x), y = static_cast<int>(p.y);
    const double u = p.x - x, v = p.y - y;
    const ivec2 size{picture.width, picture.height};
    const auto texel = [&](int i, int j) -> const chunker::Linear16& {
      return picture.pixels[index_of(size, std::min(x + i, last_x), std::min(y + j, last_y))];
    };
    const auto mixed = [&](std::uint16_t chunker::Linear16::*channel) {
      const double top = (1 - u) * texel(0, 0).*channel + u * texel(1, 0).*channel;
      const double bottom = (1 - u) * texel(0, 1).*channel + u * texel(1, 1).*channel;
      return static_cast<std::uint16_t>((1 - v) * top + v * bottom + 0.5);
    };
    frame.pixels[pixel].r = mixed(&chunker::Linear16::r);
    frame.pixels[pixel].g = mixed(&chunker::Linear16::g);
    frame.pixels[pixel].b = mixed(&chunker::Linear16::b);
  }
  return frame;
}

dvec2 point_shown(Reprojection reprojection, const DepthPicture* drawn, ivec2 size, const PixelMap& map,
                  const dvec2& pixel, double inverse_depth) {
  const bool is_in_picture = pixel.x >= 0 && pixel.y >= 0 && pixel.x <= size.x && pixel.y <= size.y;
  if (!is_in_picture) return dvec2(kNowhere);
  const dvec3 q = reprojection == Reprojection::Turned ? map(pixel, 0)
                  : reprojection == Reprojection::Grid ? on_grid(*drawn, map, pixel)
                                                       : map(pixel, inverse_depth);
  return q.z > 1e-9 ? dvec2(q) / q.z : dvec2(kNowhere);
}

}  // namespace talisman::sequences
