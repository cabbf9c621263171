// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/audit.h"
#include "sequences/results/column_tables.h"

namespace talisman::sequences {

namespace {

template <typename Get>
Column<LayerAudit> of_audit(std::string name, std::string unit, std::string meaning, Get get) {
  const std::string path = name;
  return computed<LayerAudit>(std::move(name), path, std::move(unit), std::move(meaning), get);
}

std::vector<Column<LayerAudit>> columns_of_audit() {
  using A = LayerAudit;
  return {of_audit("layer", "", "its name", [](const A& a) { return a.layer; }),
          of_audit("reuses", "frames", "in which an old sprite of it was shown",
                   [](const A& a) { return a.reuses; }),
          of_audit("audited", "frames", "of these, in which it was drawn fresh as well",
                   [](const A& a) { return a.audited; }),
          of_audit("beyond", "frames", "of these, in which the picture is worse than the fiducials said",
                   [](const A& a) { return a.beyond; }),
          of_audit("marked", "", "beyond in two audited frames or more: its fiducials cannot be trusted",
                   [](const A& a) { return a.marked(); }),
          of_audit("worst_frame", "", "the audited frame that is farthest beyond, or nearest to it; -1: none",
                   [](const A& a) { return a.worst.frame; }),
          of_audit("age_frames", "frames", "of its sprite in that frame",
                   [](const A& a) { return a.worst.age_frames; }),
          of_audit("geometric_px", "px", "said in that frame: error of what is displayed",
                   [](const A& a) { return a.worst.geometric_px; }),
          of_audit("photometric", "1",
                   "said: largest change of a colour, linear light; 0 where no light can change",
                   [](const A& a) { return a.worst.photometric; }),
          of_audit("shift_p95_px", "px", "seen: apparent shift, 95th percentile over what has structure",
                   [](const A& a) { return a.worst.shift_px; }),
          of_audit("rms", "1", "seen: RMS in linear light that no shift within geometric_px explains",
                   [](const A& a) { return a.worst.rms; }),
          of_audit("missing", "1", "seen: share of the layer that its sprite does not have",
                   [](const A& a) { return a.worst.missing; }),
          of_audit("flip", "", "seen: FLIP, mean over its part of the display",
                   [](const A& a) { return a.worst.flip; }),
          of_audit("should_have_spoken", "", "the fiducial that was too small; empty: none",
                   [](const A& a) { return a.worst.should_have_spoken(); }),
          of_audit("sheet", "", "picture of that frame in DIR/audit: shown, fresh, difference",
                   [](const A& a) { return a.sheet; })};
}

}  // namespace

const ColumnTable<LayerAudit>& audit_table() {
  static const ColumnTable<LayerAudit> table{"audit", "", columns_of_audit(), {}};
  return table;
}

}  // namespace talisman::sequences
