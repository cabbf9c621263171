// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Pairs for the key `order`, from what was seen of the depths (depth_samples.h).
///
/// Of two layers that the bounds cannot order one is put in front of the other where, at every coarse pixel at which both
/// were seen, it was the nearer one; but for kHidden of these pixels, in kHiddenFrames of the frames, which are reported:
/// what hides a ship for a moment is drawn behind it. Layers that were never seen at one pixel are ordered by their
/// nearest depths. A pair that would close a circle is left out.

#include <span>
#include <vector>

#include "sequences/content/factoring/depth_samples.h"
#include "sequences/content/factoring/planned_factoring.h"

namespace talisman::sequences {

/// Share of the common pixels, and of the frames in which they meet, at which the layer in front may have been behind.
inline constexpr double kHidden = 0.01, kHiddenFrames = 0.125;

/// Coarse pixels, over all frames, at which a piece of the one was in front of one of the other.
double pixels_in_front(const DepthSamples& depths, const std::vector<int>& front,
                       const std::vector<int>& behind);

/// Of the pixels at which both were seen the share at which the one that mostly is in front was behind; 0 … 0.5.
double hidden_share(const DepthSamples& depths, const std::vector<int>& a, const std::vector<int>& b);

struct SeenPair {
  SpecPair pair;      ///< behind, front
  double hidden = 0;  ///< share of the common pixels at which `front` was behind
};

/// `layers`: by index of the specs, the pieces of each; `group_of`: their places in the author's order of groups; `asked`: of which pairs.
std::vector<SeenPair> seen_order(const DepthSamples& depths, std::span<const std::vector<int>> layers,
                                 std::span<const layers::OrderGroup> groups, std::span<const SpecPair> asked);

}  // namespace talisman::sequences
