// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What moves when in a whole sequence, and what would a plan of shared buffers draw? Words of all slices, groups that
/// move as one (layers/rigid_groups.h), and counts. Nothing is drawn.
///
///   rest    share of parts and frames without a change, the first frame of each slice apart: it is one by definition
///   runs    drawings with a buffer for each part, draws: with the buffers of the plan tree (regulator/plan_tree.h)

#include <cstdint>
#include <vector>

#include "regulator/plan_tree.h"
#include "sequences/pipeline/predictive/part_motion.h"

namespace talisman::sequences {

struct MotionStudyOptions {
  MotionOptions motion;
  regulator::PlanShape plan;
  layers::ivec2 display_px{1024, 1024};
  int frames = 1;  ///< of the sequence, ≥ 1
  double fps = 24;
};

/// Of a part, a group or all: over the frames of the sequence.
struct MotionCounts {
  std::int64_t shown = 0;    ///< parts × frames
  std::int64_t changes = 0;  ///< without the first frames of slices
  std::int64_t could = 0;    ///< parts × frames without those: what `changes` is of
  std::int64_t runs = 0, draws = 0;
  std::int64_t polygons = 0;         ///< triangles × draws
  std::int64_t polygons_direct = 0;  ///< triangles × frames
  MotionCounts& operator+=(const MotionCounts& o);
  double rest() const {
    return could > 0 ? 1 - static_cast<double>(changes) / static_cast<double>(could) : 1;
  }
};

struct MotionStudy {
  MotionStudyOptions options;
  FollowedParts followed;
  std::vector<MotionSlice> slices;
  std::vector<std::vector<int>> groups;  ///< indices of followed.parts
  std::vector<MotionCounts> by_part;     ///< by index of followed.parts
  MotionCounts all;
  std::int64_t vertices = 0;  ///< of prediction primitives that were projected
};

MotionStudy study_motion(const layers::Scene& scene, const layers::LayerSet& set,
                         const MotionStudyOptions& options);

/// What one word of the slice that begins at `first` adds, in a sequence that ends before frame `frames`.
MotionCounts counts_of(const regulator::MotionWord& word, int first, int frames,
                       const regulator::PlanShape& plan, std::int64_t triangles);

}  // namespace talisman::sequences
