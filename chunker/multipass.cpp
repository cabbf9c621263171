// SPDX-License-Identifier: Apache-2.0
#include "chunker/multipass.h"

#include <algorithm>

#include "chunker/shadow_map.h"

namespace talisman::chunker {
namespace {

/// C ← s * C.
void multiply(const LinearImage& shadow, const LinearImage& base, LinearImage& image) {
  for (std::size_t i = 0; i < image.texels.size(); ++i) {
    const float s = light_left(shadow.texels[i].a, base.texels[i].a);
    LinearColor& c = image.texels[i];
    c = {c.r * s, c.g * s, c.b * s, c.a};
  }
}

void add(const LinearImage& term, LinearImage& image) {
  for (std::size_t i = 0; i < image.texels.size(); ++i) {
    LinearColor& c = image.texels[i];
    const LinearColor& more = term.texels[i];
    c = {c.r + more.r, c.g + more.g, c.b + more.b, c.a};
  }
}

template <typename Wanted>
bool any_material(const layers::Scene& scene, std::span<const int> parts, const Wanted& wanted) {
  return std::any_of(parts.begin(), parts.end(), [&](int part) {
    const int material = scene.parts[part].material;
    return material >= 0 && !scene.materials[material].unlit && wanted(scene.materials[material]);
  });
}

}  // namespace

float light_left(float shadow_alpha, float cover) {
  return cover > 0 ? std::clamp(1 - shadow_alpha / cover, 0.0f, 1.0f) : 1.0f;
}

std::vector<TermImage> render_terms(const PreparedScene& prepared, const layers::SceneFrame& frame,
                                    std::span<const int> parts, layers::ivec2 display_px,
                                    const layers::SpritePlacement& placement, const RenderOptions& options,
                                    const ShadeInputs& inputs, BasePasses base) {
  std::vector<TermImage> terms;
  const auto pass = [&](ShadeTerm term, int light = -1) {
    ShadeInputs own = inputs;
    own.term = term;
    own.light = light;
    terms.push_back(
        {term, light, render_linear(prepared, frame, parts, display_px, placement, options, own)});
  };
  pass(base == BasePasses::One ? ShadeTerm::Base : ShadeTerm::Texture1);
  if (base == BasePasses::Two) pass(ShadeTerm::Texture2);
  for (std::size_t l = 0; l < inputs.shadow_maps.size(); ++l)
    if (inputs.shadow_maps[l] != nullptr && !inputs.shadow_maps[l]->empty())
      pass(ShadeTerm::Shadow, static_cast<int>(l));
  const layers::Scene& scene = prepared.scene();
  if (any_material(scene, parts, [](const auto& m) { return m.specular != layers::vec3(0); }))
    pass(ShadeTerm::Specular);
  if (!inputs.reflections.empty() &&
      any_material(scene, parts, [](const auto& m) { return m.reflectivity > 0; }))
    pass(ShadeTerm::Reflection);
  return terms;
}

LinearImage surface_of(std::span<const TermImage> terms, layers::vec2 texture_gains) {
  LinearImage surface = terms.front().image;
  if (terms.front().term == ShadeTerm::Base) return surface;
  const LinearImage& second = terms[1].image;
  for (std::size_t i = 0; i < surface.texels.size(); ++i) {
    LinearColor& c = surface.texels[i];
    const LinearColor& d = second.texels[i];
    const float k = texture_gains.x, l = texture_gains.y;
    c = {k * c.r + l * d.r, k * c.g + l * d.g, k * c.b + l * d.b, c.a};
  }
  return surface;
}

LinearImage blend_terms(std::span<const TermImage> terms, layers::vec2 texture_gains) {
  const LinearImage surface = surface_of(terms, texture_gains);
  LinearImage image = surface;
  image.counters = {};
  for (const TermImage& pass : terms) {
    image.counters += pass.image.counters;
    if (pass.term == ShadeTerm::Shadow) multiply(pass.image, surface, image);
    if (pass.term == ShadeTerm::Specular || pass.term == ShadeTerm::Reflection) add(pass.image, image);
  }
  return image;
}

LinearImage render_multipass(const PreparedScene& prepared, const layers::SceneFrame& frame,
                             std::span<const int> parts, layers::ivec2 display_px,
                             const layers::SpritePlacement& placement, const RenderOptions& options,
                             const ShadeInputs& inputs) {
  return blend_terms(render_terms(prepared, frame, parts, display_px, placement, options, inputs));
}

LinearColor predicted_factoring_error(const LinearColor& base, float shadow_alpha, layers::vec3 behind) {
  // β (1 - β) (1 - s) (B - G) with (1 - s) β = A and β B premultiplied: A (1 - β) (βB / β - G).
  if (!(base.a > 0)) return {};
  const float open = shadow_alpha * (1 - base.a);
  return {open * (base.r / base.a - behind.x), open * (base.g / base.a - behind.y),
          open * (base.b / base.a - behind.z), 0};
}

LinearColor predicted_factoring_error(const LinearColor& base, std::span<const float> shadow_alphas,
                                      layers::vec3 behind, float fade) {
  float passed = 1, left = 1;
  for (const float a : shadow_alphas) {
    passed *= 1 - fade * a;
    left *= light_left(a, base.a);
  }
  const float surface = fade * (passed - left), through = (1 - fade * base.a) * (passed - 1);
  return {surface * base.r + through * behind.x, surface * base.g + through * behind.y,
          surface * base.b + through * behind.z, 0};
}

Sprite encode_sprite(const LinearImage& image) {
  Sprite sprite(image.size_px);
  for (int row = 0; row < sprite.chunks().y; ++row)
    for (int column = 0; column < sprite.chunks().x; ++column) {
      Chunk chunk{};
      const int width = std::min(kChunkSize, image.size_px.x - column * kChunkSize);
      const int height = std::min(kChunkSize, image.size_px.y - row * kChunkSize);
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
          chunk.texels[y * kChunkSize + x] = encode(image.at(column * kChunkSize + x, row * kChunkSize + y));
      sprite.store(column, row, chunk);
    }
  return sprite;
}

}  // namespace talisman::chunker
