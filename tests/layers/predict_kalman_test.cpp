// SPDX-License-Identifier: Apache-2.0
// The filter of constant acceleration, and of one that dies away: exact where that is the motion, and sound where poses are missing, stand still or turn
// the long way round.
#include "layers/predict_kalman.h"

#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "layers/predict.h"
#include "tests/layers/worlds.h"
#include "tests/support/scenes.h"

namespace talisman::layers {
namespace {

using tests::moved_by;
using tests::turned_by;

constexpr double kStep_s = 0.004;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
const KalmanNoise kUsual;

std::vector<dmat4> history(const std::function<dmat4(double)>& pose_at, int count, double step_s = kStep_s) {
  std::vector<dmat4> poses;
  for (int k = count - 1; k >= 0; --k) poses.push_back(pose_at(-k * step_s));
  return poses;
}

double largest_entry_off(const dmat4& a, const dmat4& b) {
  double largest = 0;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) {
      EXPECT_TRUE(std::isfinite(a[column][row]));
      largest = std::max(largest, std::fabs(a[column][row] - b[column][row]));
    }
  return largest;
}

/// Far from the origin: what a filter of absolute places would lose.
dmat4 accelerating(double t_s) {
  dmat4 m = turned_by(2 * t_s + 3 * t_s * t_s, {1, 2, 3}) * turned_by(1.0, {0, 1, 0});
  m[3] = {1e4 + 1.5 * t_s + 4 * t_s * t_s, -3 * t_s, 7, 1};
  return m;
}

TEST(PredictKalman, FollowsConstantAcceleration) {
  const std::vector<dmat4> poses = history(accelerating, 32);
  const dmat4 truth = accelerating(0.05);
  const dmat4 linear = predict_linear(poses[30], poses[31], 0.05 / kStep_s);
  // 4 H², and the half step by which its velocity is late.
  EXPECT_NEAR(glm::distance(linear[3], truth[3]), 4 * 0.05 * (0.05 + kStep_s), 1e-6);
  EXPECT_LT(largest_entry_off(predict_kalman(poses, kStep_s, 0.05, kUsual), truth), 5e-4);
}

/// The same estimate all at once: the states (x, v, a) of all poses that minimise
///   |s₀ − (z₀, 0, 0)|² P₀⁻¹ + Σ |s_k − F s_{k−1}|² Q⁻¹ + Σ (z_k − x_k)² / r²
/// by normal equations and elimination, and where the last of them goes on to.
double all_at_once(const std::vector<double>& z, const dmat3& f, const dmat3& noise, const dmat3& ahead,
                   double r) {
  const std::size_t n = 3 * z.size();
  std::vector<std::vector<double>> a(n, std::vector<double>(n + 1, 0));
  const dmat3 weight = glm::inverse(noise);
  const double prior[3] = {1 / (r * r), 1e-4, 1e-6};
  for (std::size_t i = 0; i < 3; ++i) a[i][i] += prior[i];
  a[0][n] += prior[0] * z[0];
  const dmat3 fw = glm::transpose(f) * weight, fwf = fw * f;
  const auto add = [&](std::size_t row, std::size_t column, const dmat3& m, double sign) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        a[row + static_cast<std::size_t>(i)][column + static_cast<std::size_t>(j)] += sign * m[j][i];
  };
  for (std::size_t k = 1; k < z.size(); ++k) {
    add(3 * k, 3 * k, weight, 1), add(3 * k - 3, 3 * k - 3, fwf, 1);
    add(3 * k - 3, 3 * k, fw, -1), add(3 * k, 3 * k - 3, glm::transpose(fw), -1);
    a[3 * k][3 * k] += 1 / (r * r);
    a[3 * k][n] += z[k] / (r * r);
  }
  for (std::size_t i = 0; i < n; ++i)  // symmetric and positive: no pivots
    for (std::size_t row = i + 1; row < n; ++row)
      for (std::size_t column = n + 1; column-- > i;) a[row][column] -= a[row][i] / a[i][i] * a[i][column];
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t column = i + 1; column < n; ++column) a[i][n] -= a[i][column] * a[column][n];
    a[i][n] /= a[i][i];
  }
  return ahead[0][0] * a[n - 3][n] + ahead[1][0] * a[n - 2][n] + ahead[2][0] * a[n - 1][n];
}

