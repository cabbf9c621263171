// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/separate_pictures.h"

#include "sequences/files/image_io.h"
#include "sequences/pipeline/blended_sprites.h"
#include "sequences/results/layer_words.h"

namespace talisman::sequences {

namespace {

using layers::LayerKind;

/// What makes one kind of sprite visible by itself.
layers::vec3 behind(const Pipeline& pipeline, LayerKind kind) {
  switch (kind) {
    case LayerKind::Geometry:
      return pipeline.scene.background;
    case LayerKind::Shadow:
      return {1, 1, 1};
    default:
      return {0, 0, 0};
  }
}

void write(const Pipeline& pipeline, const std::vector<chunker::PlacedSprite>& sprites,
           const layers::vec3& background, const std::string& path) {
  const auto result = chunker::composite(sprites, pipeline.settings.view.display_px, background);
  write_png(path, to_image8(result.frame));
}

}  // namespace

std::vector<std::string> write_separate(const Pipeline& pipeline, const PipelineState& state,
                                        const FrameReport& report, const std::string& folder) {
  const LayerTable& all = report.layers;
  std::vector<std::string> names;
  const auto name_of = [&](const std::string& layer) {
    return folder + "/" + names.emplace_back(picture_of(report.frame, layer));
  };
  const BlendedSprites blended = blended_sprites(state, report);
  const auto base_of = [&](const ShownSprite& s) {
    return all[s.layer].base < 0 ? s.layer : all[s.layer].base;
  };
  for (std::size_t i = 0; i < report.shown.size();) {  // a base and its shades follow each other
    const int base = base_of(report.shown[i]);
    std::vector<chunker::PlacedSprite> sum;
    const std::size_t first = i;
    for (; i < report.shown.size() && base_of(report.shown[i]) == base; ++i)
      sum.push_back(placed_sprite(report.shown[i], state.sprites, blended));
    if (sum.size() < 2) continue;
    for (std::size_t k = first; k < i; ++k) {
      const layers::Layer& layer = all[report.shown[k].layer];
      write(pipeline, {sum[k - first]}, behind(pipeline, layer.kind), name_of(layer.name));
    }
    write(pipeline, sum, pipeline.scene.background, name_of(all[base].name + "-sum"));
  }
  return names;
}

}  // namespace talisman::sequences
