// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The lines that a run writes while it goes on, and the numbers in them.
///
///   decisions.jsonl   talisman.decision/1   one line per frame and layer: what was done and why; the same for
///                                           `plan` and `render`
///   frames.jsonl      talisman.frame/1      one line per frame: counters, quality
///   timing.jsonl      talisman.timing/1     one line per frame: what it took (results/timing.h)
///
/// Every number is computed from the run that wrote it. Names carry units; a value that does not exist is null.
/// What was measured with a clock is in timing.jsonl alone: the other two have the same bytes on every run,
/// whatever the number of threads, whole, in parts or resumed.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sequences/pictures/quality.h"
#include "sequences/pipeline/frame_error.h"
#include "sequences/pipeline/frame_report.h"

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
  ResolvedCounters resolved;  ///< zero unless the compositor is extended
};

/// Passes behind shadows and reflections, as planned.
struct PassCounts {
  int shadow_maps_drawn = 0, shadow_maps_reused = 0, reflections_drawn = 0;
};

struct PolygonCounts {
  std::int64_t rendered = 0;   ///< triangles of the layers rendered, and of casters in shadow maps
  std::int64_t reference = 0;  ///< what `reference` would render: all layers in view, maps that changed
};

struct PixelCounts {
  std::int64_t rendered = 0;   ///< texels of the rectangles of sprites, of mirrored pictures, of shadow maps
  std::int64_t reference = 0;  ///< what `reference` would render
  std::int64_t filled = 0;     ///< writes by the renderer, and texels of shadow maps
  std::int64_t composited = 0;
  std::int64_t registers = 0;  ///< that operators of compositing expressions write, each a pixel of an image
};

struct ChunkCounts {
  std::int64_t rendered = 0, clear = 0;
};

/// Wall time of one frame, milliseconds. All there is of it: no decision depends on a clock.
struct FrameTimes {
  double plan_ms = 0, render_ms = 0, composite_ms = 0, io_ms = 0;
  double sort_ms = 0;      ///< the visibility sort; part of plan_ms
  double compress_ms = 0;  ///< to compress, decompress and compare sprites; part of render_ms
  std::int64_t late_pixels =
      0;  ///< filled in late chunks of older sprites: depends on which frames were drawn
};

/// One frame in numbers: what lines of frames.jsonl and timing.jsonl hold.
struct FrameLine {
  int frame = 0;
  std::string frame_hash;    ///< XXH3-128 of the linear picture, hexadecimal; empty when only planned
  std::string picture_hash;  ///< of the files that show it (kept_pictures.h); empty: none do
  int layers_in_view = 0, renders = 0, reuses = 0, layers_assessed = 0;
  FrameError error;
  PassCounts passes;
  PolygonCounts polygons;
  PixelCounts pixels;
  ChunkCounts chunks;
  std::int64_t fragments = 0, texture_samples = 0;
  std::int64_t sprite_bytes = 0;  ///< of the sprites that the frame shows
  double modelled_ms = 0;         ///< by the profile talisman-1996
  double modelled_drawing_ms =
      0;  ///< the part of rendering, as planned: texels filled depth_complexity times
  std::optional<double> light_beside_px;     ///< the largest of all Light layers; empty: there is none
  std::optional<std::int64_t> upload_bytes;  ///< of frames of moving pictures; empty: the scene has none
  double depth_complexity = 1;               ///< by which a budget of ms was divided
  std::optional<CompressionReport> compression;
  std::optional<VisibilityLine> visibility;  ///< empty: the groups alone gave the order
  std::optional<FrameQuality> quality;
  std::optional<std::int64_t> open_seam_pixels;    ///< with quality, where layers share edges
  std::optional<regulator::BudgetGap> budget_gap;  ///< with Settings::budget_gap
  std::optional<regulator::LodPlan> lod;           ///< with --lod optimise
  std::optional<PredictiveReport> predictive;      ///< of that policy, without what drawing adds
  std::optional<LookaheadReport> lookahead;        ///< of the policies that look ahead
  std::optional<RefreshReport> refresh;            ///< with --refresh chunks
  std::optional<LatencyReport> latency;            ///< of a run that knows old poses only
  FrameTimes times;                                ///< not in frames.jsonl

  bool is_drawn() const { return !frame_hash.empty(); }
};

FrameLine line_of(const FrameReport& report);
std::string json_of(const FrameLine& line);
/// Empty if the text is not a whole line of frames.jsonl. Times are zero.
std::optional<FrameLine> frame_line_from_json(const std::string& text);

struct DecisionRow;  // results/column_tables.h

/// A line of decisions.jsonl.
std::string json_of(const DecisionRow& row);
std::string json_of(const FrameReport& report, const regulator::LayerDecision& of_layer);

/// Of its pixels, row by row, four numbers of 16 bits each, the low byte first.
std::string hash_of(const chunker::Frame& picture);

}  // namespace talisman::sequences
