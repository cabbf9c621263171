// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where will something be, if what is known of it are measured poses, and it goes on with the acceleration that they show?
///
/// Constant acceleration in place and in rotation vector: per axis a Kalman filter of x = (place, velocity, acceleration),
/// whose acceleration is a random walk. With the step h between poses and the horizon H:
///   x' = F x, P' = F P Fᵀ + Q          F = [1 h h²/2; 0 1 h; 0 0 1],  Q = q² ∫ g gᵀ ds, g = (s²/2, s, 1) over 0 … h
///   k  = P' e / (P'₀₀ + r²),  x = x' + k (z − x'₀),  P = (1 − k eᵀ) P'
///   x(H) = x₀ + H x₁ + H²/2 x₂
/// Heads that turn stop, bodies that walk go on. With a time that a turn's velocity lasts, C, and one that its acceleration does, A
/// (Singer, 1970), it dies away when left alone, and no horizon carries it far:
///   ẋ₁ = x₂ − x₁/C,  ẋ₂ = −x₂/A + noise;   F(h) = exp(h M), Q(h) = q² ∫ g gᵀ ds, g = F(s) e₂,  x(H) = (F(H) x)₀
/// with M the matrix of these rates; A much below h is a velocity that is pushed by white noise. F and Q of a time by doubling from
/// one in which less than 1/64 decays: F(2h) = F(h)², Q(2h) = Q(h) + F(h) Q(h) F(h)ᵀ.
/// A rotation R of the past is z = log(R Rₙ⁻¹), Rₙ the last one known: small, so that its components are coordinates; of the
/// ways round that are the same rotation the one next to that of the pose after it. The predicted rotation is exp(z(H)) Rₙ.
/// Places are told from the last one, so that a filter far from the origin is not one of rounding.
///
/// A pose that is not finite was not measured: it is passed by. Scale and shear stay as they are (layers/placed.h).

#include <span>

#include "layers/scene.h"

namespace talisman::layers {

/// Noise of poses and of motion. The defaults are of a tracker and of heads; a camera that flies at 100 m/s is
/// served as well, since its measurements hardly weigh less.
struct KalmanNoise {
  double place_m = 2e-4;  ///< > 0; standard deviation of a measured place; more follows later and smoother
  double turn_rad = 3.4906585039886593e-4;  ///< > 0; of a measured rotation, 0.02°; likewise
  double jerk_m =
      50;  ///< > 0; m s⁻³ √s: root of the density of the change of acceleration; more follows sooner
  double jerk_rad = 300;  ///< > 0; rad s⁻³ √s; likewise
  double coast_s = 0;     ///< C: in which the velocity of a turn falls to 1/e; less expects less; 0: it lasts
  double push_s = 0;      ///< A: its acceleration, likewise; jerks count for as long
  bool operator==(const KalmanNoise&) const = default;
};

/// `past`: at least one pose, `step_s` > 0 apart, the oldest first. Horizon ≥ 0 after the last of them; at 0, of one pose
/// and of poses that are all the same it is the last one, to the bit. Pure. Cost: O(poses) · some 200 ns.
dmat4 predict_kalman(std::span<const dmat4> past, double step_s, double horizon_s, const KalmanNoise& noise);

/// The scene `frames_ahead` ≥ 0 frame times after the last of `past`, `step_s` apart: matrices of nodes and camera so,
/// all else linearly (layers/predict.h). Nodes that are where they were in the frame before stay there.
SceneFrame predict_kalman(std::span<const SceneFrame> past, double step_s, double frames_ahead,
                          const KalmanNoise& noise);

}  // namespace talisman::layers
