// SPDX-License-Identifier: Apache-2.0
#include "chunker/tile_reach.h"

#include <cmath>

namespace talisman::chunker {
namespace {

using layers::dvec3;
using layers::ivec2;
using layers::RectI;

std::optional<TileReach> affine_reach(const TapMap& map, ivec2 size, const RectI& pixels) {
  TapBounds bounds;
  for (const int y : {pixels.y0, pixels.y1 - 1}) {
    const auto start = run_start(map, pixels.x0, y);
    if (!start) return std::nullopt;
    for (const int k : {0, pixels.width() - 1}) {
      const TapPosition p{start->x + k * map.step_x, start->y + k * map.step_y};
      if (!touches(p, size)) return std::nullopt;
      bounds.include(tap_texel(p.x), tap_texel(p.y));
    }
  }
  return TileReach{bounds, bounds};
}

double absolute_along(const dvec3& row, double x, double y) {
  return std::fabs(row.x) * x + std::fabs(row.y) * y + std::fabs(row.z);
}

/// Is numerator / denominator at (x, y), as computed anywhere in a tile that ends there, good to 1/64 texel?
bool is_accurate(const dvec3& row, const dvec3& w, double least_w, double largest, double x, double y) {
  constexpr double kRounding = 1e-15;  // of a sum of three products, relative to their absolute values
  const double error = kRounding * (absolute_along(row, x, y) + largest * absolute_along(w, x, y)) / least_w;
  return error < 1.0 / 64;
}

std::optional<TileReach> perspective_reach(const TapMap& map, ivec2 size, const RectI& pixels) {
  double least_w = HUGE_VAL, x0 = HUGE_VAL, y0 = HUGE_VAL, x1 = -HUGE_VAL, y1 = -HUGE_VAL;
  for (const double y : {pixels.y0 + 0.5, pixels.y1 - 0.5}) {
    for (const double x : {pixels.x0 + 0.5, pixels.x1 - 0.5}) {
      const double w = along(map.w, x, y);
      if (!(w > 0)) return std::nullopt;
      least_w = std::min(least_w, w);
      const double px = along(map.x, x, y) / w, py = along(map.y, x, y) / w;
      x0 = std::min(x0, px), x1 = std::max(x1, px), y0 = std::min(y0, py), y1 = std::max(y1, py);
    }
  }
  // Half a texel inside: no rounding makes a pixel miss the sprite. NaN fails.
  if (!(x0 >= -0.5 && y0 >= -0.5 && x1 <= size.x - 0.5 && y1 <= size.y - 0.5)) return std::nullopt;
  if (!is_accurate(map.x, map.w, least_w, size.x, pixels.x1, pixels.y1) ||
      !is_accurate(map.y, map.w, least_w, size.y, pixels.x1, pixels.y1))
    return std::nullopt;
  const int left = static_cast<int>(std::floor(x0)), top = static_cast<int>(std::floor(y0));
  const int right = static_cast<int>(std::floor(x1)), bottom = static_cast<int>(std::floor(y1));
  return TileReach{{{left + 1, top + 1, right, bottom}}, {{left - 1, top - 1, right + 2, bottom + 2}}};
}

}  // namespace

std::optional<TileReach> whole_tile_reach(const TapMap& map, ivec2 size, const RectI& pixels) {
  return map.perspective ? perspective_reach(map, size, pixels) : affine_reach(map, size, pixels);
}

}  // namespace talisman::chunker
