// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How many times more can be drawn? [LS97 7, 8, footnote 12]
///
///   speed-up = what `reference` draws / what is drawn on demand,     polygons, or texels of sprites, of all frames
///
/// "Typically" 3 to 5 for moving cameras; 3 to 10 in all. With a fixed camera what stands still is drawn once, so that
/// only what moves is left: the sequences of the other rows, with the camera where it is in the middle of them. A
/// sequence in which nothing moves then has no speed-up but an end of drawing, and is none of those rows.

#include <string>
#include <vector>

#include "sequences/experiments/reproduction/paper.h"

namespace talisman::sequences {

struct SpeedUp {
  std::string name;
  double factor = 0;  ///< ≥ 1 as a rule; infinite where nothing was drawn
};

/// In the range, all of them; none is none.
Finding all_in_range(const std::vector<SpeedUp>& speed_ups, double least, double most);

Item moving_cameras();
Item fixed_cameras();

}  // namespace talisman::sequences
