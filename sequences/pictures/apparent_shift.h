// SPDX-License-Identifier: Apache-2.0
#pragma once

/// By how much is one picture of a layer displaced against another, and what does no displacement explain?
///
/// At every pixel the displacement d is sought for which the shown picture at x + d looks like the fresh one at
/// x: Lucas & Kanade 1981, coarse to fine [Bouguet 2001], over a window of kWindow_px (σ of a Gaussian), by
/// the gradients of all four channels (square roots of premultiplied linear colour; alpha, for the
/// silhouette):
///
///   d ← d - (Σ ∇F ∇Fᵀ + ε I)⁻¹ Σ ∇F (S(x + d) - F(x))
///
/// ε is a share of the window's structure. Along an edge nothing is known of the displacement, and a light that
/// changes looks like one: so of d, of three quarters, half and a quarter of it and of none the shortest is taken
/// that leaves a mean square of at most 1.1 times d's and 1 / 255² more; or, where it is known that light changes,
/// that leaves no more of the colours than that change, and as little of the silhouette.
/// Only pixels with structure count (mean squared gradient of the window at least kStructure²). Where a
/// picture repeats itself within a few pixels a displacement may be taken for a smaller one.

#include "chunker/composite.h"
#include "sequences/pictures/image_drawing.h"

namespace talisman::sequences {

inline constexpr double kWindow_px = 3;
inline constexpr double kStructure = 0.02;  ///< per pixel; 1 is the step from black to white

struct ApparentShift {
  double p95_px = 0;   ///< length of d, 95th percentile over the pixels with structure
  double mean_px = 0;  ///< over the same
  double rms = 0;      ///< of the colours (linear light, norm over the channels, 1 is white) that a
      ///< displacement of at most the given length leaves over: d, or one about a pixel beside
      ///< it; both pictures blurred by a pixel, since resampling blurs
  double missing = 0;      ///< share of the fresh picture's pixels at which nothing is shown
  long structured_px = 0;  ///< pixels with structure
  Crop seen;               ///< where one of the pictures is not clear; empty: both are
};

/// What is known of beforehand.
struct ExplainedChange {
  double shift_px = 0;  ///< ≥ 0; no part of `rms`
  double light = 0;  ///< ≥ 0, of a colour (as `rms`); what differs by no more is not taken for a displacement
};

/// `shown` and `fresh` are premultiplied, with alpha, of equal size. Deterministic. Cost: about 2 µs per pixel that
/// is seen.
ApparentShift apparent_shift(const chunker::Frame& shown, const chunker::Frame& fresh,
                             const ExplainedChange& explained);

}  // namespace talisman::sequences
