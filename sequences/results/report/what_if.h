// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What would half the threshold cost, and twice? The same run planned again with both (no pixel, no file of its own):
/// what-if.json, `talisman.what_if/1`, which the report shows.

#include <nlohmann/json_fwd.hpp>

#include "sequences/content/sequence.h"
#include "sequences/results/planned.h"

namespace talisman::sequences {

/// Does the policy look at a threshold?
bool has_threshold(const Settings& settings);

/// Writes DIR/what-if.json: plans at ½ and 2 times `geometric_px`, and between them `now`, the run itself over `range`.
void write_what_if(const Sequence& sequence, const Settings& settings, const FrameRange& range,
                   const Summary& now, const std::string& folder);

/// The two steps of it apart, where `now` is not known yet: the plans, and the file with the run itself between them.
nlohmann::ordered_json what_if_plans(const Sequence& sequence, const Settings& settings,
                                     const FrameRange& range);
void write_what_if(const nlohmann::ordered_json& plans, const Summary& now, const std::string& folder);

}  // namespace talisman::sequences
