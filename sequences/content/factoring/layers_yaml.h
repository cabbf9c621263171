// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Layers and their order as the keys `layers` and `order` of a sequence file, which reads back to the same.

#include <span>
#include <string>
#include <vector>

#include "layers/layer.h"
#include "sequences/content/factoring/planned_factoring.h"

namespace talisman::sequences {

/// `{extents: whole, warp: per2}`: what is not as it is without the key. Empty: nothing is.
std::string preferences_yaml(const layers::LayerPreferences& preferences);

/// The list `order`; `[]` where there are no pairs.
std::string order_yaml(std::span<const layers::LayerSpec> specs, std::span<const SpecPair> order);

/// Both keys. `in_model`: in front of the names of parts, "robot/" for a model that a sequence calls robot; not of the
/// parts in `of_sequence`, which the sequence itself has.
std::string layers_yaml(std::span<const layers::LayerSpec> specs, std::span<const SpecPair> order,
                        const std::string& in_model = "", const std::vector<std::string>& of_sequence = {});

}  // namespace talisman::sequences
