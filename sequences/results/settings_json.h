// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The settings of a run as one flat JSON object: what run.json holds, what --resume compares, what reports
/// print. Choices are written as the words by which users choose them; what has no limit, or is off by not
/// being there, is null.

#include <nlohmann/json_fwd.hpp>

#include "sequences/pipeline/step.h"

namespace talisman::sequences {

/// One entry per field of Settings (settings_fields.h).
nlohmann::ordered_json json_of(const Settings& settings);

}  // namespace talisman::sequences
