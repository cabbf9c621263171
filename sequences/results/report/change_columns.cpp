// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/column_json.h"
#include "sequences/results/report/changes.h"

namespace talisman::sequences {

namespace {

template <typename Get>
Column<Change> of_change(std::string name, std::string path, std::string unit, std::string meaning, Get get) {
  return computed<Change>(std::move(name), std::move(path), std::move(unit), std::move(meaning), get);
}

std::vector<Column<Change>> columns_of_changes() {
  using C = Change;
  return {
      of_change("frame", "frame", "", "number of the frame", [](const C& c) { return c.frame; }),
      of_change("layer", "layer", "", "name of the layer", [](const C& c) { return c.layer; }),
      of_change("since_frame", "since_frame", "", "the frame as of which its old sprite was drawn",
                [](const C& c) { return c.since_frame; }),
      of_change("error_px", "geometric_px", "px",
                "geometric error of the old sprite: `warp_geometric_px` of its decision, of the policy "
                "`hold` `held_geometric_px`",
                [](const C& c) { return c.geometric_px; }),
      of_change("camera_px", "camera_px", "px",
                "the same, had only the camera changed since; null, here and below: the layer would then not "
                "be in view",
                [](const C& c) { return c.camera_px; }),
      of_change("own_motion_px", "own_motion_px", "px", "had only the layer's own parts moved",
                [](const C& c) { return c.own_motion_px; }),
      of_change("light_px", "light_px", "px",
                "had only the lights changed: shadows and highlights that run over it",
                [](const C& c) { return c.light_px; }),
      of_change("other_layers_px", "other_layers_px", "px",
                "had only other layers moved: their shadows and mirrored pictures",
                [](const C& c) { return c.other_layers_px; }),
      of_change("separable", "separable", "",
                "the four sum to the error within 10 %; else they cancel out or act together, and each is "
                "what it would have done alone",
                [](const C& c) { return c.separable; })};
}

}  // namespace

const ColumnTable<Change>& change_table() {
  static const ColumnTable<Change> table{"changes", "talisman.change/1", columns_of_changes(), {}};
  return table;
}

std::string json_of(const Change& change) {
  static const RowJson<Change> row(change_table());
  return row.write(change).dump();
}

}  // namespace talisman::sequences
