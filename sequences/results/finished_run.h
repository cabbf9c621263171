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

/// The lines of DIR/decisions.jsonl. Throws InputError that names file and line.
std::vector<nlohmann::ordered_json> finished_decisions(const std::string& folder);

/// DIR/summary.json. Throws InputError.
nlohmann::ordered_json finished_summary(const std::string& folder);

}  // namespace talisman::sequences
