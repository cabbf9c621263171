// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What lies behind all else? A land below a farm, a floor, a sky: bodies around which or on which many others stand, so
/// that bounds know no order between them, and which nevertheless are in front of nothing.
///
/// A body is one piece, or the pieces of one surface, which share edges (layers/seam.h). It lies behind where it was seen in
/// front of nothing at all, or
///
///   its box touches those of at least kMostlyAround of the other bodies, and of kFewestAround, and
///   of the coarse pixels at which it and others were seen it was in front at no more than kHidden.
///
/// What lies behind others that do so is no obstacle: the land is in front of the sky. What is put into the background
/// is drawn behind what it hides: seen_order.h says what that is worth.

#include <vector>

#include "layers/scene.h"
#include "sequences/content/factoring/depth_samples.h"
#include "sequences/content/factoring/pieces.h"

namespace talisman::sequences {

inline constexpr double kMostlyAround = 0.1;
inline constexpr int kFewestAround = 3;

/// By piece; those that are kept never. Cost: O(triangles + pieces²).
std::vector<bool> pieces_behind(const layers::Scene& scene, const Pieces& pieces, const DepthSamples& depths);

/// The groups cut into those behind and those that are not.
std::vector<std::vector<int>> cut_by(const std::vector<bool>& behind,
                                     const std::vector<std::vector<int>>& groups);

}  // namespace talisman::sequences
