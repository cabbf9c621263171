// SPDX-License-Identifier: Apache-2.0
#include "chunker/shade_batch.h"

#include <algorithm>
#include <span>

#include "chunker/shade_block.h"

namespace talisman::chunker {
namespace {

Float4 fetch(const MipLevel& level, const BlockTaps& taps, int i) {
  const Float4* texels = level.texels.data();
  const Float4 upper = mix(texels[taps.texel[0][i]], texels[taps.texel[1][i]], taps.x_share[i]);
  const Float4 lower = mix(texels[taps.texel[2][i]], texels[taps.texel[3][i]], taps.x_share[i]);
  return mix(upper, lower, taps.y_share[i]);
}

Texels texels_of(const Shader& shader) {
  if (shader.plain()) return Texels::None;
  if (shader.scalar_texels()) return Texels::Looked;
  if (shader.pyramid == nullptr) return Texels::Constant;
  return shader.mipmaps ? Texels::Trilinear : Texels::Bilinear;
}

template <Texels kTexels>
Float4 texel_of(const Shader& shader, const Interpolator& t, const ShadeBlock& block, int i, int& samples) {
  if constexpr (kTexels == Texels::None) return splat(1);
  if constexpr (kTexels == Texels::Constant) return shader.texel;
  if constexpr (kTexels == Texels::Looked)
    return texel_at(shader, t, lambda_at(t, block.dx[i], block.dy[i]), samples);
  ++samples;
  if constexpr (kTexels == Texels::Bilinear) return fetch(shader.pyramid->levels[0], block.fine, i);
  const MipLevel* level = &shader.pyramid->levels[block.level[i]];
  const Float4 fine = fetch(level[0], block.fine, i);
  const float share = block.level_share[i];
  return share > 0 ? mix(fine, fetch(level[1], block.coarse, i), share) : fine;
}

template <bool kPerPixel, Terms kTerms>
Lighting lighting_of(const Shader& shader, const Interpolator& t, const ShadeBlock& block, int i) {
  const Lambda at{block.one[i], block.two[i], 0};
  if constexpr (kPerPixel) {
    const Float4 color = shader.layout.color >= 0 ? attribute(t, at, shader.layout.color) : shader.base;
    const Float4 diffuse{block.diffuse[0][i], block.diffuse[1][i], block.diffuse[2][i], 0};
    Lighting lighting{color * diffuse, splat(0)};
    if constexpr (kTerms.specular)
      lighting.specular = Float4{block.specular[0][i], block.specular[1][i], block.specular[2][i], 0};
    if constexpr (kTerms.shadowed) lighting.shadow = block.shadow[i];
    return lighting;
  } else {
    Float4 visibility = splat(1);
    if constexpr (kTerms.shadowed)
      for (int k = 0; k < layers::kMaxShadowLights; ++k) visibility[k] = block.visibility[k][i];
    return interpolated_lighting<kTerms.specular, kTerms.shadowed>(shader, t, at, visibility);
  }
}

template <Texels kTexels, bool kPerPixel, Terms kTerms>
int combine(const Shader& shader, const Interpolator& t, const ShadeBlock& block, Float4* color) {
  int samples = 0;
  for (int i = 0; i < block.count; ++i) {
    const Float4 texel = texel_of<kTexels>(shader, t, block, i, samples);
    const Lighting lighting = lighting_of<kPerPixel, kTerms>(shader, t, block, i);
    Float4 reflection = splat(0);
    if constexpr (kTerms.reflecting)
      reflection = reflection_at(*shader.reflection, t, block.dx[i], block.dy[i]);
    if constexpr (kTexels == Texels::Looked && layers::is_built(layers::Effect::EmissiveMap)) {
      const Float4 emission = emission_at(shader, t, lambda_at(t, block.dx[i], block.dy[i]), samples);
      color[i] = combined<kTerms>(shader, texel, lighting, reflection, emission);
    } else {
      color[i] = combined<kTerms>(shader, texel, lighting, reflection);
    }
  }
  return samples;
}

using Combine = int (*)(const Shader&, const Interpolator&, const ShadeBlock&, Float4*);

/// What is known of a shader becomes known to the compiler, step by step: no term that a surface lacks is
/// asked for at each of its points.
template <Texels kTexels, bool kPerPixel, Terms kTerms>
Combine choose_reflection(const Shader& shader) {
  constexpr Terms kMirroring{kTerms.specular, kTerms.shadowed, true};
  return shader.reflection != nullptr ? combine<kTexels, kPerPixel, kMirroring>
                                      : combine<kTexels, kPerPixel, kTerms>;
}

template <Texels kTexels, bool kPerPixel, bool kSpecular>
Combine choose_shadow(const Shader& shader) {
  if (!shader.shadowed) return choose_reflection<kTexels, kPerPixel, Terms{kSpecular}>(shader);
  constexpr Terms kAlone{.specular = false, .shadowed = true, .shadow_alone = true};
  return shader.shadow_term ? combine<kTexels, kPerPixel, kAlone>
                            : choose_reflection<kTexels, kPerPixel, Terms{kSpecular, true}>(shader);
}

template <Texels kTexels>
Combine choose_lighting(const Shader& shader) {
  if (shader.per_pixel)
    return shader.has_specular ? choose_shadow<kTexels, true, true>(shader)
                               : choose_shadow<kTexels, true, false>(shader);
  return shader.has_specular ? choose_shadow<kTexels, false, true>(shader)
                             : choose_shadow<kTexels, false, false>(shader);
}

Combine choose_combine(const Shader& shader, Texels texels) {
  switch (texels) {
    case Texels::None:
      return choose_lighting<Texels::None>(shader);
    case Texels::Constant:
      return choose_lighting<Texels::Constant>(shader);
    case Texels::Bilinear:
      return choose_lighting<Texels::Bilinear>(shader);
    case Texels::Trilinear:
      return choose_lighting<Texels::Trilinear>(shader);
    case Texels::Looked:
      return choose_lighting<Texels::Looked>(shader);
  }
  return nullptr;
}

void look_up_shadows(const Shader& shader, const Interpolator& t, ShadeBlock& block) {
  for (int i = 0; i < block.count; ++i) {
    const Lambda at{block.one[i], block.two[i], 0};
    const Float4 visibility = visibility_at(*shader.lights, attribute(t, at, shader.layout.position));
    for (int k = 0; k < layers::kMaxShadowLights; ++k) block.visibility[k][i] = visibility[k];
  }
}

/// Under a normal map; returns the filtered look-ups.
int look_up_normals(const Shader& shader, const Interpolator& t, ShadeBlock& block) {
  int samples = 0;
  for (int i = 0; i < block.count; ++i) {
    const Float4 normal = mapped_normal(shader, t, lambda_at(t, block.dx[i], block.dy[i]), samples);
    for (int k = 0; k < 3; ++k) block.normal[k][i] = normal[k];
  }
  return samples;
}

void fade(float opacity, std::span<Float4> colors) {
  for (Float4& color : colors) color *= splat(opacity);
}

}  // namespace

void shade_batch(const Shader& shader, const Interpolator& t, ShadeBatch& batch) {
  const Texels texels = texels_of(shader);
  const Combine combine_block = choose_combine(shader, texels);
  ShadeBlock block;
  batch.texture_samples = 0;
  for (int first = 0; first < batch.count; first += kBlock) {
    block.dx = &batch.dx[first];
    block.dy = &batch.dy[first];
    block.count = std::min(kBlock, batch.count - first);
    interpolate_block(shader, t, texels, block);
    if (shader.shadowed) look_up_shadows(shader, t, block);
    if (shader.normal_map != nullptr) batch.texture_samples += look_up_normals(shader, t, block);
    if (shader.per_pixel) light_block(shader, t, block);
    batch.texture_samples += combine_block(shader, t, block, &batch.color[first]);
  }
  if (shader.opacity != 1) fade(shader.opacity, {batch.color.data(), static_cast<std::size_t>(batch.count)});
}

}  // namespace talisman::chunker
