// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What does it save to draw some sprites at less than the display's resolution? [LS97 Fig. 24]
///
/// The chicken crosses the road in 80 layers. Those that the figure does not show singly are drawn at 40 to 50 % of the
/// display's resolution, by area (Fig. 4 counts so): a scale of 0.63 to 0.71 a side; the other reading is 0.40 to 0.50 a
/// side. The wing and the tailgate occlude each other in turn and share a sprite.

#include <string>
#include <vector>

#include "sequences/experiments/reproduction/paper.h"

namespace talisman::sequences {

struct SpriteResolutions {
  std::vector<double> scales;  ///< of the author's layers, sprite texels per pixel of the display, each axis
  std::vector<std::string> aggregates;  ///< names of the sprites that several layers shared
};

struct PixelUse {
  double drawn = 0;      ///< texels, of the whole sequence, as its author says
  double reference = 0;  ///< every layer in every frame, at the same resolutions
  double full = 0;       ///< the same at the display's resolution
};

Finding layer_count(const SpriteResolutions& sprites);  ///< 80
/// Each layer is at the display's resolution, or at 40 to 50 % by area; some are.
Finding reduced_layers(const SpriteResolutions& sprites);
/// At least one sprite is shared, by layers of which one has "wing" and one "tailgate" in its name.
Finding wing_and_tailgate(const SpriteResolutions& sprites);
Finding pixels_of_reference(const PixelUse& use);  ///< at most 60 %
Finding pixels_of_full(const PixelUse& use);       ///< at most 30 %

Item figure_24();

}  // namespace talisman::sequences
