// SPDX-License-Identifier: Apache-2.0
// Runs that know old poses only: how far they are off by hand, what a last warp mends, and that nothing changes where
// nothing is old.
#include <cmath>

#include <gtest/gtest.h>
#include <glm/gtc/quaternion.hpp>

#include "sequences/pipeline/latency/last_warp.h"
#include "sequences/pipeline/latency/late_camera.h"
#include "sequences/pipeline/layer_planning.h"
#include "sequences/results/frame_lines.h"
#include "tests/sequences/small_run.h"
#include "tests/support/scenes.h"

namespace talisman::sequences {
namespace {

using layers::dmat4;
using layers::dvec3;
using layers::dvec4;
using regulator::Policy;
using regulator::Prediction;

/// A square of 2 m at z = 0, and one of 0.2 m that hangs 1 m before the camera. The camera is 5 m away, and moves as its
/// keys say; all look along −z.
layers::Scene squares(const layers::TransformTrack& of_camera) {
  layers::Scene scene;
  scene.meshes = {tests::quad_mesh(2), tests::quad_mesh(0.2)};
  scene.materials.resize(2);
  scene.materials[0].unlit = scene.materials[1].unlit = true;
  scene.materials[1].base_color = {1, 0, 0};
  layers::Node wall, eye, hud;
  wall.name = "wall", eye.name = "eye", hud.name = "hud";
  hud.parent = 1;
  hud.local.translation = {0.2, 0.1, -1};
  scene.nodes = {wall, eye, hud};
  scene.parts = {{"wall", 0, 0, 0, -1}, {"hud", 2, 1, 1, -1}};
  scene.cameras.emplace_back();
  scene.cameras[0].node = 1;
  scene.cameras[0].fov_y_rad = 2 * std::atan(0.5);  // focal length: the height
  scene.tracks.push_back({1, of_camera});
  return scene;
}

constexpr dvec3 kStart{0, 0, 5};

layers::TransformTrack gliding(double m_per_s) {
  layers::TransformTrack track;
  track.translation = {{0, 10}, {kStart, kStart + dvec3{10 * m_per_s, 0, 0}}, layers::Interpolation::Linear};
  return track;
}

layers::TransformTrack turning(double rad_per_s) {
  layers::TransformTrack track;
  track.translation.times_s = {0};
  track.translation.values = {kStart};
  for (int k = 0; k <= 100; ++k) {
    track.rotation.times_s.push_back(0.1 * k);
    track.rotation.values.push_back(glm::angleAxis(rad_per_s * 0.1 * k, dvec3{0, 1, 0}));
  }
  return track;
}

SmallRun run_of(const layers::TransformTrack& track, Policy policy, double render_ms,
                Prediction prediction = Prediction::Held, double warp_ms = regulator::kNoLastWarp_ms) {
  SmallRun small(squares(track));
  small.policy(policy, 1);
  small.settings.fps = 50;
  small.settings.regulator.latency = {render_ms, warp_ms, prediction};
  return small;
}

const LatencyReport& last_of(const std::vector<FrameReport>& reports) { return reports.back().late->report; }

/// Glides by 0.5 m/s, 5 m away, 150 px of focal length, 100 ms old: 150 · 0.05 / 5 = 1.5 px, with every policy that draws
/// each frame; the display hangs where it hangs.
TEST(LateRun, IsOffByTheWayOfTheCameraSinceThen) {
  for (const Policy policy : {Policy::Direct, Policy::Reference}) {
    const auto reports = run_of(gliding(0.5), policy, 100).run(10, false);
    EXPECT_NEAR(last_of(reports).true_px, 1.5, 1e-9) << regulator::name(policy);
    EXPECT_NEAR(last_of(reports).drawn_moved_m, 0.05, 1e-12);
    EXPECT_EQ(last_of(reports).drawn_turn_deg, 0);
    EXPECT_NEAR(reports.back().late->layer_px[1], 0, 1e-9) << "what hangs on the camera";
    EXPECT_EQ(last_of(reports).layers_missing, 0);
  }
  // Before 100 ms have passed the camera is known to have stood at its first key.
  const auto reports = run_of(gliding(0.5), Policy::Reference, 100).run(10, false);
  EXPECT_NEAR(reports[2].late->report.drawn_moved_m, 0.02, 1e-12);
  EXPECT_EQ(reports[0].late->report.true_px, 0);
}

TEST(LateRun, ExpectsConstantVelocityAndAcceleration) {
  for (const Prediction prediction : {Prediction::Linear, Prediction::Kalman}) {
    const auto moved = run_of(gliding(0.5), Policy::Reference, 100, prediction).run(30, false);
    EXPECT_LT(last_of(moved).true_px, 0.02) << regulator::name(prediction);
    const auto turned = run_of(turning(0.3), Policy::Reference, 100, prediction).run(30, false);
    EXPECT_LT(last_of(turned).drawn_turn_deg, 0.02) << regulator::name(prediction);
  }
  const auto held = run_of(turning(0.3), Policy::Reference, 100).run(30, false);
  EXPECT_NEAR(last_of(held).drawn_turn_deg, glm::degrees(0.03), 1e-9);
}

/// An affine map follows a square that is seen straight on exactly; a picture that is turned as a whole follows all that only
/// turns, and nothing that moves.
TEST(LateRun, LastWarpMendsWhatItsFamilyCan) {
  const auto glided = run_of(gliding(0.5), Policy::Reference, 100, Prediction::Held, 0).run(10, false);
  EXPECT_LT(last_of(glided).true_px, 1e-3);
  EXPECT_EQ(last_of(glided).shown_moved_m, 0);
  EXPECT_NEAR(last_of(glided).drawn_moved_m, 0.05, 1e-12);
  const auto turned = run_of(turning(0.3), Policy::Direct, 100, Prediction::Held, 0).run(10, false);
  EXPECT_LT(turned.back().late->layer_px[0], 1e-6);
  EXPECT_GT(run_of(turning(0.3), Policy::Direct, 100).run(10, false).back().late->layer_px[0], 4);
  const auto whole = run_of(gliding(0.5), Policy::Direct, 100, Prediction::Held, 0).run(10, false);
  EXPECT_NEAR(whole.back().late->layer_px[0], 1.5, 1e-9);
  // The display hangs where it is, and is turned away with the rest: what a whole picture cannot tell apart.
  EXPECT_GT(turned.back().late->layer_px[1], 4);
  const auto layered = run_of(turning(0.3), Policy::Reference, 100, Prediction::Held, 0).run(10, false);
  EXPECT_LT(layered.back().late->layer_px[1], 1e-6);
  const auto half = run_of(gliding(0.5), Policy::Reference, 100, Prediction::Held, 50).run(10, false);
  EXPECT_NEAR(last_of(half).true_px, 0.75, 1e-3);
}

std::vector<std::string> hashes(const std::vector<FrameReport>& reports) {
  std::vector<std::string> all;
  for (const FrameReport& report : reports) all.push_back(hash_of(report.picture));
  return all;
}

TEST(LateRun, OfACameraThatRestsIsThatOfOneInTime) {
  layers::TransformTrack still;
  still.translation.times_s = {0};
  still.translation.values = {kStart};
  SmallRun late = run_of(still, Policy::Threshold, 50, Prediction::Kalman, 10);
  SmallRun in_time = run_of(still, Policy::Threshold, 0);
  EXPECT_EQ(hashes(late.run(4, true)), hashes(in_time.run(4, true)));
}

/// A wall that is drawn late is where it was; the last warp that knows the pose of now shows nearly what `direct` does.
TEST(LateRun, PicturesShowWhatIsKnown) {
  const auto pictures = [&](double render_ms, Prediction prediction, double warp_ms) {
    return run_of(gliding(1), Policy::Reference, render_ms, prediction, warp_ms).run(12, true);
  };
  const auto in_time = pictures(0, Prediction::Held, regulator::kNoLastWarp_ms);
  const auto known = pictures(100, Prediction::Known, regulator::kNoLastWarp_ms);
  EXPECT_EQ(hashes(in_time), hashes(known));
  EXPECT_FALSE(known.back().late.has_value());
  // Five frames of 20 ms old: the picture of five frames ago, since nothing else moves.
  const auto held = pictures(100, Prediction::Held, regulator::kNoLastWarp_ms);
  EXPECT_EQ(hash_of(held[11].picture), hash_of(in_time[6].picture));
  EXPECT_NE(hash_of(held[11].picture), hash_of(in_time[11].picture));
  const auto same_age = pictures(100, Prediction::Held, 100);
  EXPECT_EQ(hashes(held), hashes(same_age));
  // The truth of --quality is the true camera.
  const SmallRun small = run_of(gliding(1), Policy::Reference, 100);
  Settings settings = small.settings;
  const Pipeline late = make_pipeline(small.scene, small.layers, settings);
  settings.regulator.latency = {};
  const Pipeline now = make_pipeline(small.scene, small.layers, settings);
  const chunker::PreparedScene prepared(small.scene);
  EXPECT_EQ(hash_of(draw_direct(late, 11, prepared)), hash_of(draw_direct(now, 11, prepared)));
}

TEST(LateRun, EveryPolicyIsPlannedAsItIsDrawn) {
  for (const Policy policy : regulator::kAllPolicies)
    for (const Prediction prediction : {Prediction::Held, Prediction::Linear, Prediction::Kalman}) {
      SmallRun small(tests::moving_scene());
      small.policy(policy, 2).lookahead(4);
      small.settings.regulator.budget.pixels = 20'000;
      small.settings.regulator.latency = {30, 10, prediction};
      small.settings.regulator.lookahead.predict = prediction;
      const auto planned = small.run(12, false), drawn = small.run(12, true);
      for (int frame = 0; frame < 12; ++frame) {
        const FrameReport &a = planned[frame], &b = drawn[frame];
        EXPECT_EQ(a.late->report, b.late->report);
        EXPECT_EQ(a.late->layer_px, b.late->layer_px);
        for (std::size_t k = 0; k < a.plan.decisions.size(); ++k)
          EXPECT_EQ(json_of(a, a.plan.decisions[k]), json_of(b, b.plan.decisions[k]));
        EXPECT_TRUE(std::isfinite(a.late->report.true_px)) << regulator::name(policy);
        EXPECT_FALSE(b.picture.pixels.empty());
      }
    }
}

/// What the frames before were drawn with is remembered; the rest follows from the number of the frame.
TEST(LateRun, FramesAreTheSameHoweverTheyAreReached) {
  SmallRun small(tests::moving_scene());
  small.policy(Policy::Threshold, 2);
  small.settings.regulator.latency = {30, 10, Prediction::Kalman};
  const auto whole = small.run(16, true);
  Settings settings = small.settings;
  settings.frames = 16;
  const Pipeline pipeline = make_pipeline(small.scene, small.layers, settings);
  const chunker::PreparedScene prepared(small.scene);
  PipelineState state(pipeline);
  for (int frame = 0; frame < 16; ++frame) {
    const FrameReport report = step(pipeline, state, frame, frame >= 9 ? &prepared : nullptr);
    if (frame < 9) continue;
    EXPECT_EQ(hash_of(report.picture), hash_of(whole[frame].picture)) << frame;
  }
}

TEST(LateRun, WhatIsSeenIsWhatItsCameraSees) {
  SmallRun small(tests::moving_scene());
  small.policy(Policy::Threshold, 2);
  small.settings.regulator.latency = {40, regulator::kNoLastWarp_ms, Prediction::Held};
  const auto all = small.run(24, true);
  small.settings.visibility.objects = ViewTest::Frustum;
  EXPECT_EQ(hashes(small.run(24, true)), hashes(all));
}

// --- The camera alone ---

TEST(CameraAlone, HasThePosesOfTheScene) {
  for (const layers::Scene& scene : {tests::moving_scene(), squares(turning(0.4)), tests::cube_scene()}) {
    const auto rig = camera_alone(scene);
    for (const double t_s : {-0.3, 0.0, 0.77, 3.1, 99.0})
      EXPECT_EQ(rig->at(t_s).camera, scene.at(t_s).camera) << t_s;
  }
  EXPECT_EQ(camera_alone(layers::Scene{})->at(1).camera, layers::CameraState{});
}

TEST(LookFrom, CarriesWhatHangsOnTheCamera) {
  layers::Scene scene = squares(gliding(0.5));
  layers::Light lamp;
  lamp.kind = layers::Light::Kind::Spot;
  lamp.node = 2;
  lamp.direction = {0, 0, -1};
  scene.lights = {lamp};
  layers::SceneFrame frame = scene.at(1);
  const layers::SceneFrame before = frame;
  layers::CameraState camera = frame.camera;
  camera.world_from_camera = glm::mat4_cast(glm::angleAxis(M_PI / 2, dvec3{0, 1, 0}));
  camera.world_from_camera[3] = {1, 2, 3, 1};
  look_from(frame, camera);
  EXPECT_EQ(frame.camera, camera);
  EXPECT_EQ(frame.world_from_node[0], before.world_from_node[0]);
  // One metre before an eye that looks along −x, 0.2 m to its right (−z), 0.1 m up.
  EXPECT_LT(glm::distance(dvec3(frame.world_from_node[2][3]), dvec3(0, 2.1, 2.8)), 1e-12);
  EXPECT_LT(glm::distance(frame.lights[0].position, dvec3(0, 2.1, 2.8)), 1e-12);
  EXPECT_LT(glm::distance(frame.lights[0].direction, dvec3(-1, 0, 0)), 1e-12);
}

TEST(LookFrom, CarriesWhatHangsOnTheHeadThatCarriesTheCamera) {
  layers::Scene scene = squares(gliding(0.5));
  layers::Node lens;
  lens.name = "lens", lens.parent = 1;
  scene.nodes.push_back(lens);
  scene.cameras[0].node = 3;
  EXPECT_EQ(tracked_node(scene), 1);
  scene.tracks.clear();
  EXPECT_EQ(tracked_node(scene), 3) << "nothing moves it";
  EXPECT_EQ(tracked_node(layers::Scene{}), -1);
}

}  // namespace
}  // namespace talisman::sequences
