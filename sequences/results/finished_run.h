// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The folder of a complete run, as it is read again: by `explain`, by `diff`.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace talisman::sequences {

/// Does a run.json lie there?
bool holds_run(const std::string& folder);

/// run.json of a complete run of this version. Throws InputError that names the folder.
nlohmann::ordered_json finished_run(const std::string& folder);

/// "all", "changed" or "none": the decisions that the run's folder holds.
std::string decisions_kept(const nlohmann::ordered_json& run);
/// Throws InputError unless it holds all. `what` needs them: "a report".
void require_all_decisions(const nlohmann::ordered_json& run, const std::string& folder,
                           const std::string& what);

/// The lines of DIR/decisions.jsonl. Throws InputError that names file and line.
std::vector<nlohmann::ordered_json> finished_decisions(const std::string& folder);

/// DIR/summary.json. Throws InputError.
nlohmann::ordered_json finished_summary(const std::string& folder);

}  // namespace talisman::sequences
