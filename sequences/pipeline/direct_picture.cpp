// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/direct_picture.h"

#include <algorithm>

#include "sequences/pipeline/aggregates.h"
#include "sequences/pipeline/layer_planning.h"

namespace talisman::sequences {

namespace {

using layers::Layer;

bool is_drawn_by_itself(const Layer& layer) { return layer.base < 0 && !layer.is_aggregate(); }

/// The layers of this frame that the compositor shows, back to front, cycles merged.
std::vector<DirectGroup> sprites_in_order(const Pipeline& pipeline, int frame) {
  Pipeline sorted = pipeline;
  sorted.settings.regulator.policy = regulator::Policy::Reference;
  sorted.settings.compositor = Compositor::Talisman;
  sorted.settings.cycles = Cycles::Merge;
  PipelineState fresh(sorted);
  begin_frame(sorted, fresh, frame);
  const FrameOrder order = order_layers(sorted, fresh, frame);
  const LayerTable& all = fresh.layers;
  std::vector<DirectGroup> sprites;
  for (const int id : order.back_to_front) {
    const Layer& layer = all[id];
    if (layer.base >= 0) continue;
    sprites.push_back({layer.is_aggregate() ? layer.members : std::vector<int>{id},
                       multipliers_at(layer, time_of(pipeline, frame)).alpha});
  }
  return sprites;
}

}  // namespace

std::vector<DirectGroup> direct_groups(const Pipeline& pipeline, int frame) {
  DirectGroup whole;
  bool faded = false;
  for (const Layer& layer : pipeline.authored) {
    if (!is_drawn_by_itself(layer)) continue;
    whole.layers.push_back(layer.id);
    faded = faded || multipliers_at(layer, time_of(pipeline, frame)).alpha < 1;
  }
  if (!faded) return {whole};
  std::vector<DirectGroup> groups;
  for (DirectGroup& sprite : sprites_in_order(pipeline, frame)) {
    if (!(sprite.alpha > 0)) continue;
    if (groups.empty() || sprite.alpha < 1 || groups.back().alpha < 1)
      groups.push_back(std::move(sprite));
    else
      groups.back().layers.insert(groups.back().layers.end(), sprite.layers.begin(), sprite.layers.end());
  }
  return groups;
}

DirectPicture draw_directly(const Drawing& drawing, int frame, const layers::dmat3& carried) {
  const Pipeline& pipeline = drawing.pipeline;
  layers::SpritePlacement whole_display;
  whole_display.size_px = pipeline.settings.view.display_px;
  DirectPicture picture;
  std::vector<chunker::Sprite> sprites;
  std::vector<chunker::PlacedSprite> placed;
  for (DirectGroup& group : direct_groups(pipeline, frame)) {
    std::sort(group.layers.begin(), group.layers.end());  // at equal depth the order of parts decides
    chunker::RenderResult result = draw_in_one_pass(drawing, group.layers, whole_display);
    picture.render += result.counters;
    sprites.push_back(std::move(result.sprite));
    placed.emplace_back();
    placed.back().alpha_multiplier = group.alpha;
    placed.back().screen_from_sprite = carried;
  }
  for (std::size_t i = 0; i < placed.size(); ++i) placed[i].sprite = &sprites[i];
  picture.composite =
      chunker::composite(placed, pipeline.settings.view.display_px, pipeline.scene.background);
  return picture;
}

}  // namespace talisman::sequences
