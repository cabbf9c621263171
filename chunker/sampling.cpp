// SPDX-License-Identifier: Apache-2.0
#include "chunker/sampling.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace talisman::chunker {
namespace {

using layers::dmat3;
using layers::dvec2;
using layers::dvec3;

constexpr double kMaxStep = 1073741824.0;  // 2^30 texels per pixel
constexpr double kMaxEntry = 1e100;        // so that no sum of products overflows

bool within(const dvec3& v, double limit) {  // false for NaN
  return std::fabs(v.x) <= limit && std::fabs(v.y) <= limit && std::fabs(v.z) <= limit;
}

bool is_affine(const dmat3& m) { return m[0][2] == 0 && m[1][2] == 0 && m[2][2] == 1; }

std::optional<TapMap> affine_map(const dmat3& m) {
  const auto inverse = layers::inverse(layers::Affine2{m[0][0], m[1][0], m[2][0], m[0][1], m[1][1], m[2][1]});
  if (!inverse) return std::nullopt;
  TapMap map;
  map.x = {inverse->a, inverse->b, inverse->tx - 0.5};
  map.y = {inverse->c, inverse->d, inverse->ty - 0.5};
  if (!within({map.x.x, map.x.y, 0}, kMaxStep) || !within({map.y.x, map.y.y, 0}, kMaxStep))
    return std::nullopt;
  if (!within(map.x, kMaxEntry) || !within(map.y, kMaxEntry)) return std::nullopt;
  map.step_x = fixed16(map.x.x);
  map.step_y = fixed16(map.y.x);
  return map;
}

dvec3 cross(const dvec3& a, const dvec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

std::optional<TapMap> perspective_map(const dmat3& m) {
  const dvec3 row_x = cross(m[1], m[2]), row_y = cross(m[2], m[0]), row_w = cross(m[0], m[1]);
  const double determinant = m[0].x * row_x.x + m[0].y * row_x.y + m[0].z * row_x.z;
  const double scale = 1 / determinant;
  if (!std::isfinite(determinant) || !std::isfinite(scale)) return std::nullopt;
  TapMap map;
  map.perspective = true;
  map.w = row_w * scale;
  map.x = row_x * scale - 0.5 * map.w;
  map.y = row_y * scale - 0.5 * map.w;
  if (!within(map.x, kMaxEntry) || !within(map.y, kMaxEntry) || !within(map.w, kMaxEntry))
    return std::nullopt;
  return map;
}

/// Position in 1/256 texel, rounded to nearest; empty when outside (and for NaN).
std::optional<std::int64_t> rounded_tap(double texels, int size) {
  const double v = texels * 256 + 0.5;
  if (!(v >= -255 && v < 256.0 * size)) return std::nullopt;
  return floor_to_int(v) << 8;
}

/// Keeps in [lo, hi] the x for which a·x + b·y + c ≥ 0 holds for some y of [y0, y1].
void clip_columns(const dvec3& plane, double extent, double y0, double y1, double& lo, double& hi) {
  const double slack = 1e-12 * (std::fabs(plane.x) * extent + std::fabs(plane.y) * y1 + std::fabs(plane.z));
  const double rest = plane.z + std::max(plane.y * y0, plane.y * y1) + slack;
  if (plane.x > 0) lo = std::max(lo, -rest / plane.x);
  if (plane.x < 0) hi = std::min(hi, rest / -plane.x);
  if (plane.x == 0 && rest < 0) hi = -1;
}

}  // namespace

std::optional<TapMap> tap_map(const dmat3& screen_from_sprite) {
  for (int column = 0; column < 3; ++column) {
    if (!within(screen_from_sprite[column], kMaxEntry)) return std::nullopt;
  }
  return is_affine(screen_from_sprite) ? affine_map(screen_from_sprite) : perspective_map(screen_from_sprite);
}

std::optional<TapPosition> perspective_tap(const TapMap& map, int x, int y, layers::ivec2 size) {
  const double denominator = along(map.w, x + 0.5, y + 0.5);
  if (!(denominator > 0)) return std::nullopt;
  const auto px = rounded_tap(along(map.x, x + 0.5, y + 0.5) / denominator, size.x);
  const auto py = rounded_tap(along(map.y, x + 0.5, y + 0.5) / denominator, size.y);
  if (!px || !py) return std::nullopt;
  return TapPosition{*px, *py};
}

PixelRange columns_touched(const TapMap& map, layers::ivec2 size, int width, int first_line, int last_line) {
  constexpr double kMargin = 1.0 / 64;  // texels; more than the rounding of positions
  double lo = 0, hi = width;
  const double y0 = first_line + 0.5, y1 = last_line + 0.5;
  for (const dvec3& plane : {map.x + (1 + kMargin) * map.w, (size.x + kMargin) * map.w - map.x,
                             map.y + (1 + kMargin) * map.w, (size.y + kMargin) * map.w - map.y, map.w}) {
    clip_columns(plane, width, y0, y1, lo, hi);
  }
  if (!(lo <= hi)) return {};
  const int first = static_cast<int>(std::floor(lo)), last = static_cast<int>(std::ceil(hi));
  return {std::max(first - 1, 0), std::min(last + 1, width)};
}

PixelRange pixels_touching(std::int64_t start, std::int64_t step, int size, int count) {
  const auto holds = [&](std::int64_t k) { return touches(start + k * step, size); };
  if (holds(0) && holds(count - 1)) return {0, count};
  if (step == 0) return {};
  const std::int64_t lowest = -65280, above = static_cast<std::int64_t>(size) << 16;
  // Count steps from the end that the position moves away from, so that one formula serves both directions.
  const std::int64_t gap = step > 0 ? lowest - start : start - (above - 1);
  const std::int64_t room = step > 0 ? (above - 1) - start : start - lowest;
  const std::int64_t stride = step > 0 ? step : -step;
  if (room < 0) return {};
  const std::int64_t first = gap > 0 ? (gap + stride - 1) / stride : 0;
  const std::int64_t last = room / stride + 1;
  return {static_cast<int>(std::min<std::int64_t>(first, count)),
          static_cast<int>(std::min<std::int64_t>(last, count))};
}

}  // namespace talisman::chunker
