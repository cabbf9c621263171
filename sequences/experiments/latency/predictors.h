// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where will the camera be, if all that is known is where it was until a while ago?
///
///   held     where it was last
///   linear   on with the velocity and the angular velocity between the last two poses (layers/predict.h)
///   kalman   constant acceleration in place and in rotation vector: per axis a filter of (x, v, a), whose acceleration is
///            a random walk, over the last kFilterPoses poses
///   known    where it is: the bound of what prediction can reach
///
/// Kalman, per axis, with the step h between poses and the horizon H:
///   x' = F x, P' = F P Fᵀ + Q          F = [1 h h²/2; 0 1 h; 0 0 1],  Q = q ∫ g gᵀ, g = (s²/2, s, 1) over 0 … h
///   k  = P' e / (P'₀₀ + r),  x = x' + k (z − x'₀),  P = (1 − k eᵀ) P'
///   x(H) = x₀ + H x₁ + H²/2 x₂
/// A rotation R of the past is z = log(R Rₙ⁻¹), Rₙ the last one known: small, so that its components are coordinates; the
/// predicted rotation is exp(z(H)) Rₙ. Noise: of a tracker, 0.2 mm and 0.02°; q of heads, 50 m/s³ and 300 rad/s³ a second.
/// They are of people: a camera that flies at 100 m/s is served as well, since its measurements hardly weigh less.
///
/// Poses are those of a tracker, every kTrackerStep_s.

#include <array>
#include <span>
#include <string_view>

#include "layers/scene.h"

namespace talisman::sequences {

enum class PosePredictor { Held, Linear, Kalman, Known };
inline constexpr std::array kAllPredictors = {PosePredictor::Held, PosePredictor::Linear,
                                              PosePredictor::Kalman, PosePredictor::Known};
std::string_view name(PosePredictor predictor);

inline constexpr double kTrackerStep_s = 0.004;
inline constexpr int kFilterPoses = 32;

/// `horizon_s` ≥ 0 after the last of `poses`, which are `step_s` apart, the oldest first; rigid, at least one. Of one pose
/// it is that one. Not of `known`, which needs the future. Pure.
layers::dmat4 predicted_pose(std::span<const layers::dmat4> poses, double step_s, double horizon_s,
                             PosePredictor predictor);

}  // namespace talisman::sequences
