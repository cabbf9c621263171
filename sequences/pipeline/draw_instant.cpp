// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/draw_instant.h"

#include <algorithm>
#include <cstdint>

#include "layers/check.h"
#include "regulator/policies.h"
#include "sequences/pipeline/layer_planning.h"

namespace talisman::sequences {

namespace {

/// Would the layer's sprite of one instant be shown at another?
class Judge {
 public:
  Judge(const Pipeline& pipeline, PipelineState& state, int layer, int frame_rendered)
      : pipeline_(pipeline), state_(state), layer_(layer), frame_rendered_(frame_rendered) {}

  bool serves(int instant, int frame) {
    const layers::LayerState& now = captured_states(pipeline_, state_, frame)[layer_];
    if (!now.touches_display) return true;  // not shown
    const layers::LayerState& then = captured_states(pipeline_, state_, instant)[layer_];
    if (!then.touches_display) return false;  // nothing to draw
    const regulator::LayerAssessment assessment =
        assess_sprite(pipeline_, state_.layers, then, captured_placement(pipeline_, state_, layer_, instant),
                      now, frame - frame_rendered_);
    return regulator::violation_of(assessment, pipeline_.settings.regulator).empty();
  }

 private:
  const Pipeline& pipeline_;
  PipelineState& state_;
  int layer_, frame_rendered_;
};

}  // namespace

regulator::FrameRun choose_draw_instant(const Pipeline& pipeline, PipelineState& state, int layer,
                                        int frame) {
  const regulator::RegulatorOptions& options = pipeline.settings.regulator;
  const int last = pipeline.settings.frames - 1;
  TALISMAN_CHECK_LE(frame, last);  // Settings::frames is not the length of the sequence
  Judge judge(pipeline, state, layer, frame);
  const auto serves = [&judge](int instant, int shown_at) { return judge.serves(instant, shown_at); };
  if (options.policy == regulator::Policy::Oracle)
    return regulator::longest_run(frame, regulator::Instants{0, last}, last, serves);
  if (!predicts(pipeline)) return regulator::longest_run(frame, options.lookahead.frames, last, serves);
  // What is expected holds for a while only: a sprite of N frames ahead serves about as long after as before.
  const std::int64_t horizon = frame + 2 * std::int64_t{options.lookahead.frames};
  return regulator::longest_run(frame, options.lookahead.frames,
                                static_cast<int>(std::min<std::int64_t>(last, horizon)), serves);
}

}  // namespace talisman::sequences
