// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Unfactored multipass rendering: the terms of a layer blended in the renderer [LS97 2.3, Fig. 5], the
/// reference of what the compositor makes of shade sprites.
///
///   C = B;   for each light with a map:  C ← s * C,  s = 1 - A/β;   C ← C + specular;   C ← C + reflection
///
/// per resolved texel in float, before anything is rounded to bytes: s * [βB, β] = [sβB, β] is the multiply
/// that the compositor lacks [LS97 appendix]. A = (1 - s)β is the shadow term's alpha, β the base's.
///
/// Factored, shadow `over` base over a background G gives instead, per texel,
///
///   factored - unfactored = β (1 - β) (1 - s) (B - G)
///
/// B: the base's colour where it covers (not premultiplied). Proof: (1 - A)(βB + (1-β)G) - (sβB + (1-β)G), A
/// = (1-s)β. It is zero where cover is whole or nothing, where there is no shadow, and where the receiver has
/// the background's colour. With several shadows the factors multiply: Π(1 - A_l) in place of (1 - A), Π s_l
/// in place of s.

#include <vector>

#include "chunker/render.h"

namespace talisman::chunker {

/// A sprite before encoding: premultiplied linear colour, row by row.
struct LinearImage {
  layers::ivec2 size_px{0, 0};
  std::vector<LinearColor> texels;
  RenderCounters counters;
  const LinearColor& at(int x, int y) const { return texels[static_cast<std::size_t>(y) * size_px.x + x]; }
};

/// What render() encodes, as it is before that.
LinearImage render_linear(const PreparedScene& prepared, const layers::SceneFrame& frame,
                          std::span<const int> parts, layers::ivec2 display_px,
                          const layers::SpritePlacement& placement, const RenderOptions& options = {},
                          const ShadeInputs& inputs = {});

/// One pass of the multipass picture.
struct TermImage {
  ShadeTerm term = ShadeTerm::Base;
  int light = -1;  ///< Shadow: index of Scene::lights
  LinearImage image;
};

/// How the base's textures get into it.
enum class BasePasses {
  One,  ///< Base: Material::texture_blend in the renderer
  Two,  ///< Texture1 and Texture2, for blends that change over time
};

/// The passes themselves, in the order in which they are blended: base, a shadow per light with a map,
/// highlights, reflection. `inputs.term` and `inputs.light` are not looked at. Passes that nothing calls for
/// (no map, no specular material, no reflection) are not made.
std::vector<TermImage> render_terms(const PreparedScene& prepared, const layers::SceneFrame& frame,
                                    std::span<const int> parts, layers::ivec2 display_px,
                                    const layers::SpritePlacement& placement,
                                    const RenderOptions& options = {}, const ShadeInputs& inputs = {},
                                    BasePasses base = BasePasses::One);

/// The surface without shadows, highlights and reflections: the base, or `texture_gains` · its two textures
/// (BasePasses::Two).
LinearImage surface_of(std::span<const TermImage> terms, layers::vec2 texture_gains = {1, 1});

/// C, by the formula above. The counters are those of all passes together.
LinearImage blend_terms(std::span<const TermImage> terms, layers::vec2 texture_gains = {1, 1});

/// All terms, one pass each, blended.
LinearImage render_multipass(const PreparedScene& prepared, const layers::SceneFrame& frame,
                             std::span<const int> parts, layers::ivec2 display_px,
                             const layers::SpritePlacement& placement, const RenderOptions& options = {},
                             const ShadeInputs& inputs = {});

/// s of one light: 1 - A/β; where nothing is covered there is nothing to darken.
float light_left(float shadow_alpha, float cover);

/// How much the factored picture will be off over background `behind`, by the formula above, from the linear
/// terms of one texel.
LinearColor predicted_factoring_error(const LinearColor& base, float shadow_alpha, layers::vec3 behind);

/// The same of several shadows, which lie in front of each other, and of sprites that all are multiplied by
/// `fade` m (0 … 1), which multiplies cover and shadows alike:
///
///   m βB (Π(1 - m A_l) - Π s_l) + (1 - m β) G (Π(1 - m A_l) - 1)
LinearColor predicted_factoring_error(const LinearColor& base, std::span<const float> shadow_alphas,
                                      layers::vec3 behind, float fade);

/// Rounded to the four bytes of a texel.
Sprite encode_sprite(const LinearImage& image);

}  // namespace talisman::chunker
