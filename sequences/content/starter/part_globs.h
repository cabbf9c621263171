// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Globs that name the parts of each layer, as short as a person would write them: "robot/arm*" instead of a list.

#include <span>
#include <string>
#include <vector>

#include "layers/layer.h"

namespace talisman::sequences {

/// For each of `layers` (geometry, in their order) globs which, tried in that order, give it the parts that it has.
/// Of several parts the shortest beginning up to a letter's end that names them alone, then "*"; else the names
/// themselves. `names`: of all parts. A "*" in a name is written "?".
std::vector<std::vector<std::string>> part_globs(std::span<const layers::Layer> layers,
                                                 const std::vector<std::string>& names);

}  // namespace talisman::sequences
