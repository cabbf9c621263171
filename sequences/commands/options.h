// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The command line of `render` and `plan`, as it was typed, and how it overrides a sequence's own settings.
/// The order of options never matters.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sequences/content/sequence.h"
#include "sequences/results/run.h"

namespace talisman::sequences {

/// The options about content (ContentOptions), as they were typed.
struct ContentWords {
  std::string assets;  ///< a folder
  std::optional<double> exposure, turntable;
  std::string seam;  ///< "none", "auto"
  bool no_stage = false;
  bool strict = false;  ///< warnings of the content are errors
};

/// Every option is empty where it was not given.
struct CommandLine {
  std::string sequence;
  std::string out;     ///< empty: out/<name>, for plans out/<name>-plan
  std::string frames;  ///< "A-B", "A" or empty: all; inclusive
  std::string size;    ///< "WxH"
  std::string policy, predict, choice, warp, bound, cycles, compositor, shading,
      format = "png", decisions = "all", progress = "auto";
  std::optional<double> geometric_px, cutoff_px, budget_ms, min_resolution, expected_reuse, resolution;
  std::optional<double> photometric, light_angle_deg, turned_px, shadow_map_px, depth_complexity;
  std::string color_warp, stagger, late_chunks;  ///< "on", "off"
  std::string visibility;                        ///< "cto,eye,eye"
  std::string joining, motion_norm, intervals, adaptive;
  std::string latency_ms;  ///< "RENDER" or "RENDER,WARP"
  std::string regroup, regroup_prices, refresh;
  std::optional<double> regroup_ceiling_ms;
  std::optional<int> regroup_dwell;
  std::string lod, lod_benefit, first_appearance;
  std::optional<double> px_per_polygon, feedback_gain;
  std::optional<int> tree_k, samples, accumulate;
  std::optional<int> hold, blend, lookahead, material_points;
  std::optional<int> compression;  ///< quality; 0: none, whatever the sequence says
  std::optional<std::int64_t> budget_polygons, budget_pixels, budget_chunks;
  bool budget_gap = false;
  int threads = 0;  ///< 0: all cores
  bool video = false, separate = false, overlay = false, quality = false, resume = false;
  std::optional<int> audit;  ///< every so many reuses; `talisman audit` writes no pictures of frames
  bool audit_alone = false;
  bool quiet = false;  ///< no progress, no table
  bool no_report = false, no_thumbnails = false;
  bool force = false;             ///< take a folder that holds other files
  std::string shard, shard_plan;  ///< "i/N", and the folder of a plan by whose costs frames are shared out
  ContentWords content;
};

struct ResolvedRun {
  Settings settings;
  RunOptions options;
};

/// Throws InputError unless it is a number of threads: 0 (all cores) to 1024.
void require_threads(int threads);

/// Throws InputError that names option, value and rule.
ContentOptions content_options(const ContentWords& words);

/// Throws InputError with the number of warnings where --strict allows none.
void require_none(const std::vector<std::string>& warnings, bool strict, const std::string& file);

/// On stderr, "warning: " or "note: " before each.
void say_content(const std::vector<std::string>& warnings, const std::vector<std::string>& notes);

/// The same with those options of a run on which its content depends.
ContentOptions content_options(const CommandLine& line);

/// Reads the sequence and says its warnings on stderr, "warning: " before each. Throws InputError.
Sequence load_with_warnings(const std::string& name_or_path, const ContentWords& words = {});
Sequence load_with_warnings(const CommandLine& line);

/// Checks every value and joins it with the sequence's defaults. Throws InputError that names option, value
/// and rule, or the effect that the run calls for and this build lacks.
ResolvedRun resolve(const CommandLine& line, const Sequence& sequence, bool plan_only);

}  // namespace talisman::sequences
