// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What the page says of one run, read from the files of its folder and from nothing else: of a render or a plan, whole,
/// killed or still being written. Lines are read one by one; a last line that is cut off does not count.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "sequences/results/report/packed_table.h"

namespace talisman::sequences {

/// One layer over the run, added up from its decisions.
struct LayerCounts {
  std::string name;
  int renders = 0, reuses = 0, drops = 0;
  double polygons = 0, pixels = 0;
  double sum_geometric_px = 0, max_geometric_px = 0;  ///< of what is displayed, where it is
  int frame_of_max = -1;
  std::map<std::string, int> why{};  ///< words of the reasons of its renders, how often
};

/// Decisions of one kind for reasons of one kind.
struct ReasonCounts {
  std::string decision, words, unit;
  int times = 0;
  std::optional<double> median{};  ///< of the values that were compared with a limit
};

/// A decision that is among the worst: what is displayed is farthest from its place.
struct WorstDecision {
  int frame = 0;
  std::string layer, decision, reason;
  double geometric_px = 0;
};

/// Sums over frames.jsonl.
struct FrameSums {
  int frames = 0, first = -1, last = -1;
  double polygons = 0, polygons_reference = 0, pixels = 0, pixels_reference = 0;
  double modelled_ms = 0;            ///< of a render
  double modelled_drawing_ms = 0;    ///< of it the drawing, as planned
  double modelled_reference_ms = 0;  ///< of `reference` the drawing, by the same profile
  std::optional<double> largest_flip{}, lowest_psnr_db{};  ///< displayed against `direct`; with --quality
  int frame_of_flip = -1;
};

/// A sprite's corners on the display, and whose it is.
struct SpriteOutline {
  std::string layer;
  double x[4] = {}, y[4] = {};
  double age_frames = 0;
};

/// The outlines of one frame, for the first look.
struct Still {
  int frame = -1;
  std::vector<SpriteOutline> outlines{};
};

/// A picture of a frame, small.
struct Thumbnail {
  int frame = 0, width = 0, height = 0;
  std::string png;  ///< bytes
};

struct ReportRun {
  std::string folder;
  nlohmann::ordered_json run, summary, timing_total, what_if;  ///< null where the file is not there (yet)
  bool is_complete = false;
  PackedTable decisions, frames, timing;
  bool has_changes = false;             ///< its decisions have the columns of changes.jsonl (changes.h)
  std::vector<std::string> left_out{};  ///< columns of decisions that would make the page too large
  std::vector<LayerCounts> layers{};    ///< in the order in which they appear
  std::vector<ReasonCounts> reasons{};
  std::vector<WorstDecision> worst{};  ///< at most kWorst, the worst first
  FrameSums sums{};
  Still still{};
  std::vector<Thumbnail> thumbnails{};

  static constexpr int kWorst = 20;
};

/// Throws InputError where the folder holds no run, or a line that is none of ours.
ReportRun read_report_run(const std::string& folder, bool thumbnails);

}  // namespace talisman::sequences
