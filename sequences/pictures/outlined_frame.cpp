// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/outlined_frame.h"

#include "sequences/pictures/overlay.h"

namespace talisman::sequences {

Image8 with_outlines(const FrameReport& report) {
  std::vector<Outline> outlines;
  for (const ShownSprite& sprite : report.shown)
    outlines.push_back({sprite.screen_from_sprite, sprite.size_px, sprite.age_frames,
                        outline_label(report.layers[sprite.layer].name, sprite.age_frames), sprite.layer});
  Image8 image = to_image8(report.picture);
  draw_overlay(image, outlines);
  return image;
}

}  // namespace talisman::sequences
