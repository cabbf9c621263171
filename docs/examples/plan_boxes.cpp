// SPDX-License-Identifier: Apache-2.0
// Plans one second of ten boxes that turn, a layer each, without drawing a pixel, and prints when each is drawn again and
// why: the faster a box turns, the sooner its old picture is too wrong.
#include <talisman/sequences/pipeline/step.h>

#include <cstdio>

#include "boxes.h"

int main() {
  using namespace talisman;
  const layers::Scene scene = ten_boxes();
  const layers::LayerSet boxes = layers::factor(scene, layers::default_layer_specs(scene));
  sequences::Settings settings;
  settings.view.display_px = {640, 360};
  settings.regulator.policy = regulator::Policy::Threshold;
  settings.regulator.geometric_px = 2;
  settings.frames = 24;

  const sequences::Pipeline pipeline(scene, boxes, settings);
  sequences::PipelineState state(pipeline);
  int renders = 0;
  for (int frame = 0; frame < settings.frames; ++frame) {
    const sequences::FrameReport report = sequences::step(pipeline, state, frame, nullptr);
    for (const regulator::LayerDecision& decision : report.plan.decisions) {
      if (decision.action != regulator::Action::Rerender) continue;
      ++renders;
      std::printf("frame %2d  %s: %s\n", frame, boxes.layers[decision.layer].name.c_str(),
                  decision.reason.c_str());
    }
  }
  std::printf("%d renders of 240\n", renders);
}
