// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Who walks past what: the workload of `talisman accuracy --memory SEQUENCE`.
///
/// The things are the sequence's parts, the model *flattened* as in [Fu93 5.2.5]: each has a description of its own, also
/// where the scene shares one mesh. Their levels have a quarter of the polygons of the one above, down to
/// kCoarsestPolygons or fewer, which stands in for the ladders of the paper (16.6, 65, 191, 768 and 1,178 polygons on average): by number
/// alone, nothing is simplified. A level takes up kBytesPerPolygon for each, which is the paper's building: 349.5 MB for the
/// 2,217,792 polygons of all its levels. What moves has one box around all of its motion.

#include <cstdint>
#include <memory>
#include <vector>

#include "layers/cells.h"
#include "regulator/memory/lookahead.h"
#include "sequences/content/sequence.h"
#include "sequences/experiments/sampled_frames.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

inline constexpr double kBytesPerPolygon = 349.5e6 / 2'217'792;
inline constexpr std::int64_t kCoarsestPolygons = 20, kLevelRatio = 4;

/// From the coarsest to `polygons`.
std::vector<std::int64_t> ladder_of(std::int64_t polygons);

struct MemoryWalk {
  std::vector<regulator::StoredThing> things;
  std::vector<std::vector<std::int64_t>> level_bytes;  ///< of each thing's own item
  std::vector<layers::CameraState> cameras;            ///< by frame
  std::vector<std::vector<int>> seen;  ///< by frame: the things that the run's visibility leaves
  std::shared_ptr<const layers::CellSet> cells;
  layers::ivec2 display_px{0, 0};
  double fps = 24;
  double speed_m_per_s = 0, turn_deg_per_s = 0;  ///< the most that the camera does from one frame to the next
  std::int64_t polygons = 0, bytes = 0;          ///< of all levels
};

/// `settings`: with its cells and its visibility; without any: what is in the frustum is seen.
MemoryWalk walk_of(const Sequence& sequence, const Settings& settings, const ExperimentFrames& frames);

}  // namespace talisman::sequences
