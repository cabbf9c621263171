// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which colour does a surface have, at a vertex or at a pixel?
///
///   diffuse  = Σ ambient + Σ colour · max(0, N·L)                                   (Lambert)
///   specular = Σ colour · ks · max(0, N·H)ⁿ   where N·L > 0, H = (L + V) / |L + V|  (Blinn-Phong)
///   colour   = α · (base · vertex colour · diffuse · texel + α_texel · (specular + emissive))
///   α        = opacity · α_texel
///
/// The texel is premultiplied, so the colour is too; its alpha is multiplied by that of the vertices, and with
/// a cutoff it is 1 where the product is at least that and nothing elsewhere. Emission is multiplied by its own
/// texture. A light that fades is scaled by layers::falloff of its distance; a spot's colour is
/// scaled by t²(3 - 2t), t = (cos θ - cos outer) / (cos inner - cos outer) clamped to 0 … 1. Unlit surfaces
/// have diffuse = 1 and nothing else. Values above 1 are kept until a texel is encoded.
///
/// With a second texture the texel is k₁ T₁ + k₂ α₁ T₂ (alpha that of T₁) [LS97 2.3].
///
/// Shadows and reflections, where they are called for, per channel:
///
///   diffuse_v = ambient + Σ v_l D_l,   D_l = colour_l · max(0, N·L)           every light by its own visibility
///   Full      = α · (base · vertex colour · diffuse_v · texel
///                    + α_texel · (emissive + Σ v_l S_l + reflectivity · reflection))
///   s         = Y(diffuse_v) / Y(diffuse)                       what the shadow term of one light leaves, 0 … 1
///
/// v: visibility of the light from the point (chunker/shadow_map.h; 1 where it has no map), Y: luminance. A
/// surface from which every light is hidden shows its ambient light and its emission, of whatever hue the
/// lights are. The shadow *term* is black with alpha (1 - s)β and multiplies all of the base by one number
/// for three channels: exact for lights of one hue without emission; what it loses otherwise is measured by
/// `accuracy --factoring`. Where a light does not shine anyway (N·L ≤ 0, outside a cone) nothing is darkened.
///
/// Flat and Gouraud shading interpolate the light of every map by itself (an attribute each, only where a
/// shadow is looked up), so that their sum is as right as that of the light without shadows.
///
/// While a term is drawn that is not a colour over coverage, a fragment's alpha still is the surface's own
/// alpha, so that visibility is the same in every term; the shadow's (1 - s) α stands in red, and only the
/// resolved texel is turned into what the sprite holds.
///
/// A normal map (glTF 2.0, 3.9.3) turns the normal N of each pixel, in the frame of the surface's tangent:
///
///   T = unit(t - N (N·t)),  B = ± N × T,  N' = unit(σ x T + σ y B + z N)        (x, y, z) = 2 texel - 1
///
/// t, ±: tangent and sign of the vertices, interpolated; σ: the material's scale. Without a tangent N' = N. Seen
/// from behind, a two-sided surface has all three axes turned, so that a bump is a hollow there. Means of
/// several texels are made before the length is: what is far away is smooth, not rough. Flat and Gouraud
/// shading have no normal at a pixel, and no normal map.
///
/// Light by light (LightsHeld): `Unmapped` and `One` of every light that casts add up to the term with `All` of
/// them, texel by texel, since means of sums are sums of means.
///
/// A `Shader` is one part's material and lights, reduced to what this part needs: it says which attributes
/// its vertices carry, and an attribute that the material does not use is neither stored nor interpolated.
/// Flat shading evaluates the formula once per triangle, Gouraud once per vertex, Phong once per pixel.

#include <array>
#include <optional>
#include <vector>

#include "chunker/float4.h"
#include "chunker/interpolator.h"
#include "chunker/prepared.h"
#include "layers/built_effects.h"

