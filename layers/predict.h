// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where will everything be in k frames, if all that is known is where it was and where it is?
///
///   world matrix   M = (t, R, K): origin t, rotation R, and K = Rᵀ M the scale and shear that is left
///   origin         t(k) = t₁ + k (t₁ - t₀)
///   rotation       R(k) = Δᵏ R₁,  Δ = R₁ R₀ᵀ the shorter way round: constant angular velocity
///   scale, shear   K(k) = K₁ + k (K₁ - K₀), as long as no axis is turned inside out; else K₁
///   lights         positions linearly, directions with constant angular velocity, colours linearly and ≥ 0
///   camera         its matrix as any other; the field of view linearly while it is an angle in (0, π)
///
/// R is found by orthonormalising the columns of M (Gram & Schmidt), so K is upper triangular. What did not
/// move between the two frames does not move ahead either, to the bit. A matrix that is flat, mirrored the
/// other way or not finite stays as it is now.
///
/// Motion extrapolated for rendering ahead: [F96]; the paper knows its motion.

#include "layers/scene.h"

namespace talisman::layers {

/// The scene `frames_ahead` ≥ 0 frame times after `now`, where `before` was one frame earlier. Both are of
/// the same scene. Pure and finite for finite input; 0 frames ahead is `now`, to the bit. Cost: O(nodes) ·
/// some 100 ns for those that move.
SceneFrame predict_linear(const SceneFrame& before, const SceneFrame& now, double frames_ahead);

/// The same for one matrix whose last row is (0, 0, 0, 1).
dmat4 predict_linear(const dmat4& before, const dmat4& now, double frames_ahead);

}  // namespace talisman::layers
