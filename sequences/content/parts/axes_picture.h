// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which way does it look? A picture of the first frame with the axes of the world, and the way that a nose points.

#include "sequences/content/sequence.h"
#include "sequences/files/image_io.h"

namespace talisman::sequences {

/// `size_px` on each side, from the front, the right and above. From the middle of all parts lines to +x (red), +y
/// (green) and +z (blue), a quarter longer than what is there, at
/// least as long as its longest side; and to -z (pink), "nose": that is what a flight, or
/// look_at, points ahead. Cost: one drawing of the scene, and a copy of it.
Image8 axes_picture(const Sequence& sequence, int size_px = 512);

}  // namespace talisman::sequences
