// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which warp needs fewer renders? [LS97 4.2, Fig. 15 and 16]
///
/// The experiment is that of `talisman warps` (experiments/warps): update rate against error threshold of a teapot that
/// turns and moves, flattened to 5 % (15) and as it is (16). Without its content a flat and a whole box stand in. What is
/// compared is order and clusters of the paper's curves (ranking.h), for which each of its sentences is a row.

#include "sequences/experiments/reproduction/paper.h"
#include "sequences/experiments/warps/ranking.h"

namespace talisman::sequences {

/// per renders more than aff, and peri than affi, by no more than a fifth, where the error is high: over the thresholds
/// of 8 px and more at which the affine one renders more than once and not in every frame.
Finding homogeneous_is_worse_at_high_error(const std::vector<UpdateCurve>& curves,
                                           const std::vector<double>& thresholds_px);

/// A statement as a finding: the order alone, nearer than the tolerance, is the paper's shape too.
Finding finding_of(const Statement& statement);

Item figure_15();
Item figure_16();

/// The second series, which is judged by eye in the paper: at one update rate, are pictures with affine warps better than
/// with less general ones, and no worse than with perspective ones?
Item warp_pictures();

}  // namespace talisman::sequences
