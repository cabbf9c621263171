// SPDX-License-Identifier: Apache-2.0
// What old poses cost: a camera that only turns is warped exactly by one homography, one that only moves is not; and
// the more is predicted the less is off.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <glm/gtc/quaternion.hpp>

#include "sequences/content/own_settings.h"
#include "sequences/experiments/latency/latency_curve.h"
#include "tests/sequences/content/trace_files.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using layers::dvec3;
using regulator::Prediction;
using tests::TemporaryFolder;

constexpr const char* kThings =
    "frames: 60\nfps: 30\ndisplay: [640, 480]\n"
    "shapes:\n  - {id: near, box: [0.5, 0.5, 0.5], position: [0.4, 0, -2]}\n"
    "  - {id: far, box: [4, 4, 4], position: [-3, 1, -20]}\n";

/// A camera that is traced at 1 kHz.
LatencyCurve curve_of(const std::function<tests::KnownPose(double)>& pose_at, double warp_ms) {
  const TemporaryFolder folder;
  folder.write("head.tum", tests::tum_each_ms(pose_at, 2100));
  const Sequence sequence = load_sequence(folder.write(
      "s.yaml", std::string(kThings) +
                    "camera: {fov_deg: 60, near_m: 0.1, far_m: 100, trace: {file: head.tum, frame: gl}}\n"));
  return measure_latency(sequence, own_settings(sequence), {8, 59}, warp_ms);
}

const LatencyResult& row(const LatencyCurve& curve, double render_ms, Prediction predictor) {
  return *std::find_if(curve.results.begin(), curve.results.end(), [&](const LatencyResult& r) {
    return r.render_ms == render_ms && r.predictor == predictor;
  });
}

double max_px(const LatencyResult& r, LastWarp warp) {
  return r.error_px[static_cast<std::size_t>(warp)].max;
}

double yaw_at(double t_s) { return 0.25 * std::sin(2 * std::numbers::pi * t_s); }

tests::KnownPose turning(double t_s) {
  return {dvec3{0.1, 0.2, 0.3}, glm::angleAxis(yaw_at(t_s), dvec3{0, 1, 0})};
}

/// In a picture that is turned all points of a direction move alike, however far they are: one homography is exact. An
/// affine map of a layer is not, by what perspective does over its extent.
TEST(Latency, OfACameraThatOnlyTurnsIsUndoneByOneHomography) {
  const LatencyCurve curve = curve_of(turning, 0);
  const LatencyResult& held = row(curve, 50, Prediction::Held);
  EXPECT_GT(max_px(held, LastWarp::None), 20);
  EXPECT_LE(max_px(held, LastWarp::Homography), 1e-6);
  EXPECT_LE(max_px(held, LastWarp::Depth), 1e-6);
  EXPECT_GT(max_px(held, LastWarp::Layers), 0.01);
  EXPECT_LT(max_px(held, LastWarp::Layers), 2);
  // What the last warp knows no better than the picture does, it cannot mend.
  const LatencyCurve late = curve_of(turning, 50);
  EXPECT_EQ(max_px(row(late, 50, Prediction::Held), LastWarp::Depth),
            max_px(row(late, 50, Prediction::Held), LastWarp::None));
}

TEST(Latency, OfACameraThatOnlyMovesIsLeftByAHomography) {
  const LatencyCurve curve = curve_of(
      [](double t_s) {
        return tests::KnownPose{dvec3{0.5 * t_s, 0, 0}, glm::dquat(1, 0, 0, 0)};
      },
      0);
  const LatencyResult& held = row(curve, 50, Prediction::Held);
  EXPECT_GT(max_px(held, LastWarp::None), 2);
  EXPECT_NEAR(max_px(held, LastWarp::Homography), max_px(held, LastWarp::None), 1e-9);
  EXPECT_LT(max_px(held, LastWarp::Layers), max_px(held, LastWarp::None) / 2);
  EXPECT_LE(max_px(held, LastWarp::Depth), 1e-9);
}

/// By hand, without a projection matrix: a camera at c that is turned by yaw sees (x, y, z) at the pixel
/// W/2 + f (x' / −z'), where x' and z' are those of the turned axes.
TEST(Latency, OfTheHeldPoseIsThatOfAnIndependentComputation) {
  const double f = 240 / std::tan(std::numbers::pi / 6);
  const auto seen = [&](const dvec3& world, double yaw) {
    const dvec3 d = world - dvec3{0.1, 0.2, 0.3};
    const double x = d.x * std::cos(yaw) - d.z * std::sin(yaw), z = d.x * std::sin(yaw) + d.z * std::cos(yaw);
    return glm::dvec2(320 + f * x / -z, 240 - f * d.y / -z);
  };
  std::vector<double> errors, turns;
  for (int frame = 8; frame < 60; ++frame) {
    const double t_s = frame / 30.0, now = yaw_at(t_s), then = yaw_at(t_s - 0.05);
    turns.push_back(glm::degrees(std::fabs(now - then)));
    for (const auto& [middle, half] : {std::pair{dvec3{0.4, 0, -2}, 0.25}, {dvec3{-3, 1, -20}, 2.0}})
      for (int corner = 0; corner < 8; ++corner) {
        const dvec3 p = middle + half * dvec3{corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1};
        const glm::dvec2 a = seen(p, now), b = seen(p, then);
        if (a.x >= 0 && a.x <= 640 && a.y >= 0 && a.y <= 480) errors.push_back(glm::distance(a, b));
      }
  }
  const auto p95 = [](std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(0.95 * static_cast<double>(values.size() - 1))];
  };
  const LatencyCurve curve = curve_of(turning, 0);
  const LatencyResult& held = row(curve, 50, Prediction::Held);
  EXPECT_NEAR(held.error_px[0].p95, p95(errors), 0.05 * p95(errors));
  EXPECT_NEAR(held.turn_deg.p95, p95(turns), 0.05 * p95(turns));
  EXPECT_EQ(curve.points, static_cast<std::int64_t>(errors.size()));
}

TEST(Latency, IsSmallerTheMoreIsPredicted) {
  const LatencyCurve curve = curve_of(turning, 0);
  const auto turn = [&](Prediction predictor) { return row(curve, 50, predictor).turn_deg.p95; };
  EXPECT_LT(turn(Prediction::Linear), turn(Prediction::Held) / 2);
  EXPECT_LT(turn(Prediction::Kalman), turn(Prediction::Linear) / 2);
  EXPECT_EQ(turn(Prediction::Known), 0);
  for (const Prediction predictor : kExpectations)
    EXPECT_EQ(max_px(row(curve, 0, predictor), LastWarp::None), 0) << name(predictor);
}

}  // namespace
}  // namespace talisman::sequences
