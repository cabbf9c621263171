// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What does it gain to let layers share sprites, or not, while a sequence runs? [D95] (regulator/regroup.h) beside the author's
/// layers, one for each part, one for all, and no sprites.
///
///   direct                      the whole scene in one pass
///   author's layers             as they are; regrouped
///   one per part                as it is; regrouped; regrouped by the figures that [D95] prints
///   one per group               all that the order allows in one sprite
///   best of all groupings       of at most kMostGrouped parts: each way to group them for the whole sequence, planned; the
///                               least. A floor for what does not change while it runs.
///
/// Costs are modelled; `planned` adds render and composite, as the decisions do. Plans are made of every frame, pictures of
/// those that sampled_frames.h chooses.

#include <cstdint>
#include <string>
#include <vector>

#include "sequences/content/sequence.h"
#include "sequences/experiments/regulator/measured.h"
#include "sequences/files/progress.h"
#include "sequences/pictures/page.h"

namespace talisman::sequences {

inline constexpr int kMostGrouped = 8;

struct AmortisedResult {
  std::string name, grouping;  ///< "one per part, regrouped"; "parts"
  int layers = 0;              ///< of the author, or as many as parts
  double sprites = 0;          ///< shown, mean over the frames
  int merges = 0, splits = 0, above_ceiling = 0;
  double planned_render_ms = 0, planned_composite_ms = 0;  ///< mean over all frames
  double planned_ms() const { return planned_render_ms + planned_composite_ms; }
  std::int64_t polygons_reference = 0;
  SettingResult measured;  ///< its means are over the frames that are drawn, its counts over all
};

struct AmortisedExperiment {
  std::string sequence;
  layers::ivec2 display_px{0, 0};
  ExperimentFrames frames;
  std::vector<AmortisedResult> results;
  std::string left_out;     ///< which of the above, and why; empty: none
  int groupings_tried = 0;  ///< for the best of all
};

/// `settings`: all but the policy and the grouping, which are varied.
AmortisedExperiment measure_amortised(const Sequence& sequence, const Settings& settings,
                                      const ExperimentFrames& frames, ProgressKind progress);

/// amortised.csv, amortised.json, and a plot; what is printed and amortised.html (published.h).
void write_report(const AmortisedExperiment& experiment, const std::string& dir);
Page page_of(const AmortisedExperiment& experiment);

/// Of what a frame renders and composites, as planned, ms on talisman-1996. Direct: all in view in one pass over the display.
struct PlannedCost {
  double render_ms = 0, composite_ms = 0;
};
PlannedCost planned_cost(const FrameReport& report, regulator::Policy policy);

}  // namespace talisman::sequences
