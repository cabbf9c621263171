// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which colour does a surface have, at a vertex or at a pixel?
///
///   diffuse  = Σ ambient + Σ colour · max(0, N·L)                                  (Lambert)
///   specular = Σ colour · ks · max(0, N·H)ⁿ   where N·L > 0, H = (L + V) / |L + V|  (Blinn-Phong)
///   colour   = α · (base · vertex colour · diffuse · texel + α_texel · (specular + emissive)),  α = opacity
///   · α_texel
///
/// The texel is premultiplied, so the colour is too. Lights do not fall off with distance. Unlit surfaces
/// have diffuse = 1 and nothing else. Values above 1 are kept until a texel is encoded.
///
/// A `Shader` is one part's material and lights, reduced to what this part needs: it says which attributes
/// its vertices carry, and an attribute that the material does not use is neither stored nor interpolated.
/// Flat shading evaluates the formula once per triangle, Gouraud once per vertex, Phong once per pixel.

#include <vector>

#include "chunker/float4.h"
#include "chunker/prepared.h"

namespace talisman::chunker {

/// All lights of a frame, as seen from the eye (positions are relative to it, so that large worlds keep their
/// precision).
struct LightSet {
  struct Directional {
    Float4 to_light;
    Float4 color;
  };
  struct Point {
    Float4 position;
    Float4 color;
  };
  Float4 ambient{0, 0, 0, 0};
  std::vector<Directional> directional;
  std::vector<Point> point;
  bool ambient_only() const { return directional.empty() && point.empty(); }
};

/// Lights that are not finite are left out.
LightSet light_set(const layers::SceneFrame& frame);

/// Vertex attributes take one Float4 each; -1: not carried.
struct AttributeLayout {
  int uv = -1;
  int color = -1;     ///< base · vertex colour (Phong), or base · vertex colour · diffuse (Flat, Gouraud)
  int specular = -1;  ///< Flat, Gouraud
  int normal = -1;    ///< Phong
  int position = -1;  ///< Phong, relative to the eye
  int count = 0;
};
inline constexpr int kMaxAttributes = 5;

struct Shader {
  AttributeLayout layout;
  const LightSet* lights = nullptr;
  const Pyramid* pyramid = nullptr;  ///< null: `texel` everywhere
  Float4 texel{1, 1, 1, 1};          ///< where there is no pyramid
  Float4 base{1, 1, 1, 1};
  Float4 specular{0, 0, 0, 0};
  Float4 emissive{0, 0, 0, 0};
  float shininess = 0;
  float opacity = 1;
  bool mipmaps = true;
  bool lit = false;        ///< the lights are evaluated: neither unlit nor ambient only
  bool per_pixel = false;  ///< Phong
  bool has_specular = false;
  bool opaque = true;  ///< alpha is exactly 1 at every pixel
};

Shader make_shader(const PreparedScene& prepared, const layers::Part& part, const LightSet& lights,
                   const RenderOptions& options);

struct Lighting {
  Float4 diffuse;
  Float4 specular;
};

/// `normal` of unit length (or zero: ambient light only), `position` relative to the eye.
Lighting light(const Shader& shader, Float4 normal, Float4 position);

/// What is known of one vertex (or, flat, of one triangle's corner) before its attributes are written.
struct ShadePoint {
  Float4 normal{0, 0, 0, 0};
  Float4 position{0, 0, 0, 0};
  Float4 vertex_color{1, 1, 1, 1};
  Float4 uv{0, 0, 0, 0};
};

/// Writes shader.layout.count attributes.
void write_attributes(const Shader& shader, const ShadePoint& point, Float4* attributes);

/// The gradient set-up of one triangle for interpolation in perspective, relative to its first corner:
///
///   q₁ = b₁/w₁, q₂ = b₂/w₂, s = Σ bᵢ/wᵢ are linear on the screen (b: barycentric);  λᵢ = qᵢ/s;  a = a₀ +
///   λ₁(a₁-a₀) + λ₂(a₂-a₀)
struct Interpolator {
  float q1x, q1y, q2x, q2y;
  float s0, sx, sy;
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

/// Squared length, in texels of level 0, of the longer of the two screen derivatives of (u, v).
inline float texture_footprint(const Interpolator& t, const Lambda& at, int uv, const MipLevel& finest) {
  const float one_x = (t.q1x - at.one * t.sx) * at.inverse_s, one_y = (t.q1y - at.one * t.sy) * at.inverse_s;
  const float two_x = (t.q2x - at.two * t.sx) * at.inverse_s, two_y = (t.q2y - at.two * t.sy) * at.inverse_s;
  const Float4 texels{static_cast<float>(finest.width), static_cast<float>(finest.height), 0, 0};
  const Float4 x = (t.d1[uv] * splat(one_x) + t.d2[uv] * splat(two_x)) * texels;
  const Float4 y = (t.d1[uv] * splat(one_y) + t.d2[uv] * splat(two_y)) * texels;
  return std::max(x[0] * x[0] + x[1] * x[1], y[0] * y[0] + y[1] * y[1]);
}

/// The last line of the formula on top.
inline Float4 combined(const Shader& shader, Float4 texel, const Lighting& lighting) {
  Float4 color = lighting.diffuse * texel + (lighting.specular + shader.emissive) * splat(texel[3]);
  color[3] = texel[3];
  return color * splat(shader.opacity);
}

/// Premultiplied colour at (dx, dy) texels from the triangle's first corner: the definition of what
/// shade_batch does.
Float4 shade(const Shader& shader, const Interpolator& t, float dx, float dy);

}  // namespace talisman::chunker
