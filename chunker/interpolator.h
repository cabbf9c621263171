// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What is between the corners of a triangle? Attributes in perspective.

#include "chunker/float4.h"
#include "chunker/texture.h"

namespace talisman::chunker {

/// Of a vertex, one Float4 each: coordinates, colour, highlight and place, and the light of up to four maps
/// (layers::kMaxShadowLights), diffuse and specular.
inline constexpr int kMaxAttributes = 12;

/// The gradient set-up of one triangle for interpolation in perspective, relative to its first corner:
///
///   q₁ = b₁/w₁, q₂ = b₂/w₂, s = Σ bᵢ/wᵢ    linear on the screen (b: barycentric)
///   λᵢ = qᵢ/s;  a = a₀ + λ₁(a₁-a₀) + λ₂(a₂-a₀)
struct Interpolator {
  float q1x, q1y, q2x, q2y;
  float s0, sx, sy;
  float corner_x, corner_y;  ///< of the first corner on the sprite, texels
  Float4 a0[kMaxAttributes], d1[kMaxAttributes], d2[kMaxAttributes];
};

/// λ at one place, kept inside the triangle: rounding must not extrapolate.
struct Lambda {
  float one, two;
  float inverse_s;
};

inline float clamp_unit(float v) { return v > 0 ? (v < 1 ? v : 1.0f) : 0.0f; }  // NaN becomes 0

inline Lambda lambda_at(const Interpolator& t, float dx, float dy) {
  const float r = 1 / (t.s0 + t.sx * dx + t.sy * dy);
  return {clamp_unit((t.q1x * dx + t.q1y * dy) * r), clamp_unit((t.q2x * dx + t.q2y * dy) * r), r};
}

inline Float4 attribute(const Interpolator& t, const Lambda& at, int index) {
  return t.a0[index] + t.d1[index] * splat(at.one) + t.d2[index] * splat(at.two);
}

/// The two screen derivatives of (u, v) in texels of level 0. `lane`: where u lies in its attribute, 0 or 2.
inline TextureDerivatives texture_derivatives(const Interpolator& t, const Lambda& at, int uv,
                                              const MipLevel& finest, int lane = 0) {
  const float one_x = (t.q1x - at.one * t.sx) * at.inverse_s, one_y = (t.q1y - at.one * t.sy) * at.inverse_s;
  const float two_x = (t.q2x - at.two * t.sx) * at.inverse_s, two_y = (t.q2y - at.two * t.sy) * at.inverse_s;
  const Float4 texels{static_cast<float>(finest.width), static_cast<float>(finest.height), 0, 0};
  const Float4 x = (t.d1[uv] * splat(one_x) + t.d2[uv] * splat(two_x)) * texels;
  const Float4 y = (t.d1[uv] * splat(one_y) + t.d2[uv] * splat(two_y)) * texels;
  if (lane == 0) return {x, y};
  const Float4 size{static_cast<float>(finest.width), static_cast<float>(finest.height), 0, 0};
  const Float4 along_x = t.d1[uv] * splat(one_x) + t.d2[uv] * splat(two_x);
  const Float4 along_y = t.d1[uv] * splat(one_y) + t.d2[uv] * splat(two_y);
  return {Float4{along_x[2], along_x[3], 0, 0} * size, Float4{along_y[2], along_y[3], 0, 0} * size};
}

}  // namespace talisman::chunker
