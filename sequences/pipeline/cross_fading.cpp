// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/cross_fading.h"

#include <algorithm>
#include <cmath>

#include "regulator/policies.h"
#include "sequences/pipeline/layer_planning.h"

namespace talisman::sequences {

namespace {

using regulator::LayerAssessment;
using regulator::LayerDecision;

/// The old sprite as it is shown in this frame; empty where it cannot be carried on.
std::optional<FadingOut> carried(const Pipeline& pipeline, PipelineState& state, int layer,
                                 const FadingSprite& fading, FrameReport& report) {
  const int frame = report.frame;
  LayerDecision& decision = report.plan.decisions[layer];
  const LayerMemory& old = fading.old;
  const LayerAssessment shown =
      assess_sprite(pipeline, state.layers, *old.then, old.placement,
                    captured_states(pipeline, state, frame)[layer], std::abs(frame - old.frame_rendered));
  if (!regulator::may_fade_out(shown, pipeline.settings.regulator)) return std::nullopt;
  const int frames = pipeline.settings.regulator.blend_frames;
  FadingOut out;
  out.share = 1 - (frame - fading.began + 1.0) / (frames + 1);
  out.screen_from_sprite = shown.fitted.warp.now_from_then * to_mat3(old.placement.screen_from_sprite);
  out.color = shown.fiducials.photometric.multiplier;
  decision.shown_geometric_px = std::max(decision.shown_geometric_px, shown.fiducials.geometric.px);
  const layers::ivec2 size_px = state.memory[layer].placement.size_px;
  const std::int64_t pixels = std::int64_t{size_px.x} * size_px.y;
  decision.cost.pixels += pixels;
  report.blended_pixels += pixels;
  decision.reason += "; " + std::to_string(std::lround(100 * out.share)) + " % of the sprite before it";
  return out;
}

bool goes_on(const PipelineState& state, const FrameReport& report, int layer, int blend_frames) {
  const FadingSprite& fading = state.fading.at(layer);
  const int step = report.frame - fading.began;
  return step >= 0 && step < blend_frames && report.plan.decisions[layer].action != regulator::Action::Drop &&
         !state.memory[layer].placement.empty();
}

}  // namespace

void begin_fade(const Pipeline& pipeline, PipelineState& state, int layer, int frame) {
  if (!regulator::blends(pipeline.settings.regulator)) return;
  const LayerMemory& memory = state.memory[layer];
  state.fading.erase(layer);
  state.fading_sprites.drop(layer);
  const bool was_carried = memory.frame_shown == frame - 1 && memory.frame_rendered < frame - 1;
  if (!memory.then || !was_carried || memory.placement.empty()) return;
  state.fading[layer] = {memory, frame};
  if (memory.drawn) state.fading_sprites.put(layer, *state.sprites.find(layer));
}

Fades carry_fades(const Pipeline& pipeline, PipelineState& state, FrameReport& report) {
  Fades fades;
  for (auto it = state.fading.begin(); it != state.fading.end();) {
    const auto& [layer, fading] = *it;
    std::optional<FadingOut> out;
    if (goes_on(state, report, layer, pipeline.settings.regulator.blend_frames))
      out = carried(pipeline, state, layer, fading, report);
    if (out) {
      fades.out[layer] = *out;
      ++it;
    } else {
      fades.ended.insert(layer);
      state.fading_sprites.drop(layer);
      it = state.fading.erase(it);
    }
  }
  return fades;
}

}  // namespace talisman::sequences
