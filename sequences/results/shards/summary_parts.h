// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The summary of a part of a run, kept so that parts add up to what one run would have written: counts are added, largest
/// values compared, sums are exact (exact_sum.h), rows keep the order in which they came. The lines of frames are not in
/// it; they are in frames.jsonl.

#include <nlohmann/json.hpp>

#include "sequences/results/summary.h"

namespace talisman::sequences {

nlohmann::ordered_json parts_json(const Summary& summary);
/// Throws nlohmann's exceptions and std::invalid_argument for what is none.
Summary summary_from(const nlohmann::ordered_json& json);

/// Adds what a later part of the same run has.
void add_part(Summary& summary, const Summary& later);

}  // namespace talisman::sequences