/// What a state becomes, by many small steps of Runge and Kutta.
dvec3 gone_on(dvec3 x, double h, const KalmanNoise& noise, int steps = 400) {
  const double a = noise.coast_s > 0 ? 1 / noise.coast_s : 0, b = noise.push_s > 0 ? 1 / noise.push_s : 0,
               d = h / steps;
  const auto rate = [&](const dvec3& s) { return dvec3(s.y, s.z - a * s.y, -b * s.z); };
  for (int k = 0; k < steps; ++k) {
    const dvec3 k1 = rate(x), k2 = rate(x + d / 2 * k1), k3 = rate(x + d / 2 * k2), k4 = rate(x + d * k3);
    x += d / 6 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  return x;
}

dmat3 step_over(double h, const KalmanNoise& noise) {
  return {gone_on({1, 0, 0}, h, noise), gone_on({0, 1, 0}, h, noise), gone_on({0, 0, 1}, h, noise)};
}

/// q² ∫ g gᵀ ds by midpoints.
dmat3 noise_over(double h, const KalmanNoise& noise, double q) {
  constexpr int kSlices = 2000;
  dmat3 sum(0.0);
  for (int k = 0; k < kSlices; ++k) {
    const dvec3 g = gone_on({0, 0, 1}, h * (k + 0.5) / kSlices, noise, 40);
    sum += glm::outerProduct(g, g) * (q * q * h / kSlices);
  }
  return sum;
}

/// Ten values, told from the last one.
std::vector<double> wavering() {
  std::vector<double> z;
  for (int k = 0; k < 10; ++k)
    z.push_back(0.3 * std::sin(0.7 * k) + 0.01 * (k * k % 7) - 0.3 * std::sin(0.7 * 9) - 0.01 * (81 % 7));
  return z;
}

constexpr double kFrame_s = 0.02, kAhead_s = 0.03;

TEST(PredictKalman, IsTheEstimateOfAllPosesAtOnce) {
  const std::vector<double> z = wavering();
  std::vector<dmat4> poses(z.size(), dmat4(1.0));
  for (std::size_t k = 0; k < z.size(); ++k) poses[k][3].x = z[k];
  for (const auto& [place, jerk] : {std::pair{0.05, 20.0}, {0.01, 300.0}, {0.3, 5.0}}) {
    KalmanNoise noise;
    noise.place_m = place;
    noise.jerk_m = jerk;
    const double at_once = all_at_once(z, step_over(kFrame_s, noise), noise_over(kFrame_s, noise, jerk),
                                       step_over(kAhead_s, noise), place);
    EXPECT_NEAR(predict_kalman(poses, kFrame_s, kAhead_s, noise)[3].x, at_once, 2e-6)
        << place << ", " << jerk;
  }
}

double angle_about_x(const dmat4& pose) { return std::atan2(pose[1].z, pose[1].y); }

TEST(PredictKalman, TurningThatDiesAwayIsTheEstimateOfAllPosesAtOnce) {
  const std::vector<double> z = wavering();
  std::vector<dmat4> poses;
  for (const double angle : z) poses.push_back(turned_by(angle, {1, 0, 0}));
  for (const auto& [turn, jerk] : {std::pair{0.05, 20.0}, {0.01, 300.0}, {0.3, 5.0}})
    for (const auto& [coast, push] :
         {std::pair{0.0, 0.0}, {0.25, 0.0}, {0.0, 0.1}, {0.3, 0.02}, {0.05, 0.05}}) {
      KalmanNoise noise;
      noise.turn_rad = turn;
      noise.jerk_rad = jerk;
      noise.coast_s = coast;
      noise.push_s = push;
      const double at_once = all_at_once(z, step_over(kFrame_s, noise), noise_over(kFrame_s, noise, jerk),
                                         step_over(kAhead_s, noise), turn);
      EXPECT_NEAR(angle_about_x(predict_kalman(poses, kFrame_s, kAhead_s, noise)), at_once, 2e-6)
          << turn << ", " << jerk << ", " << coast << ", " << push;
    }
}

/// 0.9 − 0.4 exp(−t/C): the motion that the filter then goes by, and its end however far ahead. Places go on.
TEST(PredictKalman, TurningThatCoastsComesToRest) {
  KalmanNoise noise;
  noise.coast_s = 0.2;
  const auto coasting = [](double t_s) {
    dmat4 m = turned_by(0.9 - 0.4 * std::exp(-t_s / 0.2), {1, 0, 0});
    m[3].x = 2 * t_s;
    return m;
  };
  const std::vector<dmat4> poses = history(coasting, 32);
  EXPECT_LT(largest_entry_off(predict_kalman(poses, kStep_s, 0.1, noise), coasting(0.1)), 1e-3);
  noise.push_s = 0.1;
  EXPECT_NEAR(angle_about_x(predict_kalman(poses, kStep_s, 1e6, noise)), 0.9, 0.02);
}

/// From pushes so short that they are white to coasting so long that nothing dies away: finite, and towards the old ones.
TEST(PredictKalman, AnyTimesThatMotionLastsAreSound) {
  const std::vector<dmat4> poses = history(accelerating, 32);
  const dmat4 lasting = predict_kalman(poses, kStep_s, 0.05, kUsual);
  for (const double coast : {0.0, 1e-6, 1e-3, 1.0, 1e6})
    for (const double push : {0.0, 1e-6, 1e-3, 1.0, 1e6}) {
      KalmanNoise noise;
      noise.coast_s = coast;
      noise.push_s = push;
      const double off = largest_entry_off(predict_kalman(poses, kStep_s, 0.05, noise), lasting);
      if ((coast == 0 || coast == 1e6) && (push == 0 || push == 1e6)) {
        EXPECT_LT(off, 1e-5) << coast << ", " << push;
      }
    }
}

TEST(PredictKalman, StandsStillWithWhatStandsStill) {
  const dmat4 pose = accelerating(0.3);
  const std::vector<dmat4> poses(32, pose);
  EXPECT_EQ(predict_kalman(poses, kStep_s, 0.1, kUsual), pose);
  EXPECT_EQ(predict_kalman(std::span(poses).first(1), kStep_s, 0.1, kUsual), pose);
  EXPECT_EQ(predict_kalman(history(accelerating, 9), kStep_s, 0, kUsual), accelerating(0));
}

/// A wheel of 20 turns a second is a third of a turn a frame at 60 Hz: in six frames two turns, and every third pose the same.
TEST(PredictKalman, CountsTurnsTheSameWayRound) {
  const auto wheel = [](double t_s) { return turned_by(2 * M_PI * 20 * t_s, {0, 0, 1}); };
  const std::vector<dmat4> poses = history(wheel, 16, 1 / 60.0);
  EXPECT_LT(largest_entry_off(predict_kalman(poses, 1 / 60.0, 2 / 60.0, kUsual), wheel(2 / 60.0)), 1e-3);
  // A half turn each time is the same both ways round: any answer, but one that is a rotation.
  const auto flip = [](double t_s) { return turned_by(M_PI * 60 * t_s, {0, 1, 0}); };
  const dmat4 ahead = predict_kalman(history(flip, 16, 1 / 60.0), 1 / 60.0, 0.5 / 60.0, kUsual);
  EXPECT_NEAR(glm::determinant(dmat3(ahead)), 1, 1e-9);
}

TEST(PredictKalman, PassesByWhatWasNotMeasured) {
  std::vector<dmat4> poses = history(accelerating, 32);
  for (const std::size_t k : {0, 3, 4, 30}) poses[k][3].x = k % 2 == 0 ? kInfinity : NAN;
  poses[7][1][2] = NAN;
  EXPECT_LT(largest_entry_off(predict_kalman(poses, kStep_s, 0.05, kUsual), accelerating(0.05)), 2e-3);
  poses.back()[0][0] = NAN;  // nothing is known of now: it stays what it is
  EXPECT_TRUE(std::isnan(predict_kalman(poses, kStep_s, 0.05, kUsual)[0][0]));
}

TEST(PredictKalman, KeepsScaleAndShearAndWhatIsFlat) {
  const dmat4 stretch = dmat4(2, 0, 0, 0, 1, 3, 0, 0, 0, 0, -0.5, 0, 0, 0, 0, 1);  // mirrored, too
  const auto pose_at = [&](double t_s) { return accelerating(t_s) * stretch; };
  EXPECT_LT(largest_entry_off(predict_kalman(history(pose_at, 32), kStep_s, 0.02, kUsual), pose_at(0.02)),
            1e-3);
  std::vector<dmat4> flat = history(accelerating, 4);
  flat.back()[1] = {0, 0, 0, 0};
  EXPECT_EQ(predict_kalman(flat, kStep_s, 0.02, kUsual), flat.back());
}

TEST(PredictKalman, OfAMillionPosesIsThatOfTheLastOnes) {
  const auto pose_at = [](double t_s) { return moved_by({std::sin(t_s), 0.1 * t_s, 0}); };
  const std::vector<dmat4> poses = history(pose_at, 1'000'000);
  const dmat4 all = predict_kalman(poses, kStep_s, 0.05, kUsual);
  const dmat4 few = predict_kalman(std::span(poses).last(500), kStep_s, 0.05, kUsual);
  EXPECT_LT(largest_entry_off(all, few), 1e-9);
  EXPECT_LT(largest_entry_off(all, pose_at(0.05)), 1e-4);
}

TEST(PredictKalman, OfASceneMovesWhatMoves) {
  const Scene scene = tests::moving_scene();
  std::vector<SceneFrame> past;
  for (int k = 0; k < 16; ++k) past.push_back(scene.at(1 + k / 60.0));
  const SceneFrame ahead = predict_kalman(past, 1 / 60.0, 2, kUsual);
  const SceneFrame truth = scene.at(1 + 17 / 60.0);
  EXPECT_DOUBLE_EQ(ahead.time_s, truth.time_s);
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
    if (past[14].world_from_node[n] == past[15].world_from_node[n]) {
      EXPECT_EQ(ahead.world_from_node[n], past[15].world_from_node[n]) << n;
    } else {
      EXPECT_LT(largest_entry_off(ahead.world_from_node[n], truth.world_from_node[n]), 0.01) << n;
    }
  }
  EXPECT_LT(largest_entry_off(ahead.camera.world_from_camera, truth.camera.world_from_camera), 0.01);
  EXPECT_EQ(predict_kalman(std::span(past).first(1), 1 / 60.0, 2, kUsual).world_from_node,
            past[0].world_from_node);
}

}  // namespace
}  // namespace talisman::layers
