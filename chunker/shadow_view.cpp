// SPDX-License-Identifier: Apache-2.0
#include "chunker/shadow_view.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace talisman::chunker {
namespace {

using layers::dvec3;
using layers::dvec4;

constexpr double kNarrowestTan = 1e-4;  // so that a single point in the distance still has a map

/// Share of the map that what must be seen takes, so that the filter finds casters beyond it.
double share_of_map(const layers::ShadowMapOptions& options) {
  const double border = 2.0 * (options.pcf_radius + 1), size = options.resolution_px;
  return size > 2 * border ? (size - border) / size : 0.5;
}

SpriteView view_of(const layers::ShadowMapOptions& options, double near_w) {
  SpriteView view;
  view.size_px = {options.resolution_px, options.resolution_px};
  view.region.near_w = near_w;
  view.region.center_px = {options.resolution_px * 0.5, options.resolution_px * 0.5};
  return view;
}

}  // namespace

dvec3 LightAxes::operator()(const dvec3& p) const {
  return {glm::dot(right, p), glm::dot(down, p), glm::dot(forward, p)};
}

/// Sizes that authors write, and powers of two, are kept off the border between two steps, where the rounding of a
/// moving caster's bounds would decide.
double stepped(double size) {
  constexpr double kOffRoundNumbers = 1.0137;
  int exponent = 0;
  const double mantissa = std::frexp(size * kOffRoundNumbers, &exponent);
  return std::ldexp(std::ceil(mantissa * 16), exponent - 4);
}

dvec3 steady_direction(const dvec3& forward, double tan_half) {
  const double step = stepped(std::max(tan_half, kNarrowestTan)) / 8;
  return glm::normalize(glm::round(forward / step) * step);
}

LightAxes axes_along(const dvec3& forward) {
  const dvec3 other = std::abs(forward.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0);
  const dvec3 right = glm::normalize(glm::cross(forward, other));
  return {right, glm::cross(forward, right), forward};
}

FaceView perspective_view(const layers::ShadowMapOptions& options, const dvec3& eye, const LightAxes& axes,
                          double tan_half, double near_w) {
  const double size = options.resolution_px;
  const double wide = std::max(tan_half, kNarrowestTan) / share_of_map(options);
  FaceView face;
  face.view = view_of(options, near_w);
  const dvec3 x = axes.right * (size / (2 * wide)) + axes.forward * (size / 2);
  const dvec3 y = axes.down * (size / (2 * wide)) + axes.forward * (size / 2);
  face.view.sprite_from_world.row[0] = dvec4(x, -glm::dot(x, eye));
  face.view.sprite_from_world.row[1] = dvec4(y, -glm::dot(y, eye));
  face.view.sprite_from_world.row[2] = dvec4(axes.forward, -glm::dot(axes.forward, eye));
  face.texel_m = 2 * wide / size;
  return face;
}

std::optional<FaceView> orthographic_view(const layers::ShadowMapOptions& options, const LightAxes& axes,
                                          const dvec3& lo, const dvec3& hi) {
  const double size = options.resolution_px;
  const double fitted = std::max(hi.x - lo.x, hi.y - lo.y) / share_of_map(options) / size;
  if (!(fitted > 0 && std::isfinite(fitted))) return std::nullopt;
  const double texel = stepped(fitted);
  const dvec3 first(std::round((lo.x + hi.x) / 2 / texel - size / 2),
                    std::round((lo.y + hi.y) / 2 / texel - size / 2), std::floor(lo.z / texel) * texel);
  if (!(std::isfinite(1 / texel) && std::isfinite(first.x) && std::isfinite(first.y) &&
        std::isfinite(first.z)))
    return std::nullopt;
  FaceView face;
  face.orthographic = true;
  face.view = view_of(options, 0.5);
  face.view.sprite_from_world.row[0] = dvec4(axes.right / texel, -first.x);
  face.view.sprite_from_world.row[1] = dvec4(axes.down / texel, -first.y);
  face.view.sprite_from_world.row[2] = dvec4(axes.forward, -first.z);
  face.texel_m = texel;
  return face;
}

}  // namespace talisman::chunker
