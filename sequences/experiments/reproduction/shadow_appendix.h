// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Is a shadow sprite of black, laid over its receiver, the shadowed receiver? [LS97 appendix]
///
///   receiver [βB, β],  shadow [0, (1 - s) β],  s: 0 in shadow … 1 in the light
///   wanted             C' = [sβB, β]
///   over gives         [sβB + (1 - s)(1 - β) βB, β + (1 - s)(1 - β) β]
///
/// Right where s = 1 or β = 1; wrong where shadow and partial coverage meet: over what lies behind, T, by
/// β (1 - β)(1 - s)(B - T), at most a quarter of B - T. Measured by the compositor itself on sprites of four bytes, one
/// texel for each of 65 × 65 pairs of s and β, against the frame that is wanted, worked out in double precision.

#include <vector>

#include "sequences/experiments/reproduction/paper.h"

namespace talisman::sequences {

struct ShadowTexel {
  double s = 0, beta = 0;
  double error = 0;    ///< of the frame composited, against the wanted one, linear light
  double formula = 0;  ///< β (1 - β)(1 - s)(B - T)
};

/// `receiver` B and `behind` T: one channel, linear light, 0 … 1.
std::vector<ShadowTexel> shadow_texels(double receiver, double behind);

/// What 8 bits a channel can leave of nothing: half a step of the receiver's colour, of its alpha and of the shadow's.
inline constexpr double kShadowRounding = 0.008;

Finding right_where_whole_or_lit(const std::vector<ShadowTexel>& texels);  ///< s = 1 or β = 1: rounding alone
Finding wrong_as_the_formula_says(const std::vector<ShadowTexel>& texels);  ///< elsewhere, to rounding
/// The largest error is a quarter of B - T, in full shadow and half coverage.
Finding worst_in_half_coverage(const std::vector<ShadowTexel>& texels, double receiver, double behind);

Item shadow_appendix();

}  // namespace talisman::sequences
