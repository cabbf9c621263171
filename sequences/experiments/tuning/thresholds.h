// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Thresholds that are tried, and what a plan says of them: no pixel is drawn.
///
///   threshold of layer l = geometric_px / importance.geometric of l     px
///
///   grid: 0, and 64 · 2^(-k/6) px for k = 62 … 0, rounded to three digits: 64 settings

#include <cstdint>
#include <string>
#include <vector>

#include "sequences/content/sequence.h"
#include "sequences/experiments/variant.h"
#include "sequences/results/planned.h"

namespace talisman::sequences {

struct TriedThresholds {
  double geometric_px = 0;
  std::vector<double>
      weights;  ///< importance.geometric by entry of Sequence::layer_specs; empty: as the sequence says
  bool operator==(const TriedThresholds&) const = default;
};

inline constexpr int kTunedGrid = 64;
/// Ascending.
std::vector<double> tuned_grid();
/// With three significant digits, as it is printed: what is pasted is what was tried.
double as_printed(double value);

/// The sequence and its settings with these thresholds, factored again where weights differ from its own,
/// with the seams that they need.
Variant with_thresholds(const Sequence& sequence, const Settings& settings,
                        const TriedThresholds& thresholds);

struct PlannedThresholds {
  TriedThresholds thresholds;
  double cost_ms = 0;             ///< modelled drawing time of all frames
  std::vector<double> frame_ms;   ///< of each frame of the range
  std::vector<double> suspicion;  ///< of each: displayed error times the area of its sprites, px³
  std::vector<double>
      layer_ms;  ///< modelled drawing time by entry of layer_specs, alone and without shade layers
  std::uint64_t decisions = 0;  ///< a hash of what is drawn when: equal ones draw the same pictures
};
PlannedThresholds plan_of(const Sequence& sequence, const Settings& settings, const FrameRange& range,
                          const TriedThresholds& thresholds);

}  // namespace talisman::sequences