namespace talisman::chunker {

/// All lights of a frame, as seen from the eye (positions are relative to it, so that large worlds keep their
/// precision).
struct LightSet {
  struct Directional {
    Float4 to_light;
    Float4 color;
    int shadow = -1;  ///< index of its map among `shadow_maps`; -1: it casts no shadow
  };
  /// As Light::attenuation and 1 / range². (Its square would not fit a float for ranges beyond 1e9 m.)
  struct Fading {
    float constant = 1, linear = 0, quadratic = 0, per_range2 = 0;
    bool any = false;
  };
  struct Point {
    Float4 position;
    Float4 color;
    int shadow = -1;
    Fading fading{};
  };
  struct Spot {
    Float4 position;
    Float4 color;
    Float4 axis;  ///< the way the light travels, unit length
    float cos_outer = 0, inverse_width = 1;
    float ramp = 3, ramp_slope = 2;  ///< layers/spot_cone.h
    int shadow = -1;
    Fading fading{};
  };
  Float4 ambient{0, 0, 0, 0};
  std::vector<Directional> directional;
  std::vector<Point> point;
  std::vector<Spot> spot;
  std::array<const ShadowMap*, layers::kMaxShadowLights> shadow_maps{};
  int shadows = 0;             ///< maps in use
  layers::dvec3 eye{0, 0, 0};  ///< world
  bool ambient_only() const { return directional.empty() && local_empty(); }
  bool local_empty() const { return point.empty() && spot.empty(); }
};

/// The lights that `inputs.term` asks for, and their maps. Lights that are not finite are left out; so are
/// maps that are empty.
LightSet light_set(const layers::SceneFrame& frame, const ShadeInputs& inputs = {});

/// Where a reflection is looked up.
struct ReflectionLookup {
  const Sprite* sprite = nullptr;
  layers::Affine2 reflection_from_sprite;  ///< from the sprite that is drawn
};

/// Vertex attributes take one Float4 each; -1: not carried.
struct AttributeLayout {
  int uv = -1;  ///< and in the last two lanes the coordinates of the emissive texture
  int color =
      -1;  ///< vertex alpha in the last lane, base · vertex colour (Phong), or base · vertex colour · diffuse (Flat, Gouraud)
  int specular = -1;  ///< Flat, Gouraud
  int normal = -1;    ///< Phong
  int position = -1;  ///< Phong, relative to the eye; all shadings where shadows are looked up
  int share = -1;     ///< Flat, Gouraud, shadow term: each map's share in the luminance of diffuse light
  int mapped = -1;    ///< Flat, Gouraud with shadows: base · vertex colour · D_l, one attribute per map
  int mapped_specular = -1;  ///< the same of the highlights: S_l
  int tangent = -1;          ///< Phong with a normal map: the sign in the last lane
  int normal_uv = -1;        ///< the coordinates of the normal map
  int count = 0;
};

/// What belongs to an effect is a constant where the build lacks it (layers/built_effects.h).
struct Shader {
  template <layers::Effect kEffect, typename T, int kAbsent = 0>
  using Of = layers::ValueOf<kEffect, T, kAbsent>;
  using enum layers::Effect;

