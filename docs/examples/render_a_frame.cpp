// SPDX-License-Identifier: Apache-2.0
// Draws frame 12 of ten boxes that turn, as the compositor shows it: sprites of earlier frames are warped where that
// is good enough. The picture goes to standard output, what it is made of to standard error:
//   render_a_frame > boxes.ppm
#include <talisman/chunker/composite.h>
#include <talisman/sequences/pipeline/make_pipeline.h>
#include <talisman/sequences/pipeline/step.h>

#include <cstdio>

#include "boxes.h"

int main() {
  using namespace talisman;
  const layers::Scene scene = ten_boxes();
  const layers::LayerSet boxes = layers::factor(scene, layers::default_layer_specs(scene));
  sequences::Settings settings;
  settings.view.display_px = {640, 360};
  settings.frames = 24;
  const sequences::Pipeline pipeline = sequences::make_pipeline(scene, boxes, settings);
  const chunker::PreparedScene prepared(scene, settings.render);
  sequences::PipelineState state(pipeline);
  for (int frame = 0; frame < 12; ++frame) sequences::step(pipeline, state, frame, nullptr);
  const sequences::FrameReport report = sequences::step(pipeline, state, 12, &prepared);

  const std::vector<std::uint8_t> rgb = chunker::srgb_bytes(report.picture);
  std::printf("P6\n%d %d\n255\n", report.picture.width, report.picture.height);
  const bool is_whole =
      std::fwrite(rgb.data(), 1, rgb.size(), stdout) == rgb.size() && std::fflush(stdout) == 0;
  std::fprintf(stderr, "%dx%d pixels, %zu sprites, %d of them planned in earlier frames\n",
               report.picture.width, report.picture.height, report.shown.size(), report.late_renders);
  return is_whole ? 0 : 1;
}
