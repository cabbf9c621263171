// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What is in a sequence before anything is drawn: layers, polygons, memory, and the effects that it calls
/// for, with reasons.

#include <string>

#include "sequences/content/sequence.h"

namespace talisman::sequences {

std::string inspection_text(const Sequence& sequence);
std::string inspection_json(const Sequence& sequence);  ///< schema talisman.inspect/1
/// Every number of the hardware profile, with source and whether it is confirmed or assumed.
std::string profile_text();

}  // namespace talisman::sequences
