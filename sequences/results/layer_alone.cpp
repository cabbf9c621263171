// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/layer_alone.h"

#include <algorithm>

#include "sequences/pipeline/layer_planning.h"
#include "sequences/pipeline/shade_passes.h"

namespace talisman::sequences {

namespace {

/// So that it is seen by itself.
void make_visible(chunker::Frame& frame, const layers::Layer& layer) {
  if (layer.kind == layers::LayerKind::Light)
    for (chunker::Linear16& p : frame.pixels) p.a = std::max({p.r, p.g, p.b});
  if (layer.kind != layers::LayerKind::Shadow) return;
  const bool is_ratio = layer.light < 0;
  if (!is_ratio)
    for (chunker::Linear16& p : frame.pixels) p.r = p.g = p.b = p.a;
  if (!is_ratio) return;
  for (chunker::Linear16& p : frame.pixels) {
    const auto taken = [&](std::uint16_t left) {
      return static_cast<std::uint16_t>(p.a - std::min(left, p.a));
    };
    p = {taken(p.r), taken(p.g), taken(p.b), 0};
    p.a = std::max({p.r, p.g, p.b});
  }
}

}  // namespace

chunker::Frame shown_alone(const chunker::Sprite& sprite, const layers::dmat3& screen_from_sprite,
                           const SpriteMultipliers& multipliers, const layers::Layer& layer,
                           layers::ivec2 display_px) {
  chunker::Frame frame{display_px.x, display_px.y, {}};
  frame.pixels.resize(static_cast<std::size_t>(display_px.x) * static_cast<std::size_t>(display_px.y));
  const chunker::PlacedSprite placed{&sprite, screen_from_sprite, multipliers.color, multipliers.alpha};
  chunker::composite_onto(frame, {&placed, 1});
  make_visible(frame, layer);
  return frame;
}

chunker::Frame fresh_alone(const Pipeline& pipeline, PipelineState& state, const FrameReport& report,
                           int layer, const chunker::PreparedScene& prepared) {
  const layers::SceneFrame now = scene_at(pipeline, report.frame);
  const layers::LayerState& layer_state = captured_states(pipeline, state, report.frame)[layer];
  const layers::SpritePlacement placement = placement_without_growth(pipeline, report.layers, layer_state);
  ShadowMapStore maps;
  const chunker::RenderResult result =
      draw_layer({pipeline, report.layers, maps, prepared, now}, report.layers[layer], placement);
  return shown_alone(result.sprite, layers::to_mat3(placement.screen_from_sprite),
                     multipliers_at(report.layers[layer], time_of(pipeline, report.frame)),
                     report.layers[layer], pipeline.settings.view.display_px);
}

Image8 over_grey(chunker::Frame frame, const Crop& crop) {
  constexpr std::uint32_t kGrey = chunker::kOne / 5;
  for (chunker::Linear16& p : frame.pixels) {
    const std::uint32_t behind = kGrey * (chunker::kOne - p.a) / chunker::kOne;
    const auto add = [behind](std::uint16_t c) {
      return static_cast<std::uint16_t>(std::min(c + behind, chunker::kOne));
    };
    p = {add(p.r), add(p.g), add(p.b), static_cast<std::uint16_t>(chunker::kOne)};
  }
  return cropped(to_image8(frame), crop);
}

}  // namespace talisman::sequences
