// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How many pixels of a frame let through, at the cuts between layers, what lies behind them?
///
/// Of the layers that share edges (layers/seam.h), and of them alone, two pictures are made: as the frame shows their
/// sprites, and drawn in one pass, as `direct` does. A pixel is open where
///
///   alpha of the sprites < alpha of the one pass - 8/255
///
/// so it does not matter what shows through, the background or another layer. Looked at are places within the sum of both
/// layers' reaches of a cut, whose surroundings as far are covered whole in the one pass: at an outline the two differ
/// because the warp has moved it, and that is no crack. Nor is what lies at the border of the display: there sprites end
/// that were cut off by it, and a fiducial of its own, `uncovered_px`, says how far such a side may be in view. Best 0.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "layers/seam.h"
#include "sequences/pipeline/frame_report.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// Alpha of a picture, 0 … chunker::kOne, row by row.
struct AlphaPlane {
  int width = 0, height = 0;
  std::vector<std::uint16_t> alpha;
};

/// A cut on the display, and how far from it a crack may lie.
struct CutLine {
  layers::dvec2 a_px{0}, b_px{0};
  double within_px = 1;
};

/// Pixels by the rule above, `border_px` away from the border or more. Cost: O(pixels near cuts · within²).
std::int64_t open_pixels(const AlphaPlane& shown, const AlphaPlane& whole, std::span<const CutLine> cuts,
                         int border_px = 0);

/// How wide the border is for a threshold of uncovered edges: the strip and the pixel over which the filter smooths its
/// end, px; 0 where nothing may be uncovered (0), or nobody looks (negative).
int border_width_px(double uncovered_px);

/// The edges of a run, found once. Empty where no layers share any: then nothing is counted.
class SeamCounter {
 public:
  explicit SeamCounter(const Pipeline& pipeline);

  /// Of a frame that was just drawn with `state`; empty where there are no cuts, or no sprites (policy direct).
  std::optional<std::int64_t> open_in(const PipelineState& state, const FrameReport& report,
                                      const chunker::PreparedScene& prepared) const;

 private:
  std::vector<CutLine> cuts_at(const layers::SceneFrame& frame) const;

  const Pipeline& pipeline_;
  std::vector<layers::SharedEdge> edges_;
  std::vector<layers::dmat4> world_at_0_;
  std::vector<int> layers_;  ///< that share an edge, ascending
};

}  // namespace talisman::sequences
