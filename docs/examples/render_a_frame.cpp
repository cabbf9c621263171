// SPDX-License-Identifier: Apache-2.0
// Draws frame 12 of ten boxes that turn, as the compositor shows it, into boxes.ppm: sprites of earlier frames are
// warped where that is good enough.
#include <talisman/chunker/composite.h>
#include <talisman/sequences/pipeline/step.h>

#include <cstdio>
#include <fstream>

#include "boxes.h"

int main() {
  using namespace talisman;
  const layers::Scene scene = ten_boxes();
  const layers::LayerSet boxes = layers::factor(scene, layers::default_layer_specs(scene));
  sequences::Settings settings;
  settings.view.display_px = {640, 360};
  settings.frames = 24;
  const sequences::Pipeline pipeline(scene, boxes, settings);
  const chunker::PreparedScene prepared(scene, settings.render);
  sequences::PipelineState state(pipeline);
  for (int frame = 0; frame < 12; ++frame) sequences::step(pipeline, state, frame, nullptr);
  const sequences::FrameReport report = sequences::step(pipeline, state, 12, &prepared);

  const std::vector<std::uint8_t> rgb = chunker::srgb_bytes(report.picture);
  std::ofstream file("boxes.ppm", std::ios::binary);
  file << "P6\n" << report.picture.width << " " << report.picture.height << "\n255\n";
  file.write(reinterpret_cast<const char*>(rgb.data()), static_cast<std::streamsize>(rgb.size()));
  std::printf("boxes.ppm: %dx%d pixels, %zu sprites, %d of them drawn before frame 12\n", report.picture.width,
              report.picture.height, report.shown.size(), report.late_renders);
  return file ? 0 : 1;
}
