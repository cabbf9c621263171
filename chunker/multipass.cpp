// SPDX-License-Identifier: Apache-2.0
#include "chunker/multipass.h"

#include <algorithm>

#include "chunker/shadow_map.h"

namespace talisman::chunker {
namespace {

/// C ← s * C, s = 1 - A/β; what is not covered has nothing to multiply.
void multiply(const LinearImage& shadow, const LinearImage& base, LinearImage& image) {
  for (std::size_t i = 0; i < image.texels.size(); ++i) {
    const float cover = base.texels[i].a;
    if (!(cover > 0)) continue;
    const float s = std::clamp(1 - shadow.texels[i].a / cover, 0.0f, 1.0f);
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

LinearImage render_multipass(const PreparedScene& prepared, const layers::SceneFrame& frame,
                             std::span<const int> parts, layers::ivec2 display_px,
                             const layers::SpritePlacement& placement, const RenderOptions& options,
                             const ShadeInputs& inputs) {
  RenderCounters counters;
  const auto pass = [&](ShadeTerm term, int light) {
    ShadeInputs own = inputs;
    own.term = term;
    own.light = light;
    LinearImage image = render_linear(prepared, frame, parts, display_px, placement, options, own);
    counters += image.counters;
    return image;
  };
  const LinearImage base = pass(ShadeTerm::Base, -1);
  LinearImage image = base;
  for (std::size_t l = 0; l < inputs.shadow_maps.size(); ++l)
    if (inputs.shadow_maps[l] != nullptr && !inputs.shadow_maps[l]->empty())
      multiply(pass(ShadeTerm::Shadow, static_cast<int>(l)), base, image);
  const layers::Scene& scene = prepared.scene();
  if (any_material(scene, parts, [](const auto& m) { return m.specular != layers::vec3(0); }))
    add(pass(ShadeTerm::Specular, -1), image);
  if (!inputs.reflections.empty() &&
      any_material(scene, parts, [](const auto& m) { return m.reflectivity > 0; }))
    add(pass(ShadeTerm::Reflection, -1), image);
  image.counters = counters;
  return image;
}

LinearColor predicted_factoring_error(const LinearColor& base, float shadow_alpha, layers::vec3 behind) {
  // β (1 - β) (1 - s) (B - G) with (1 - s) β = A and β B premultiplied: A (1 - β) (βB / β - G).
  if (!(base.a > 0)) return {};
  const float open = shadow_alpha * (1 - base.a);
  return {open * (base.r / base.a - behind.x), open * (base.g / base.a - behind.y),
          open * (base.b / base.a - behind.z), 0};
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