  AttributeLayout layout;
  const LightSet* lights = nullptr;
  Of<Texture, const Pyramid*> pyramid;  ///< null: `texel` everywhere
  Float4 texel{1, 1, 1, 1};             ///< where there is no pyramid
  Of<Texture, const Pyramid*> pyramid2;
  Float4 texel2{0, 0, 0, 0};
  float blend1 = 1, blend2 = 0;
  Of<ReflectionMap, const ReflectionLookup*> reflection;  ///< null: none
  float reflectivity = 0;
  Float4 base{1, 1, 1, 1};
  Float4 specular{0, 0, 0, 0};
  Float4 emissive{0, 0, 0, 0};
  Of<EmissiveMap, const Pyramid*> emissive_map;  ///< null: `emissive` everywhere
  Of<NormalMap, const Pyramid*> normal_map;      ///< null: the normal of the vertices; Phong alone
  Of<Translucency, float> alpha_cutoff;          ///< 0: none
  Of<Translucency, bool> vertex_alpha;
  float shininess = 0, normal_scale = 1;
  Of<Translucency, float, 1> opacity;
  Of<MipFilter, bool> mipmaps;
  Of<Lighting, bool> lit;        ///< the lights are evaluated: neither unlit nor ambient only
  Of<Lighting, bool> per_pixel;  ///< Phong
  Of<SpecularHighlight, bool> has_specular;
  Of<Translucency, bool, 1> opaque;   ///< alpha is exactly 1 at every pixel
  Of<ShadowMap, bool> shadowed;       ///< shadow maps are looked up
  Of<ShadowLayer, bool> shadow_term;  ///< the colour is (1 - s) α in red
  Of<Texture, bool> two_textures;
  TextureFilter filter = TextureFilter::Trilinear;
  int max_anisotropy = 1;
  /// Texels are looked up point by point: what only some scenes ask for is not worth lanes.
  bool scalar_texels() const {
    return two_textures || max_anisotropy > 1 || filter == TextureFilter::Nearest ||
           emissive_map != nullptr || alpha_cutoff > 0 || vertex_alpha ||
           (pyramid != nullptr && pyramid->is_special());
  }
  bool textured() const { return pyramid != nullptr || pyramid2 != nullptr || emissive_map != nullptr; }
  bool extended() const { return shadowed || reflection != nullptr; }
  /// The texel is 1 at every point: there is nothing to multiply with.
  bool plain() const {
    return (!layers::is_built(Texture) || (!textured() && !two_textures && all_ones(texel))) &&
           emissive_map == nullptr && !vertex_alpha;
  }
};

/// What of the inputs belongs to one part.
struct PartInputs {
  const ReflectionLookup* reflection = nullptr;  ///< null: none
  std::optional<layers::vec2> texture_blend;     ///< empty: that of the material
  const layers::SceneFrame* frame = nullptr;  ///< whose moving pictures are shown; null: their first frames
};

/// The shader of what `inputs.term` shows of a part. A part that does not contribute to the term gets a black
/// one that only hides what is behind it.
Shader make_shader(const PreparedScene& prepared, const layers::Part& part, const LightSet& lights,
                   const RenderOptions& options, const ShadeInputs& inputs = {}, const PartInputs& own = {});

struct Lighting {
  Float4 diffuse;    ///< every light times its visibility
  Float4 specular;   ///< likewise
  float shadow = 1;  ///< s
};

/// The light of one point in parts: what has no shadow map, and what each map's light gives when it is seen.
struct LightParts {
  Float4 diffuse{0, 0, 0, 0}, specular{0, 0, 0, 0};
  std::array<Float4, layers::kMaxShadowLights> mapped_diffuse{}, mapped_specular{};
};

inline constexpr float kLuminance[3] = {0.2126f, 0.7152f, 0.0722f};
inline float luminance(Float4 c) {
  return (c[0] * kLuminance[0] + c[1] * kLuminance[1]) + c[2] * kLuminance[2];
}

/// s of the luminance with and without shadows; where there is no light nothing is darkened.
inline float share_left(float shadowed, float whole) { return whole > 0 ? shadowed / whole : 1.0f; }

/// `normal` of unit length (or zero: ambient light only), `position` relative to the eye, `visibility` of the
/// lights with maps.
Lighting light(const Shader& shader, Float4 normal, Float4 position, Float4 visibility);
inline Lighting light(const Shader& shader, Float4 normal, Float4 position) {
  return light(shader, normal, position, splat(1));
}
LightParts light_parts(const Shader& shader, Float4 normal, Float4 position);

/// What is known of one vertex (or, flat, of one triangle's corner) before its attributes are written.
struct ShadePoint {
  Float4 normal{0, 0, 0, 0};
  Float4 position{0, 0, 0, 0};  ///< where it is
  Float4 lit_at{0, 0, 0, 0};    ///< where light is evaluated: there, or (flat) at the triangle's centre
  Float4 vertex_color{1, 1, 1, 1};
  Float4 uv{0, 0, 0, 0};
};

/// Writes shader.layout.count attributes.
void write_attributes(const Shader& shader, const ShadePoint& point, Float4* attributes);

/// Which terms of the formulas on top there are besides the base; `shadow_alone`: the shadow, and nothing
/// else.
struct Terms {
  bool specular = true, shadowed = false, reflecting = false, shadow_alone = false;
  constexpr bool extended() const { return shadowed || reflecting; }
};

/// The formulas on top without the opacity. A term that is not there costs nothing.
template <Terms kTerms>
inline Float4 combined(const Shader& shader, Float4 texel, const Lighting& lighting, Float4 reflection,
                       Float4 emission = splat(1)) {
  const Float4 alpha = splat(texel[3]), emissive = shader.emissive * emission;
  if constexpr (kTerms.shadow_alone) return Float4{(1 - lighting.shadow) * texel[3], 0, 0, texel[3]};
  Float4 color = lighting.diffuse * texel;
  if constexpr (!kTerms.extended()) {
    color += (kTerms.specular ? lighting.specular + emissive : emissive) * alpha;
  } else {
    color += emissive * alpha;
    Float4 added = lighting.specular;
    if constexpr (kTerms.reflecting) added += reflection * splat(shader.reflectivity);
    if constexpr (kTerms.reflecting || kTerms.specular) color += added * alpha;
  }
  color[3] = texel[3];
  return color;
}

/// Visibility of the lights that have maps, at `position` relative to the eye.
Float4 visibility_at(const LightSet& lights, Float4 position);

/// The reflection at (dx, dy) texels from the triangle's first corner; clear outside of it.
Float4 reflection_at(const ReflectionLookup& lookup, const Interpolator& t, float dx, float dy);

/// The texel at a point; `samples` is increased by the filtered look-ups it took.
Float4 texel_at(const Shader& shader, const Interpolator& t, const Lambda& at, int& samples);

/// The emissive texture at a point, not premultiplied; 1 where there is none.
Float4 emission_at(const Shader& shader, const Interpolator& t, const Lambda& at, int& samples);

/// The normal at a point under a normal map, of unit length (or zero).
Float4 mapped_normal(const Shader& shader, const Interpolator& t, const Lambda& at, int& samples);

/// What a fading light is scaled by at a squared distance.
inline float faded(const LightSet::Fading& fading, float squared_m) {
  const float distance = std::sqrt(squared_m);
  const float below = fading.constant + distance * (fading.linear + distance * fading.quadratic);
  const float relative = squared_m * fading.per_range2, in_range = 1 - relative * relative;
  return (in_range > 0 ? in_range : 0.0f) / (below > 1e-12f ? below : 1e-12f);
}

/// Lighting of Flat and Gouraud shading at a point: interpolated. `visibility` counts for shadowed shaders.
template <bool kSpecular, bool kShadowed>
inline Lighting interpolated_lighting(const Shader& shader, const Interpolator& t, const Lambda& at,
                                      Float4 visibility) {
  const AttributeLayout& layout = shader.layout;
  Lighting lighting{layout.color >= 0 ? attribute(t, at, layout.color) : shader.base, splat(0)};
  if constexpr (kSpecular) lighting.specular = attribute(t, at, layout.specular);
  if constexpr (kShadowed) {
    const int count = shader.lights->shadows;
    if (layout.share >= 0) {
      const Float4 hidden = attribute(t, at, layout.share) * (splat(1) - visibility);
      for (int k = 0; k < count; ++k) lighting.shadow -= hidden[k];
      lighting.shadow = clamp_unit(lighting.shadow);
    } else {
      for (int k = 0; k < count; ++k)
        lighting.diffuse += attribute(t, at, layout.mapped + k) * splat(visibility[k]);
    }
    if constexpr (kSpecular)
      for (int k = 0; k < count; ++k)
        lighting.specular += attribute(t, at, layout.mapped_specular + k) * splat(visibility[k]);
  }
  return lighting;
}

/// Premultiplied colour at (dx, dy) texels from the triangle's first corner: the definition of what
/// shade_batch does.
Float4 shade(const Shader& shader, const Interpolator& t, float dx, float dy);

/// Turns resolved texels into what a sprite of this term holds: colour over coverage stays as it is, what is
/// added (a term that is, or one light of any) has alpha 0, and the shadow's alpha comes out of red.
void finish_term(ShadeTerm term, bool adds, std::span<Float4> texels);

}  // namespace talisman::chunker
