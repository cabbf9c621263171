// SPDX-License-Identifier: Apache-2.0
// What is shown late, by layers and by whole frames: exact where the motion is one that a way can follow, and wrong where it
// is not.
#include "sequences/experiments/latency/displayed.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <numbers>
#include <sstream>

#include <gtest/gtest.h>
#include <glm/gtc/quaternion.hpp>

#include "sequences/content/asset_paths.h"
#include "sequences/content/own_settings.h"
#include "tests/sequences/content/trace_files.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using layers::dvec3;
using regulator::Prediction;
using tests::TemporaryFolder;

/// Two boxes before a wall, a head with a display on it; the head is traced at 1 kHz.
constexpr const char* kRoom =
    "frames: 30\nfps: 30\ndisplay: [128, 96]\n"
    "shapes:\n  - {id: head, box: [0.02, 0.02, 0.02], trace: {file: head.tum, frame: gl}}\n"
    "  - {id: dial, box: [0.1, 0.06, 0.01], carried_by: head, position: [0.25, 0.15, -1]}\n"
    "  - {id: near, box: [0.5, 0.5, 0.5], position: [0.4, 0, -2]}\n"
    "  - {id: far, box: [4, 4, 4], position: [-3, 1, -20]}\n  - {id: wall, box: [80, 60, 1], position: [0, "
    "0, -40]}\n"
    "camera: {carried_by: head, position: [0, 0, 0], fov_deg: 60, near_m: 0.05, far_m: 100}\n"
    "layers:\n  - {name: wall, parts: [wall], group: background}\n  - {name: head, parts: [head]}\n"
    "  - {name: near, parts: [near]}\n  - {name: far, parts: [far]}\n"
    "  - {name: dial, parts: [dial], group: foreground}\nregulator: {policy: threshold, geometric_px: 2}\n";

DisplayedExperiment shown(const std::function<tests::KnownPose(double)>& pose_at, int every = 30) {
  const TemporaryFolder folder;
  folder.write("head.tum", tests::tum_each_ms(pose_at, 1100));
  const Sequence sequence = load_sequence(folder.write("s.yaml", kRoom));
  return measure_displayed(sequence, own_settings(sequence), {6, 29, every}, 0, ProgressKind::None);
}

const ShownLatency& row(const DisplayedExperiment& experiment, double render_ms, Prediction predict) {
  return *std::find_if(experiment.rows.begin(), experiment.rows.end(), [&](const ShownLatency& r) {
    return r.render_ms == render_ms && r.predict == predict;
  });
}
const ShownWay& way(const ShownLatency& row, const std::string& name) {
  return *std::find_if(row.ways.begin(), row.ways.end(), [&](const ShownWay& w) { return w.name == name; });
}
const ShownLayer& layer(const ShownWay& way, const std::string& name) {
  return *std::find_if(way.layers.begin(), way.layers.end(),
                       [&](const ShownLayer& l) { return l.name == name; });
}

tests::KnownPose turning(double t_s) {
  return {dvec3{0.1, 0.2, 0.3}, glm::angleAxis(0.25 * std::sin(2 * std::numbers::pi * t_s), dvec3{0, 1, 0})};
}
tests::KnownPose walking(double t_s) { return {dvec3{0.4 * t_s, 0, 0}, glm::dquat(1, 0, 0, 0)}; }

/// A head that only turns: one homography has what stands in the world to 1e-6 px, and takes the display on the head with it;
/// layers are within what an affine map and their threshold leave, and the display hangs where it hangs.
TEST(Displayed, OfAHeadThatOnlyTurns) {
  const DisplayedExperiment experiment = shown(turning);
  const ShownLatency& held = row(experiment, 50, Prediction::Held);
  EXPECT_NEAR(held.pose.turn_deg.max, glm::degrees(0.5 * std::sin(std::numbers::pi * 0.05)), 0.02);
  EXPECT_NEAR(held.pose.turn_px.max, held.pose.turn_deg.max * 96 / 60, 1e-9);
  EXPECT_EQ(held.pose.overshoot_deg.max, 0) << "who holds is behind";
  EXPECT_GT(row(experiment, 50, Prediction::Linear).pose.overshoot_deg.max, 0.05);
  const ShownWay& homography = way(held, "homography");
  for (const char* name : {"near", "far", "wall"}) EXPECT_LE(layer(homography, name).px.max, 1e-6) << name;
  EXPECT_GT(layer(homography, "dial").px.max, 5);
  EXPECT_GT(homography.uncovered, 0) << "at the edge";
  const ShownWay& layers = way(held, "layers");
  EXPECT_LE(layer(layers, "dial").px.max, 1e-6);
  for (const char* name : {"near", "far"}) EXPECT_LT(layer(layers, name).px.max, 2.5) << name;
  EXPECT_GT(layers.reused, 0);
  EXPECT_LT(layers.polygons_per_frame, way(held, "layers, every frame").polygons_per_frame);
  EXPECT_EQ(way(held, "layers, every frame").reused, 0);
  EXPECT_EQ(homography.reused, 0);
  EXPECT_GT(way(held, "homography, same polygons").reused, 0);
  EXPECT_NEAR(way(held, "homography, same polygons").polygons_per_frame, layers.polygons_per_frame,
              homography.polygons_per_frame / 24 + 1e-9);
}

