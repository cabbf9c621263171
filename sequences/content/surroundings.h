// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What surrounds a scene, as a sequence file says it: the ground (ground.h) and the sky (sky.h).

#include "sequences/content/ground.h"
#include "sequences/content/key_table.h"
#include "sequences/content/sky.h"

namespace talisman::sequences {

const Table<TerrainContent>& terrain_keys();
const Table<SkyContent>& sky_keys();

}  // namespace talisman::sequences
