// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The result files of a run, and the numbers in them [design §9].
///
///   decisions.jsonl   talisman.decision/1   one line per frame and layer: what was done and why; the same
///   for `plan` and `render` frames.jsonl      talisman.frame/1      one line per frame: counters, stage
///   times, quality summary.json      talisman.summary/1    the whole run
///
/// Every number is computed from the run that wrote it. Names carry units; a value that does not exist is
/// null.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "layers/effects.h"
#include "sequences/pictures/quality.h"
#include "sequences/pipeline/frame_report.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// The three comparisons that tell the loss by reuse from the loss by resampling.
struct FrameQuality {
  Quality total;       ///< displayed against `direct`
  Quality reuse;       ///< displayed against `reference`: what warping old sprites loses
  Quality resampling;  ///< `reference` against `direct`: what sprites lose even when fresh
};

/// The visibility sort of one frame.
struct VisibilityLine {
  layers::VisibilityCounters counters;
  int merged_parts = 0;
  double sort_ms = 0;         ///< part of plan_ms
  ResolvedCounters resolved;  ///< zero unless the compositor is extended
};

/// One frame in numbers: what a line of frames.jsonl holds.
struct FrameLine {
  int frame = 0;
  std::string frame_hash;  ///< FNV-1a 64 of the linear picture, hexadecimal; empty when only planned
  int layers_in_view = 0, renders = 0, reuses = 0, layers_assessed = 0;
  int shadow_maps_drawn = 0, shadow_maps_reused = 0, reflections_drawn = 0;  ///< passes, as planned
  std::int64_t polygons_rendered = 0;   ///< triangles of the layers rendered, and of casters in shadow maps
  std::int64_t polygons_reference = 0;  ///< triangles of all layers in view
  std::int64_t pixels_rendered = 0;     ///< texels of the rectangles of the sprites rendered
  std::int64_t pixels_reference = 0;    ///< the same for all layers in view
  std::int64_t pixels_filled = 0;       ///< writes by the renderer
  std::int64_t pixels_composited = 0;
  std::int64_t chunks_rendered = 0, chunks_clear = 0;
  std::int64_t fragments = 0, texture_samples = 0;
  std::int64_t sprite_bytes = 0;  ///< in the store
  double plan_ms = 0, render_ms = 0, composite_ms = 0, io_ms = 0;
  double modelled_ms = 0;  ///< by the profile talisman-1996
  std::optional<CompressionReport> compression;
  std::optional<VisibilityLine> visibility;  ///< empty: the groups alone gave the order
  std::optional<FrameQuality> quality;
  std::optional<regulator::BudgetGap> budget_gap;  ///< with Settings::budget_gap
};

FrameLine line_of(const FrameReport& report);
std::string json_of(const FrameLine& line);
/// Empty if the text is not a whole line of frames.jsonl.
std::optional<FrameLine> frame_line_from_json(const std::string& text);

/// A line of decisions.jsonl.
std::string json_of(const FrameReport& report, const regulator::LayerDecision& decision);

std::string hash_of(const chunker::Frame& picture);

/// One layer over the whole run.
struct LayerSummary {
  std::string name;
  int parts = 0, polygons = 0;
  int renders = 0, frames_shown = 0;
  double sum_geometric_px = 0;  ///< over the frames in which it was shown
  double max_geometric_px = 0;
  layers::ivec2 sprite_px{0, 0};  ///< largest sprite, by area
  double sum_resolution = 0;      ///< over the frames in which it was shown
  int merged_renders = 0;         ///< renders of aggregates in which it took part; not among `renders`
  bool is_aggregate = false;      ///< counted with its members where rates are averaged
  double update_rate(int frames) const { return frames > 0 ? static_cast<double>(renders) / frames : 0; }
  /// The share of frames in which it was drawn anew, alone or in an aggregate.
  double drawn_rate(int frames) const {
    return frames > 0 ? static_cast<double>(renders + merged_renders) / frames : 0;
  }
  double mean_geometric_px() const { return frames_shown > 0 ? sum_geometric_px / frames_shown : 0; }
  double mean_resolution() const { return frames_shown > 0 ? sum_resolution / frames_shown : 1; }
};

/// How far the greedy choice was from the best one. Mean and largest gap are those of the frames in which the
/// best one was proved.
struct GapSummary {
  int frames = 0;
  int exact_frames = 0;  ///< of them, the best choice was proved
  double mean = 0, max = 0;
};

/// The whole run.
struct Summary {
  std::string sequence, policy, warp, compositor = "talisman";
  layers::ivec2 display_px{0, 0};
  std::optional<int> compression_quality;
  bool planned_only = false;
  std::vector<LayerSummary> layers;
  std::vector<layers::EffectCall> effects;
  /// One per entry of `effects`: renders of layers that use it; for shadow maps the maps drawn.
  std::vector<int> effect_passes;
  std::vector<FrameLine> frames;

  /// Over the author's layers; a render of an aggregate counts for each of its members.
  double mean_update_rate() const;
  double cost_weighted_update_rate() const;  ///< weighted by polygons
  std::int64_t total(std::int64_t FrameLine::*field) const;
  double total(double FrameLine::*field) const;
  GapSummary budget_gap() const;
  ResolvedCounters resolved() const;               ///< added up over the frames; registers: at most
  double planning_us_per_layer_and_frame() const;  ///< plan time over layers × frames
};

Summary start_summary(const Pipeline& pipeline, const std::string& sequence);
/// Adds one frame's decisions; aggregates are added to the layers when they are first shown.
void add_decisions(Summary& summary, const FrameReport& report, const PipelineState& state);
std::string json_of(const Summary& summary);
/// The table that the tool prints at the end.
std::string table_of(const Summary& summary);

}  // namespace talisman::sequences
