// SPDX-License-Identifier: Apache-2.0
// The filter of constant acceleration: exact where that is the motion, and sound where poses are missing, stand still or turn
// the long way round.
#include "layers/predict_kalman.h"

#include <cmath>
#include <functional>
#include <limits>

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
/// by normal equations and elimination, and the parabola of the last of them.
double all_at_once(const std::vector<double>& z, double h, double horizon, double r, double q) {
  const std::size_t n = 3 * z.size();
  std::vector<std::vector<double>> a(n, std::vector<double>(n + 1, 0));
  const dmat3 f{{1, 0, 0}, {h, 1, 0}, {h * h / 2, h, 1}};
  const double h2 = h * h, h3 = h2 * h, h4 = h3 * h, h5 = h4 * h;
  const dmat3 weight =
      glm::inverse(q * q * dmat3{{h5 / 20, h4 / 8, h3 / 6}, {h4 / 8, h3 / 3, h2 / 2}, {h3 / 6, h2 / 2, h}});
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
  return a[n - 3][n] + horizon * a[n - 2][n] + horizon * horizon / 2 * a[n - 1][n];
}

TEST(PredictKalman, IsTheEstimateOfAllPosesAtOnce) {
  constexpr double kFrame_s = 0.02;
  std::vector<dmat4> poses(10, dmat4(1.0));
  std::vector<double> z;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    poses[k][3].x = 0.3 * std::sin(0.7 * static_cast<double>(k)) + 0.01 * static_cast<double>(k * k % 7);
    z.push_back(poses[k][3].x - 0.3 * std::sin(0.7 * 9) - 0.01 * (81 % 7));  // from the last one on
  }
  for (const auto& [place, jerk] : {std::pair{0.05, 20.0}, {0.01, 300.0}, {0.3, 5.0}}) {
    KalmanNoise noise;
    noise.place_m = place;
    noise.jerk_m = jerk;
    const double ahead = predict_kalman(poses, kFrame_s, 0.03, noise)[3].x - poses.back()[3].x;
    EXPECT_NEAR(ahead, all_at_once(z, kFrame_s, 0.03, place, jerk), 1e-6) << place << ", " << jerk;
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
