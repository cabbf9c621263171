// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman plan SEQUENCE --split LAYER`: what if this layer were split? The sequence as it is, and with each part of
/// the layer as a layer of its own, both planned (results/factoring/split_layer.h). Nothing is written.

#include <iosfwd>
#include <string>

#include "sequences/commands/options.h"

namespace talisman::sequences {

/// Throws InputError.
int run_split(const CommandLine& line, const std::string& layer, std::ostream& out);

}  // namespace talisman::sequences
