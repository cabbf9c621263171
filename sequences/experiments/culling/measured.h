// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which structure finds what is in view in the least time? `talisman accuracy --culling SEQUENCE`.
///
/// The sequence's camera flies as it does. Its parts, as boxes, are the first workload: as many as there are, moving
/// as they do. The others are copies of them side by side, 1,000 … 100,000 boxes, of which a share moves in each
/// frame, to and fro by their own size. Every structure (layers/box_index.h) does the same:
///
///   build    once, from the boxes of the first frame
///   update   in each frame, told which boxes moved
///   query    in each frame, with the display's region
///
/// What they find is the same but for rounding, which is checked: a structure that misses a box that the flat scan
/// finds is counted (`missed`). Times are medians over the frames, on one thread.

#include <cstdint>
#include <string>
#include <vector>

#include "sequences/content/sequence.h"
#include "sequences/experiments/sampled_frames.h"
#include "sequences/files/progress.h"
#include "sequences/pictures/page.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

struct CullingResult {
  std::string workload;  ///< "own parts", "copies"
  int parts = 0;
  double moving_share = 0;  ///< of the parts, in a frame
  std::string structure;    ///< "tree", "tree, no cache", "octree", "loose octree", "flat scan"
  double build_us = 0, update_us = 0, query_us = 0;
  double found = 0, nodes = 0, tests = 0;  ///< of a query, mean; a test is one plane against four boxes
  double spared = 0;                       ///< tests that masks spared, mean
  std::int64_t missed = 0;                 ///< boxes that it should have found, over all frames
  double frame_us() const { return update_us + query_us; }
};

struct CullingExperiment {
  std::string sequence;
  layers::ivec2 display_px{0, 0};
  int frames = 0;  ///< of each workload
  std::vector<CullingResult> results;
};

CullingExperiment measure_culling(const Sequence& sequence, const Settings& settings,
                                  const ExperimentFrames& frames, ProgressKind progress);

/// The structure with the least time per frame, of each workload, by the place of its first result.
std::vector<const CullingResult*> fastest(const CullingExperiment& experiment);

/// culling.csv, culling.json, and plots of time over parts and over the share that moves; what is printed and culling.html (published.h).
void write_report(const CullingExperiment& experiment, const std::string& dir);
Page page_of(const CullingExperiment& experiment);

}  // namespace talisman::sequences
