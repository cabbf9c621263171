// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The key `swarm` of a sequence file.

#include "sequences/content/key_table.h"
#include "sequences/content/swarm/swarm.h"

namespace talisman::sequences {

const Table<SwarmContent>& swarm_keys();

}  // namespace talisman::sequences
