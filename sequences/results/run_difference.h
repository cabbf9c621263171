// SPDX-License-Identifier: Apache-2.0
#pragma once

/// In what do two runs differ, but for their pictures? Settings, what was drawn how often, what it cost, and every
/// decision, from the files of their folders (render or plan).

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace talisman::sequences {

/// A setting, or a part of what was run; as run.json has it, "-" where it is not there.
struct SettingDifference {
  std::string name, a, b;
};

/// A number of summary.json. Empty: has none.
struct CostDifference {
  std::string name;
  std::optional<double> a, b;
};

/// A layer, aggregate or shadow map; empty where a run has no layer of the name.
struct LayerRates {
  std::string layer;
  std::optional<double> renders_a, renders_b, rate_a, rate_b;
  int decided_otherwise = 0;  ///< frames of both in which it was
};

struct DecisionDifference {
  int frame = 0;
  std::string layer, a, b;  ///< "rerender: geometric 4.7 > 4 px"; "-": has no line
};

struct RunDifference {
  std::vector<SettingDifference> settings;  ///< that differ
  std::vector<CostDifference> costs;
  std::vector<LayerRates> layers;
  int frames = 0;                           ///< that both have
  std::vector<int> only_a, only_b;          ///< frames
  int decisions = 0;                        ///< of those frames: lines of either run
  std::vector<DecisionDifference> decided;  ///< that differ in what was done, by frame
  bool is_partial() const { return !only_a.empty() || !only_b.empty(); }
};

/// Throws InputError: a folder holds no complete run of this version, or its files are not as a run writes them.
RunDifference run_difference(const std::string& folder_a, const std::string& folder_b);

/// Tables for people; `most_decisions` of those that differ.
std::string text_of(const RunDifference& difference, std::size_t most_decisions = 10);
nlohmann::ordered_json json_of(const RunDifference& difference);

}  // namespace talisman::sequences
