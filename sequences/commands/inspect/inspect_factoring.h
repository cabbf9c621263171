// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman inspect --factoring`: which layers would cost least, what each split and merge would save, and the layers
/// to paste into a sequence file.

#include <string>

#include "sequences/content/sequence.h"

namespace talisman::sequences {

/// Throws InputError.
std::string inspect_factoring(const Sequence& sequence, int max_layers);

}  // namespace talisman::sequences
