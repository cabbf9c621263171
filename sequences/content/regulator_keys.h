// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The map `regulator` of a sequence file: what decides which sprites are drawn again. The command line overrides
/// it.

#include "regulator/plan.h"
#include "sequences/content/key_table.h"

namespace talisman::sequences {

const Table<regulator::RegulatorOptions>& regulator_keys();

}  // namespace talisman::sequences
