// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman motion SEQUENCE|MODEL`: what moves when (sequences/pipeline/predictive/motion_study.h), as text, JSON
/// (schema talisman.motion/1) or CSV, one row per part and slice; and the groups that move as one as layers to paste.

#include <iosfwd>
#include <optional>
#include <string>

#include "sequences/commands/options.h"
#include "sequences/pipeline/predictive/motion_study.h"

namespace talisman::sequences {

struct MotionCommand {
  std::string sequence;                ///< name or path
  std::string size;                    ///< "WxH"; empty: the sequence's
  std::string norm;                    ///< "axis", "euclid"
  std::optional<double> geometric_px;  ///< δ; empty: the sequence's
  std::optional<int> lookahead, tree_k;
  bool json = false, csv = false, yaml = false, all = false;
  ContentWords content;
};

/// Throws InputError.
int run_motion(const MotionCommand& command, std::ostream& out);

std::string motion_text(const Sequence& sequence, const MotionStudy& study, bool all_groups);
std::string motion_json(const Sequence& sequence, const MotionStudy& study);
std::string motion_csv(const Sequence& sequence, const MotionStudy& study);

/// One layer for each group, named after its first part; what does not move for itself is one.
std::vector<layers::LayerSpec> layers_of_groups(const Sequence& sequence, const MotionStudy& study);

}  // namespace talisman::sequences
