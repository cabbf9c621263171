// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Scenes of many independent layers, for the regulator's properties and its planning time.

#include "layers/scene.h"

namespace talisman::tests {

/// `layers` cubes of random size that fly and turn along random closed paths of `period_s` in front of a
/// camera, which sways on one of its own. Parts "ship 0", "ship 1", …; all motion is by looped keys, so that
/// frames one period apart are equal to the bit where period and frame times are dyadic. Some ships leave the
/// display for a while, as they do in a chase.
layers::Scene fleet_scene(int layers, unsigned seed, double period_s = 4);

/// The same scene with time running backwards: at(t) is at(period_s - t) of the other.
layers::Scene reversed_fleet_scene(int layers, unsigned seed, double period_s = 4);

}  // namespace talisman::tests
