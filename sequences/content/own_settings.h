// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The settings of a run about which nothing is said but by the sequence itself.

#include "sequences/content/sequence.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

Settings own_settings(const Sequence& sequence);

}  // namespace talisman::sequences
