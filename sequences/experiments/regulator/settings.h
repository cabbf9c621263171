// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which settings of the regulator are compared? One knob per policy, turned from fine to coarse:
///
///   reference                                   every layer, every frame: the truth, and the full price
///   hold, interpolate      N = 2, 3, 5, 8       frames
///   threshold, lookahead 16, oracle             0.25 … 8 px in octaves, the same for all three
///   threshold chunks                            the same thresholds; only the chunks over the bound are drawn again
///   threshold in 2, 4, 8   1, 4 px              their rival: the same layers, cut into so many (cut_layers.h)
///   interpolate staggered  N = 2, 3, 5, 8       frames; each layer on a beat of its own
///   threshold blended      K = 1, 2, 4          frames over which a fresh sprite fades in, at the sequence's own
///                                               threshold (sequences/pipeline/cross_fading.h)
///   threshold settled      N = 1, 4, 16         frames at rest after which what is enlarged is drawn again, at the
///                                               sequence's own threshold (regulator/settle.h)
///   budget, budget best    5 … 80 %             of the polygons that `reference` draws per frame, chosen as in the
///                                               paper or by the safe choice (regulator/budget.h)
///
/// All else (fiducials besides the geometric one, warp, extents) is as the sequence says.

#include <string>
#include <vector>

#include "regulator/plan.h"

namespace talisman::sequences {

struct RegulatorSetting {
  std::string series;  ///< what belongs together in a plot: "threshold", "lookahead 16"
  std::string unit;    ///< of `value`: "px", "frames", "%"; empty: there is no knob
  double value = 0;    ///< the knob
  regulator::RegulatorOptions options;
  int cut = 1;                ///< layers of one part are cut into so many
  std::string knob() const;   ///< "4 px", "N 3", "10 %", or empty
  std::string words() const;  ///< "threshold 4 px"
};

inline constexpr int kComparedLookahead = 16;

/// Pixels, ascending.
std::vector<double> compared_thresholds();
/// Per cent of the reference's polygons, ascending.
std::vector<double> compared_budgets();

/// All settings, `reference` first. `polygons_per_frame` > 0: mean over the frames of all layers in view.
std::vector<RegulatorSetting> regulator_settings(const regulator::RegulatorOptions& base,
                                                 double polygons_per_frame);

}  // namespace talisman::sequences
