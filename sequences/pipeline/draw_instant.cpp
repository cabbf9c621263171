// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/draw_instant.h"

#include <algorithm>
#include <cstdint>
#include <optional>

#include "fiducials/place_floor.h"
#include "fiducials/shade_drift.h"
#include "layers/check.h"
#include "layers/rest.h"
#include "regulator/policies.h"
#include "sequences/pipeline/latency/late_camera.h"
#include "sequences/pipeline/layer_planning.h"

namespace talisman::sequences {

namespace {

/// Would the layer's sprite of one instant be shown at another?
class Judge {
 public:
  Judge(const Pipeline& pipeline, PipelineState& state, int layer, int frame_rendered)
      : pipeline_(pipeline),
        state_(state),
        layer_(layer),
        frame_rendered_(frame_rendered),
        limit_px_(pipeline.settings.regulator.thresholds.geometric_px /
                  state.layers[layer].preferences.importance.geometric),
        is_affine_(warp::family_of(curve_of(pipeline, state.layers[layer])) != warp::Family::Perspective) {
    if (!predicts(pipeline) && !is_late(pipeline) && !pipeline.culling)
      rest_.emplace(pipeline.scene, state.layers[layer]);
  }

  bool serves(int instant, int frame) {
    ++counts_.judged;
    if (rest_ && rest_->rests(time_of(pipeline_, instant), time_of(pipeline_, frame))) return true;
    const layers::LayerState& now = captured_states(pipeline_, state_, frame)[layer_];
    if (!now.touches_display) return true;  // not shown
    const layers::LayerState& then = captured_states(pipeline_, state_, instant)[layer_];
    if (!then.touches_display) return false;  // nothing to draw
    if (limit_px_ < warp::kHugePx && is_farther(then, now, frame - frame_rendered_)) return false;
    ++counts_.evaluated;
    const regulator::LayerAssessment assessment =
        assess_sprite(pipeline_, state_.layers, then, captured_placement(pipeline_, state_, layer_, instant),
                      now, frame - frame_rendered_);
    return regulator::violation_of(assessment, pipeline_.settings.regulator).empty();
  }

  const LookaheadReport& counts() const { return counts_; }

 private:
  /// Is the sprite farther off than it may be, whatever its warp?
  bool is_farther(const layers::LayerState& then, const layers::LayerState& now, int age_frames) const {
    if (fiducials::shade_runs_beyond(then, now, limit_px_)) return true;
    if (!is_affine_) return false;
    const layers::Polyhedron& hull = state_.layers.bound(layer_).hull;
    return fiducials::affine_floor_px(then, now, hull) > limit_px_ ||
           fiducials::affine_floor_px(layers::correspond(then, now, hull, age_frames)) > limit_px_;
  }

  const Pipeline& pipeline_;
  PipelineState& state_;
  int layer_, frame_rendered_;
  double limit_px_;  ///< error beyond which a sprite is never shown
  bool is_affine_;   ///< are its warps affine or simpler?
  std::optional<layers::LayerRest> rest_;
  LookaheadReport counts_;
};

/// The last frame that is looked at from `frame`: of policies that know what comes the sequence's last one, or kFarthestLook_frames
/// behind the instants. What is expected holds for a while only: a sprite of N frames ahead serves about as long after as before.
int last_looked_at(const Pipeline& pipeline, int frame) {
  const regulator::RegulatorOptions& options = pipeline.settings.regulator;
  const int last = pipeline.settings.frames - 1;
  if (options.policy == regulator::Policy::Oracle) return last;
  const std::int64_t frames = options.lookahead.frames;
  const std::int64_t beyond = predicts(pipeline) ? frames : kFarthestLook_frames;
  return static_cast<int>(std::min<std::int64_t>(last, frame + frames + beyond));
}

}  // namespace

regulator::FrameRun choose_draw_instant(const Pipeline& pipeline, PipelineState& state, int layer, int frame,
                                        LookaheadReport* counts) {
  TALISMAN_CHECK_LE(frame, pipeline.settings.frames - 1);  // it is not the length of the sequence
  Judge judge(pipeline, state, layer, frame);
  const auto serves = [&judge](int instant, int shown_at) { return judge.serves(instant, shown_at); };
  const regulator::RegulatorOptions& options = pipeline.settings.regulator;
  const int last = last_looked_at(pipeline, frame);
  const regulator::FrameRun run =
      options.policy == regulator::Policy::Oracle
          ? regulator::longest_run(frame, regulator::Instants{0, last}, last, serves)
          : regulator::longest_run(frame, options.lookahead.frames, last, serves);
  if (counts != nullptr) {
    counts->judged += judge.counts().judged;
    counts->evaluated += judge.counts().evaluated;
  }
  return run;
}

bool looks_no_farther(const Pipeline& pipeline, int frame, const regulator::FrameRun& run) {
  return run.last == last_looked_at(pipeline, frame) && run.last < pipeline.settings.frames - 1;
}

}  // namespace talisman::sequences