/// One that only moves: depth has every point of what it saw, a homography does nothing for what is near.
TEST(Displayed, OfAHeadThatOnlyMoves) {
  const DisplayedExperiment experiment = shown(walking);
  const ShownLatency& held = row(experiment, 50, Prediction::Held);
  // f = 48 / tan 30°, 0.02 m, and the nearest corner at z = −1.75.
  EXPECT_NEAR(layer(way(held, "homography"), "near").px.max,
              48 / std::tan(std::numbers::pi / 6) * 0.02 / 1.75, 1e-3);
  EXPECT_LE(layer(way(held, "depth, holes open"), "near").px.max, 1e-6);
  EXPECT_LE(layer(way(held, "depth, holes open"), "near").judder_px, 1e-6);
  EXPECT_LE(way(held, "depth, stretched").uncovered, way(held, "depth, holes open").uncovered);
  EXPECT_LE(layer(way(held, "layers"), "near").px.max, 2.5);
  // What is expected of a steady walk is where it is.
  EXPECT_LE(layer(way(row(experiment, 50, Prediction::Linear), "homography"), "near").px.max, 1e-3);
}

TEST(Displayed, OfNowIsDirect) {
  const DisplayedExperiment experiment = shown(turning);
  const ShownLatency& now = row(experiment, 0, Prediction::Held);
  EXPECT_EQ(now.pose.turn_deg.max, 0);
  const ShownWay& homography = way(now, "homography");
  EXPECT_LE(homography.px.max, 1e-6);
  EXPECT_LT(homography.flip, 1e-3);
  EXPECT_EQ(homography.uncovered, 0);
  EXPECT_EQ(experiment.rows.size(), 7u);
  for (const ShownLatency& each : experiment.rows) EXPECT_EQ(each.ways.size(), 10u);
  EXPECT_EQ(verdict_of(experiment).size(), 14u);
}

// --- The headset

/// Quaternions of the head by the file's own rows, read here: hips, chest and head, each as its channels say.
std::vector<glm::dquat> heads_of(const std::string& bvh) {
  std::istringstream in(bvh.substr(bvh.find("Frame Time:")));
  std::string line;
  std::getline(in, line);
  const auto about = [](double deg, const dvec3& axis) { return glm::angleAxis(glm::radians(deg), axis); };
  const dvec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  std::vector<glm::dquat> heads;
  while (std::getline(in, line)) {
    std::istringstream row(line);
    double v[12];
    for (double& value : v) row >> value;
    heads.push_back(about(v[3], z) * about(v[4], x) * about(v[5], y) * about(v[6], z) * about(v[7], y) *
                    about(v[8], x) * about(v[9], z) * about(v[10], x) * about(v[11], y));
  }
  return heads;
}

TEST(Headset, HeldPoseIsOffAsAnIndependentComputationSays) {
  const std::string file = sequence_file_of("headset");
  ASSERT_NE(file, "");
  const std::string folder_of = file.substr(0, file.rfind('/') + 1);
  std::string yaml = tests::content(file);
  const std::string walk = tests::content(folder_of + "walk.bvh");
  const std::string captured =
      "\"assimp-testmodels:/usr/share/assimp/models/BVH/01_01.bvh\", otherwise: walk.bvh";
  for (std::size_t at; (at = yaml.find(captured)) != std::string::npos;)
    yaml.replace(at, captured.size(), "walk.bvh");
  const TemporaryFolder folder;
  folder.write("walk.bvh", walk);
  const Sequence sequence = load_sequence(folder.write("headset.yaml", yaml));
  EXPECT_TRUE(sequence.warnings.empty());
  EXPECT_EQ(sequence.fps, 90);
  Settings settings = own_settings(sequence);
  const LatencyCurve curve = measure_latency(sequence, settings, {30, 359}, 0);
  const std::vector<glm::dquat> heads = heads_of(walk);
  const auto head_at = [&](double t_s) {
    const double k = (t_s + 7.5) * 45;
    const auto at = static_cast<std::size_t>(k);
    return glm::slerp(heads[at], heads[at + 1], k - static_cast<double>(at));
  };
  std::vector<double> turns;
  for (int frame = 30; frame < 360; ++frame) {
    const glm::dquat q = glm::conjugate(head_at(frame / 90.0)) * head_at(frame / 90.0 - 0.05);
    turns.push_back(glm::degrees(2 * std::atan2(std::hypot(q.x, q.y, q.z), std::fabs(q.w))));
  }
  std::sort(turns.begin(), turns.end());
  const double p95 = turns[static_cast<std::size_t>(0.95 * static_cast<double>(turns.size() - 1))];
  const auto held = std::find_if(curve.results.begin(), curve.results.end(), [](const LatencyResult& r) {
    return r.render_ms == 50 && r.predictor == Prediction::Held;
  });
  EXPECT_GT(p95, 3);
  EXPECT_NEAR(held->turn_deg.p95, p95, 0.05 * p95);
}

}  // namespace
}  // namespace talisman::sequences
