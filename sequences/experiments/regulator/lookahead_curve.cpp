// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/regulator/lookahead_curve.h"

#include <algorithm>
#include <array>

#include "sequences/pipeline/step.h"
#include "sequences/results/frame_lines.h"
#include "sequences/results/summary.h"

namespace talisman::sequences {
namespace {

using regulator::Policy;
using regulator::RegulatorOptions;

/// A way to know the coming motion; one curve each.
struct CurvePrediction {
  const char* name;
  void (*choose)(RegulatorOptions&);
};
constexpr std::array kPredictions = {
    CurvePrediction{"known motion", [](RegulatorOptions&) {}},
    CurvePrediction{"predicted linearly",
                    [](RegulatorOptions& o) { o.lookahead.predict = regulator::Prediction::Linear; }},
};

Summary plan_of(const Sequence& sequence, Settings settings, const RegulatorOptions& options,
                const ExperimentFrames& frames) {
  settings.regulator = options;
  const Pipeline pipeline = make_pipeline(*sequence.scene, sequence.layers, settings);
  PipelineState state(pipeline);
  Summary summary = start_summary(pipeline, sequence.name);
  for (int frame = 0; frame <= frames.last; ++frame) {
    const FrameReport report = step(pipeline, state, frame, nullptr);
    if (frame < frames.first) continue;
    add_decisions(summary, report, state);
    summary.frames.push_back(line_of(report));
  }
  return summary;
}

LookaheadPoint point_of(const Summary& summary, const char* prediction, int lookahead) {
  LookaheadPoint point{
      prediction, lookahead, 0, summary.mean_update_rate(), 0, summary.planning_us_per_layer_and_frame()};
  for (const LayerSummary& layer : summary.layers) {
    point.renders += layer.renders;
    point.max_geometric_px = std::max(point.max_geometric_px, layer.max_geometric_px);
  }
  return point;
}

}  // namespace

std::vector<int> compared_lookaheads() { return {0, 1, 2, 4, 8, 16, 32, 64}; }

LookaheadCurve lookahead_curve(const Sequence& sequence, const Settings& settings,
                               const ExperimentFrames& frames) {
  RegulatorOptions options = settings.regulator;
  LookaheadCurve curve;
  curve.geometric_px = options.thresholds.geometric_px;
  curve.display_px = settings.view.display_px;
  options.policy = Policy::Threshold;
  const LookaheadPoint threshold = point_of(plan_of(sequence, settings, options, frames), "", 0);
  options.policy = Policy::Oracle;
  const LookaheadPoint oracle = point_of(plan_of(sequence, settings, options, frames), "", 0);
  curve.threshold_renders = threshold.renders, curve.threshold_rate = threshold.mean_update_rate;
  curve.oracle_renders = oracle.renders, curve.oracle_rate = oracle.mean_update_rate;
  options.policy = Policy::Lookahead;
  for (const CurvePrediction& prediction : kPredictions)
    for (const int lookahead : compared_lookaheads()) {
      RegulatorOptions predicted = options;
      predicted.lookahead.frames = lookahead;
      prediction.choose(predicted);
      curve.points.push_back(
          point_of(plan_of(sequence, settings, predicted, frames), prediction.name, lookahead));
    }
  return curve;
}

}  // namespace talisman::sequences
