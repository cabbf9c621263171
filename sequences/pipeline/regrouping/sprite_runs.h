// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How long do sprites last, of layers, of neighbours, of sets? What is counted is in sequences/pipeline/regrouping/regroup.h.

#include <vector>

#include "sequences/pipeline/frame_report.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// A sprite of the frame whose layers take part: one layer, or a set that shares it.
struct LineSprite {
  int id = -1;                ///< that of the layer, or of the aggregate
  std::vector<int> members;   ///< far to near
  bool ends_stretch = false;  ///< the next one in the line is no neighbour
};

/// The sprites of the line (RegroupMemory::line), far to near.
std::vector<LineSprite> line_sprites(const PipelineState& state, const FrameReport& report);

/// Counts this frame for every layer, pair and set in the line, and forgets what has long been gone.
void count_runs(const Pipeline& pipeline, PipelineState& state, const FrameReport& report,
                const std::vector<LineSprite>& sprites);

/// Frames that one sprite of these layers would last, neighbours, far to near.
double expected_run(const RegroupMemory& memory, std::span<const int> layers);

}  // namespace talisman::sequences
