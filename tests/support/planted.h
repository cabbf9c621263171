// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Point pairs whose best maximum-norm fit is known, because it was put there.
///
/// Take any map W and points p̂. Let all residuals of the support point along one direction e, rᵢ = sᵢ R e
/// with signs sᵢ, and let every other residual be shorter. W is optimal, with maximum R, if multipliers mᵢ of
/// the signs sᵢ exist with
///
///   affine          Σ mᵢ (1, x̂, ŷ) = 0                                        4 points have one such m
///   perspective     Σ mᵢ (1, x̂, ŷ) = 0 and Σ mᵢ (e·Wᵢ) (1, x̂, ŷ) = 0          6 points (one equation is
///   redundant)
///
/// because u = m e is then a certificate (min_max.h, max_norm_perspective.cpp). So m is computed as the null
/// vector, and its signs are planted.

#include <cstdint>

#include "tests/support/correspondences.h"

namespace talisman::tests {

struct Planted {
  Pairs pairs;
  double optimum_px = 0;
};

Planted planted_affine(std::uint64_t seed, int points);
Planted planted_perspective(std::uint64_t seed, int points);

}  // namespace talisman::tests
