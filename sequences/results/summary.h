// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A whole run in numbers: summary.json (talisman.summary/1), and the table that the tool prints at the end. Wall
/// times are in the printed table and in timing.jsonl, not in summary.json.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "layers/effects.h"
#include "sequences/pipeline/pipeline.h"
#include "sequences/results/audit.h"
#include "sequences/results/exact_sum.h"
#include "sequences/results/frame_lines.h"
#include "sequences/results/frame_totals.h"
#include "sequences/results/reason_tally.h"

namespace talisman::sequences {

/// One layer over the whole run.
struct LayerSummary {
  std::string name;
  int parts = 0, polygons = 0;
  int renders = 0, frames_shown = 0;
  ExactSum sum_geometric_px;  ///< over the frames in which it was shown
  double max_geometric_px = 0;
  layers::ivec2 sprite_px{0, 0};   ///< largest sprite, by area
  ExactSum sum_resolution;         ///< over the frames in which it was shown
  std::optional<int> refreshes{};  ///< in which chunks alone were drawn; empty: the run draws none
  ExactSum share_refreshed{};      ///< of the stored chunks, over these
  int merged_renders = 0;          ///< renders of aggregates in which it took part; not among `renders`
  bool is_capped = false;          ///< a sprite had fewer texels than asked for, by max_sprite_px
  bool is_aggregate = false;       ///< counted with its members where rates are averaged
  bool is_shadow_map = false;      ///< not counted where rates are averaged
  bool is_mirror = false;          ///< likewise: the pictures that a layer mirrors, drawn with its sprite
  ExactSum render_ms;              ///< modelled (results/summary.cpp), of its renders
  ReasonTally reasons{};           ///< of its renders
  int frames_deferred = 0;         ///< worth drawing, but the budget did not suffice
  int frames_over_budget = 0;      ///< of these: dearer than the whole budget
  /// Chunks that are drawn alone count by their share.
  double update_rate(int frames) const { return frames > 0 ? (renders + share_refreshed) / frames : 0; }
  /// The share of frames in which it was drawn anew, alone or in an aggregate.
  double drawn_rate(int frames) const {
    return frames > 0 ? (renders + merged_renders + share_refreshed) / frames : 0;
  }
  /// Without a bound (warp::kHugePx) where one of them has none.
  double mean_geometric_px() const {
    if (max_geometric_px >= warp::kHugePx) return warp::kHugePx;
    return frames_shown > 0 ? sum_geometric_px / frames_shown : 0;
  }
  double mean_resolution() const { return frames_shown > 0 ? sum_resolution / frames_shown : 1; }
};

/// The whole run.
struct Summary {
  std::string sequence, policy, warp, compositor = "talisman";
  layers::ivec2 display_px{0, 0};
  std::optional<int> compression_quality;
  bool planned_only = false;
  std::vector<LayerSummary> layers;
  std::vector<LayerSummary> shadow_maps;  ///< behind the layers in the tables
  std::vector<LayerSummary> mirrors;      ///< behind these: "mirrored by floor"
  int frames_deferred = 0;                ///< in which something was put off for want of budget
  std::vector<layers::EffectCall> effects;
  /// One per entry of `effects`: renders of layers that use it; for shadow maps the maps drawn.
  std::vector<int> effect_passes;
  FrameTotals earlier;            ///< of frames whose lines are not held
  std::vector<FrameLine> frames;  ///< behind them, those whose lines are
  std::vector<LayerAudit> audit;  ///< with --audit: the layers that were reused

  /// Of the layers, the shadow maps and the mirrors, as tables have them.
  std::vector<const LayerSummary*> rows() const;
  /// Of a row in all of them, 0 … 1; 0 where nothing was drawn.
  double share_of_cost(const LayerSummary& row) const;
  /// Over the author's layers; a render of an aggregate counts for each of its members.
  double mean_update_rate() const;
  double cost_weighted_update_rate() const;  ///< weighted by polygons
  int frame_count() const { return static_cast<int>(earlier.frames()) + static_cast<int>(frames.size()); }
  /// Of all frames.
  FrameTotals sums() const;
  /// `number` of a frame (a member that FrameTotals::total has, or a function of such), added up.
  template <typename Number>
  auto total(const Number& number) const {
    std::decay_t<std::invoke_result_t<Number, const FrameLine&>> sum = std::invoke(number, earlier.total());
    for (const FrameLine& line : frames) sum += std::invoke(number, line);
    return sum;
  }
  std::int64_t polygons_rendered() const;
  std::int64_t pixels_rendered() const;
  double plan_ms() const;
  double planning_us_per_layer_and_frame() const;  ///< plan time over layers × frames
};

Summary start_summary(const Pipeline& pipeline, const std::string& sequence);
/// Adds one frame's decisions; aggregates are added to the layers when they are first shown.
void add_decisions(Summary& summary, const FrameReport& report, const PipelineState& state);
std::string json_of(const Summary& summary);
/// The table that the tool prints at the end.
std::string table_of(const Summary& summary);

}  // namespace talisman::sequences
