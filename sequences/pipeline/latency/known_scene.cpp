// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/latency/known_scene.h"

#include <algorithm>

#include "layers/advance.h"
#include "layers/predict.h"
#include "layers/predict_kalman.h"
#include "sequences/pipeline/latency/late_camera.h"

namespace talisman::sequences {

namespace {

using layers::SceneFrame;
using regulator::Prediction;

/// Frames before the one that is planned, itself included, that a filter of the whole scene sees.
constexpr int kFilteredFrames = 16;

int frames_needed(Prediction prediction) {
  return prediction == Prediction::Held ? 1 : prediction == Prediction::Linear ? 2 : kFilteredFrames;
}

SceneFrame as_authored(const Pipeline& pipeline, int frame) {
  return pipeline.scene.at(time_of(pipeline, frame));
}

SceneFrame expected(const Pipeline& pipeline, const MotionKnown& known, int frame) {
  const SceneFrame& now = known.past.back();
  const int frames_ahead = frame - known.frame;
  SceneFrame ahead;
  switch (pipeline.settings.regulator.lookahead.predict) {
    case Prediction::Known:
    case Prediction::Held:
      ahead = now;
      ahead.time_s = time_of(pipeline, frame);
      break;
    case Prediction::Linear:
      ahead = layers::predict_linear(known.past.front(), now, frames_ahead);
      break;
    case Prediction::Kalman:
      ahead = layers::predict_kalman(known.past, 1 / pipeline.settings.fps, frames_ahead,
                                     pipeline.settings.regulator.kalman);
      break;
  }
  if (is_late(pipeline)) look_from(ahead, camera_known(pipeline, known.frame, frame));
  return ahead;
}

}  // namespace

double time_of(const Pipeline& pipeline, int frame) { return frame / pipeline.settings.fps; }

bool predicts(const Pipeline& pipeline) {
  return pipeline.settings.regulator.policy == regulator::Policy::Lookahead &&
         pipeline.settings.regulator.lookahead.predict != Prediction::Known;
}

SceneFrame scene_at(const Pipeline& pipeline, int frame) {
  SceneFrame now = as_authored(pipeline, frame);
  if (is_late(pipeline)) look_from(now, camera_known(pipeline, frame, frame));
  return now;
}

const SceneFrame& scene_now(const Pipeline& pipeline, PipelineState& state, int frame) {
  if (state.walked_by != pipeline.motion) state.walked = {};  // of another scene, perhaps
  state.walked_by = pipeline.motion;
  pipeline.motion->advance(state.walked, time_of(pipeline, frame));
  if (!is_late(pipeline)) return state.walked;
  state.seen_late = state.walked;
  look_from(state.seen_late, camera_known(pipeline, frame, frame));
  return state.seen_late;
}

MotionKnown motion_known(const Pipeline& pipeline, int frame) {
  MotionKnown known{frame, {}};
  const int count = frames_needed(pipeline.settings.regulator.lookahead.predict);
  for (int past = std::max(frame - count + 1, 0); past <= frame; ++past)
    known.past.push_back(as_authored(pipeline, past));
  return known;
}

SceneFrame scene_as_known(const Pipeline& pipeline, const PipelineState& state, int frame) {
  const bool is_ahead = state.motion && frame > state.motion->frame;
  return is_ahead ? expected(pipeline, *state.motion, frame) : scene_at(pipeline, frame);
}

SceneFrame scene_expected(const Pipeline& pipeline, int known, int frame) {
  return known == frame ? scene_at(pipeline, frame)
                        : expected(pipeline, motion_known(pipeline, known), frame);
}

}  // namespace talisman::sequences
