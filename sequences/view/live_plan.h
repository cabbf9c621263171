// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The plan of one setting, made slice by slice: the page asks again until it has all frames, so what nobody asks for any
/// more costs nothing. Its numbers are those of the tables of columns (results/column_tables.h), by their names.

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sequences/pipeline/step.h"
#include "sequences/results/columns.h"
#include "sequences/view/live_scene.h"

namespace talisman::sequences {

/// Of decisions.jsonl, and behind them those of changes.jsonl (results/report/changes.h).
std::vector<ColumnInfo> live_columns();

class LivePlan {
 public:
  explicit LivePlan(LiveScene live);
  LivePlan(const LivePlan&) = delete;
  LivePlan& operator=(const LivePlan&) = delete;

  int frames() const { return live_.variant.sequence.frames; }
  int planned() const { return static_cast<int>(planned_.size()); }
  const Settings& settings() const { return pipeline_.settings; }
  /// Another flight of the camera, where there is one; all is planned anew. False where the camera is the sequence's own.
  bool follow(const std::vector<CameraPose>& flight);
  /// Plans further frames for about `ms`, at least one while there are any; no further once `is_stale` says so.
  void advance(double ms, const std::function<bool()>& is_stale);
  /// The frames from `from` on that are planned: {"planned", "frames", "decisions": a list per column of the map,
  /// "frame_lines": a list per column of the curves}.
  nlohmann::ordered_json rows(int from) const;
  /// All `live_columns` of one frame, {"columns": a list per column}; of no rows where it is not planned.
  nlohmann::ordered_json frame(int frame) const;
  /// All lines of the frames that are planned, as decisions.jsonl has them.
  std::string lines() const;

 private:
  struct PlannedRow {
    int layer = -1, map = -1;  ///< of the report; one of the two
    std::optional<layers::SpritePlacement> placement{};
  };
  struct PlannedFrame {
    FrameReport report;
    std::vector<PlannedRow> rows;
  };
  std::map<std::string, std::string> changes_of(int frame) const;
  /// Shows the rows of the planned frames in [from, to).
  template <typename Show>
  void for_each_row(int from, int to, const Show& show) const;

  LiveScene live_;
  Pipeline pipeline_;
  std::unique_ptr<PipelineState> state_;
  std::vector<PlannedFrame> planned_;
};

}  // namespace talisman::sequences
