// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A scene run through the whole pipeline, for tests.

#include <utility>
#include <vector>

#include "sequences/pipeline/step.h"
#include "tests/support/scenes.h"

namespace talisman::sequences {

/// A scene with its layers, ready to run.
struct SmallRun {
  layers::Scene scene;
  layers::LayerSet layers;
  Settings settings;

  explicit SmallRun(layers::Scene scene_in) : scene(std::move(scene_in)) {
    layers = layers::factor(scene, tests::one_layer_per_part(scene));
    settings.view.display_px = {200, 150};
  }

  SmallRun& policy(regulator::Policy policy, double geometric_px = 4) {
    settings.regulator.policy = policy;
    settings.regulator.thresholds.geometric_px = geometric_px;
    return *this;
  }

  SmallRun& lookahead(int frames) {
    settings.regulator.lookahead.frames = frames;
    return *this;
  }

  /// The whole sequence: its length is known to the policies that look ahead.
  std::vector<FrameReport> run(int frames, bool draw) const {
    Settings of_run = settings;
    of_run.frames = frames;
    const Pipeline pipeline = make_pipeline(scene, layers, of_run);
    const chunker::PreparedScene prepared(scene);
    PipelineState state(pipeline);
    std::vector<FrameReport> reports;
    for (int frame = 0; frame < frames; ++frame)
      reports.push_back(step(pipeline, state, frame, draw ? &prepared : nullptr));
    return reports;
  }
};

inline int count(const std::vector<FrameReport>& reports, regulator::Action action) {
  int n = 0;
  for (const FrameReport& report : reports)
    for (const regulator::LayerDecision& decision : report.plan.decisions) n += decision.action == action;
  return n;
}

}  // namespace talisman::sequences
