// SPDX-License-Identifier: Apache-2.0
// Extrapolated motion: exact where the motion is what is assumed, and sound where it is not.
#include "layers/predict.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/layers/worlds.h"
#include "tests/support/scenes.h"

namespace talisman::layers {
namespace {

using tests::moved_by;
using tests::turned_by;
using tests::uniform;
using tests::uniform3;

double largest_difference(const dmat4& a, const dmat4& b) {
  double largest = 0;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) largest = std::max(largest, std::fabs(a[column][row] - b[column][row]));
  return largest;
}

dmat4 scaled_by(const dvec3& s) { return dmat4(s.x, 0, 0, 0, 0, s.y, 0, 0, 0, 0, s.z, 0, 0, 0, 0, 1); }

TEST(PredictLinear, ConstantVelocityAndAngularVelocityAreContinuedExactly) {
  constexpr unsigned kSeed = 96;
  std::mt19937 random(kSeed);
  for (int trial = 0; trial < 200; ++trial) {
    const dvec3 start = uniform3(random, -100, 100), velocity = uniform3(random, -3, 3);
    const dvec3 axis = uniform3(random, -1, 1) + dvec3(0.01, 0, 0);
    const double rate = uniform(random, -1.5, 1.5);
    const dvec3 size(uniform(random, 0.1, 5), uniform(random, 0.1, 5), uniform(random, 0.1, 5));
    const dvec3 growth = 0.02 * size;
    const dmat4 pose = tests::random_rotation(random);
    const auto at = [&](double k) {
      return moved_by(start + k * velocity) * turned_by(k * rate, axis) * pose * scaled_by(size + k * growth);
    };
    for (const double ahead : {0.5, 1.0, 7.0})
      EXPECT_LT(largest_difference(predict_linear(at(0), at(1), ahead), at(1 + ahead)), 1e-9)
          << "seed " << kSeed << " trial " << trial << ", " << ahead << " frames ahead";
  }
}

TEST(PredictLinear, WhatStandsStillStaysToTheBit) {
  // A reused sprite is recognised by equal matrices, so rounding would cost renders of what is at rest.
  std::mt19937 random(3);
  const dmat4 pose = moved_by(uniform3(random, -9, 9)) * tests::random_rotation(random);
  EXPECT_EQ(predict_linear(pose, pose, 13), pose);
  EXPECT_EQ(predict_linear(moved_by({1, 0, 0}) * pose, pose, 0), pose);
}

TEST(PredictLinear, WhatOnlyMovesKeepsItsRotationToTheBit) {
  std::mt19937 random(4);
  const dmat4 pose = tests::random_rotation(random);
  const dmat4 ahead = predict_linear(moved_by({1, 2, 3}) * pose, moved_by({2, 2, 3}) * pose, 5);
  EXPECT_EQ(dmat3(ahead), dmat3(pose));
  EXPECT_EQ(dvec3(ahead[3]), dvec3(7, 2, 3));
}

TEST(PredictLinear, MirroredMatricesTurnLikeOthers) {
  const auto at = [](double k) { return turned_by(0.1 * k, {1, 2, 3}) * scaled_by({1, 1, -2}); };
  EXPECT_LT(largest_difference(predict_linear(at(0), at(1), 4), at(5)), 1e-12);
}

TEST(PredictLinear, HalfTurnsGoTheShorterWayAndStayRotations) {
  // Just short of half a turn each frame: the quaternion's real part is almost 0.
  const auto at = [](double k) { return turned_by(3.14 * k, {0, 0, 1}); };
  EXPECT_LT(largest_difference(predict_linear(at(0), at(1), 2), at(3)), 1e-9);
}

TEST(PredictLinear, FlatMirroredAndInfiniteMatricesStayAsTheyAre) {
  const dmat4 plain(1.0), flat = scaled_by({1, 0, 1}), mirrored = scaled_by({1, -1, 1});
  dmat4 infinite(1.0), undefined(1.0);
  infinite[3][0] = HUGE_VAL;
  undefined[3][0] = NAN;
  EXPECT_EQ(predict_linear(plain, flat, 2), flat);
  EXPECT_EQ(predict_linear(flat, plain, 2), plain);
  EXPECT_EQ(predict_linear(plain, mirrored, 2), mirrored);
  EXPECT_EQ(predict_linear(plain, infinite, 2), infinite);
  EXPECT_EQ(predict_linear(undefined, plain, 2), plain) << "the past may be broken, the present is shown";
  EXPECT_EQ(predict_linear(plain, moved_by({1e300, 0, 0}), 1e300), moved_by({1e300, 0, 0})) << "overflow";
}

TEST(PredictLinear, ShrinkingStopsBeforeTheInside) {
  // Half the size in one frame: it would be gone in one more, and inside out after that.
  const dmat4 before = scaled_by(dvec3(1)), now = scaled_by(dvec3(0.5));
  EXPECT_EQ(predict_linear(before, now, 3), now);
  EXPECT_LT(largest_difference(predict_linear(before, now, 0.5), scaled_by(dvec3(0.25))), 1e-15);
}

TEST(PredictLinear, SceneAtRestIsTheSameSceneLater) {
  const Scene scene = tests::cube_scene();
  const SceneFrame before = scene.at(0), now = scene.at(0.25), ahead = predict_linear(before, now, 8);
  EXPECT_EQ(ahead.world_from_node, now.world_from_node);
  EXPECT_EQ(ahead.camera, now.camera);
  EXPECT_EQ(ahead.lights, now.lights);
  EXPECT_DOUBLE_EQ(ahead.time_s, 2.25);
}

TEST(PredictLinear, SpinningNodesOfASceneAreForeseen) {
  const Scene scene = tests::moving_scene();
  const double dt = 1.0 / 32;
  const SceneFrame ahead = predict_linear(scene.at(1), scene.at(1 + dt), 6), truth = scene.at(1 + 7 * dt);
  EXPECT_LT(largest_difference(ahead.world_from_node[1], truth.world_from_node[1]), 1e-12) << "the cube";
  // The moon runs on along the tangent of its orbit: half the acceleration, 0.8² · 2.5 m/s², times the
  // products of the times of linear extrapolation, 6 · 7 frames².
  const double miss = glm::distance(dvec3(ahead.world_from_node[3][3]), dvec3(truth.world_from_node[3][3]));
  EXPECT_NEAR(miss, 0.5 * 1.6 * 42 * dt * dt, 0.003);
}

TEST(PredictLinear, LightsMoveTurnAndNeverShineNegatively) {
  Scene scene;
  SceneFrame before, now;
  before.scene = now.scene = &scene;
  LightState light;
  light.kind = Light::Kind::Point;
  light.position = {0, 0, 0};
  light.color = {1, 1, 1};
  before.lights = {light};
  light.position = {1, 0, 0};
  light.direction = dvec3(dmat4(turned_by(0.2, {0, 0, 1})) * dvec4(0, -1, 0, 0));
  light.color = {0.75f, 1, 1.25f};
  now.lights = {light};
  const LightState ahead = predict_linear(before, now, 6).lights[0];
  EXPECT_EQ(ahead.position, dvec3(7, 0, 0));
  EXPECT_LT(glm::distance(ahead.direction, dvec3(std::sin(1.4), -std::cos(1.4), 0)), 1e-12);
  EXPECT_EQ(ahead.color, vec3(0, 1, 2.75f));
}

TEST(PredictLinear, FieldOfViewStaysAnAngle) {
  Scene scene;
  SceneFrame before, now;
  before.scene = now.scene = &scene;
  before.camera.fov_y_rad = 1;
  now.camera.fov_y_rad = 0.75;
  EXPECT_DOUBLE_EQ(predict_linear(before, now, 2).camera.fov_y_rad, 0.25);
  EXPECT_DOUBLE_EQ(predict_linear(before, now, 3).camera.fov_y_rad, 0.75) << "0 is no field of view";
}

}  // namespace
}  // namespace talisman::layers
