// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Why was a layer drawn in this frame, or why not? Its line of decisions.jsonl in words: every fiducial against its
/// limit, to the digit.

#include <string>
#include <vector>

#include "sequences/results/decision_history.h"

namespace talisman::sequences {

/// What one fiducial said in the frame.
struct FiducialFinding {
  std::string name;     ///< "geometric"
  std::string setting;  ///< that limits it: "geometric_px"
  std::string value;    ///< as decisions.jsonl has it; empty: was not computed
  std::string unit;     ///< "px"; empty: has none
  std::string limit;    ///< as run.json has it; empty: not regulated
  std::string where;    ///< "at (312.4, 200.1)"; empty: nowhere
  std::string remark;   ///< why it was not computed, which light
  bool is_beyond = false;
};

/// Of a layer that has an old sprite and is in view; none of others. `settings` as run.json has them.
std::vector<FiducialFinding> findings_of(const nlohmann::ordered_json& line,
                                         const nlohmann::ordered_json& settings);

/// One layer in full, several lines.
std::string explanation_of(const LayerHistory& layer, const nlohmann::ordered_json& settings);

/// All layers of the frame, a line each.
std::string overview_of(const std::vector<LayerHistory>& layers);

}  // namespace talisman::sequences
