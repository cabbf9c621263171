// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What does each way of finding what can be seen leave, and cost? `talisman accuracy --visibility SEQUENCE`, as [Fu93
/// Tables 4.1-4.2].
///
/// Every triple (sequences/pipeline/culling/visibility.h) decides every frame of the walk; one frame in so many is drawn
/// with policy `direct`. Pictures must be those of `none,none,none`, byte for byte: `differing` counts the frames that
/// are not. `first_ms` is the first decision, with all that is worked out once; `decide_ms` the median of the others. Times are of
/// one thread.

#include <cstdint>
#include <string>
#include <vector>

#include "sequences/content/sequence.h"
#include "sequences/experiments/sampled_frames.h"
#include "sequences/files/progress.h"
#include "sequences/pictures/page.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// All that can be asked of a sequence with cells (21), or without (2).
std::vector<VisibilityOptions> visibility_triples(bool with_cells);

struct VisibilityResult {
  VisibilityOptions options;
  double polygons = 0, polygons_most = 0;  ///< left in a frame: mean, most
  double parts = 0, cells = 0;             ///< likewise, mean
  double first_ms = 0, decide_ms = 0, decide_most_ms = 0;
  double render_ms = 0;  ///< of the frames that are drawn, mean
  int in_walls = 0;      ///< frames in which the eye was in a wall, and cells hid nothing
  int drawn = 0, differing = 0;
};

struct VisibilityExperiment {
  std::string sequence;
  layers::ivec2 display_px{0, 0};
  ExperimentFrames frames;
  std::int64_t polygons = 0;  ///< of all parts
  int parts = 0, cells = 0, portals = 0;
  std::vector<VisibilityResult> results;
};

VisibilityExperiment measure_visibility(const Sequence& sequence, const Settings& settings,
                                        const ExperimentFrames& frames, ProgressKind progress);

/// visibility.csv, visibility.json, and a plot of decision time against what is left; what is printed and visibility.html
/// (published.h).
void write_report(const VisibilityExperiment& experiment, const std::string& dir);
Page page_of(const VisibilityExperiment& experiment);

}  // namespace talisman::sequences
