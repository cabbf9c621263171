// SPDX-License-Identifier: Apache-2.0
// What rests by its tracks is equal to the bit whenever the scene is evaluated.
#include "layers/rest.h"

#include <random>

#include <gtest/gtest.h>

#include "layers/animation.h"
#include "tests/support/scenes.h"

namespace talisman::layers {
namespace {

TransformTrack translation(std::vector<double> times, std::vector<dvec3> values,
                           Interpolation interpolation = Interpolation::Linear) {
  TransformTrack track;
  track.translation.times_s = std::move(times);
  track.translation.values = std::move(values);
  track.translation.interpolation = interpolation;
  return track;
}

TEST(TrackRest, BetweenEqualKeysAndOutsideOfAllKeys) {
  const Track track{0, translation({1, 2, 3, 4}, {{0, 0, 0}, {5, 0, 0}, {5, 0, 0}, {7, 0, 0}})};
  EXPECT_TRUE(rests(track, -9, 1));
  EXPECT_FALSE(rests(track, -9, 1.1));
  EXPECT_TRUE(rests(track, 2, 3));
  EXPECT_TRUE(rests(track, 2.2, 2.9));
  EXPECT_FALSE(rests(track, 1.9, 2.1));
  EXPECT_FALSE(rests(track, 2, 3.0001));
  EXPECT_TRUE(rests(track, 4, 99));
}

TEST(TrackRest, MotionThatReturnsIsNoRest) {
  const Track track{0, translation({0, 1, 2}, {{0, 0, 0}, {5, 0, 0}, {0, 0, 0}})};
  EXPECT_FALSE(rests(track, 0, 2));
}

TEST(TrackRest, SpinsLoopsFlightsAndSlopesNeverDo) {
  EXPECT_FALSE(rests({0, SpinTrack{{0, 1, 0}, 1e-9}}, 5, 5.1));
  EXPECT_TRUE(rests({0, SpinTrack{{0, 1, 0}, 0}}, 0, 99)) << "it has no motion at all";
  TransformTrack loop = translation({0, 1, 2}, {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}});
  loop.loop = true;
  EXPECT_FALSE(rests({0, loop}, 0, 1));
  TransformTrack sloped = translation({0, 1}, {{0, 0, 0}, {0, 0, 0}}, Interpolation::CubicSpline);
  sloped.translation.in_tangents = sloped.translation.out_tangents = {{1, 0, 0}, {1, 0, 0}};
  EXPECT_FALSE(rests({0, sloped}, 0.2, 0.8));
  FlightTrack flight;
  flight.position.times_s = {0, 1, 2, 3};
  flight.position.values = {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 0, 1}};
  EXPECT_FALSE(rests({0, flight}, 1, 2));
}

/// Frames of which every second key repeats the one before.
Track random_track(std::mt19937& random, int node) {
  std::uniform_real_distribution<double> place(-2, 2), wait(0.05, 0.5);
  std::uniform_int_distribution<int> kind(0, 2);
  TransformTrack track;
  double t = wait(random);
  for (int key = 0; key < 8; ++key, t += wait(random)) {
    const bool repeats = key > 0 && random() % 2 == 0;
    track.translation.times_s.push_back(t);
    track.translation.values.push_back(repeats ? track.translation.values.back()
                                               : dvec3(place(random), place(random), place(random)));
    track.rotation.times_s.push_back(t);
    track.rotation.values.push_back(
        repeats ? track.rotation.values.back()
                : glm::normalize(glm::dquat(1, place(random), place(random), place(random))));
  }
  track.translation.interpolation = static_cast<Interpolation>(kind(random));
  return {node, track};
}

/// The oracle: the scene itself, at many times.
TEST(LayerRest, WhatRestsIsTheSameToTheBitAtAllInstantsInBetween) {
  std::mt19937 random(1818);
  std::uniform_real_distribution<double> time(-0.5, 5), length(0, 0.6);
  Scene scene = tests::cube_scene();
  scene.tracks.clear();
  int rested = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    if (trial % 40 == 0) scene.tracks = {random_track(random, scene.parts.front().node)};
    const Layer layer = factor(scene, tests::one_layer_per_part(scene)).layers.front();
    const double from = time(random), to = from + length(random);
    if (!LayerRest(scene, layer).rests(to, from)) continue;
    ++rested;
    const auto world = [&](double t) { return scene.at(t).world_from_node[scene.parts.front().node]; };
    for (int k = 0; k <= 8; ++k) ASSERT_EQ(world(from + (to - from) * k / 8), world(from)) << trial;
  }
  EXPECT_GT(rested, 500);
  EXPECT_LT(rested, 3500);
}

TEST(LayerRest, TheCameraAndTheLightsCount) {
  Scene scene = tests::cube_scene();
  scene.nodes.push_back({"eye", -1, {}});
  scene.cameras[static_cast<std::size_t>(scene.active_camera)].node =
      static_cast<int>(scene.nodes.size()) - 1;
  const auto is_at_rest = [&] {
    const Layer layer = factor(scene, tests::one_layer_per_part(scene)).layers.front();
    return LayerRest(scene, layer).rests(0, 1);
  };
  EXPECT_TRUE(is_at_rest());
  const int eye = static_cast<int>(scene.nodes.size()) - 1;
  scene.tracks = {{eye, translation({0, 1}, {{0, 0, 0}, {0, 0, 1}})}};
  EXPECT_FALSE(is_at_rest());
  scene.cameras[static_cast<std::size_t>(scene.active_camera)].node = -1;
  EXPECT_TRUE(is_at_rest()) << "nothing hangs on that node any more";
  Light light;
  light.node = eye;
  scene.lights.push_back(light);
  EXPECT_FALSE(is_at_rest());
}

TEST(LayerRest, OfOpenShuttersAndMovingPicturesNothingIsCertain) {
  Scene scene = tests::cube_scene();
  Layer layer = factor(scene, tests::one_layer_per_part(scene)).layers.front();
  EXPECT_TRUE(LayerRest(scene, layer).rests(0, 1));
  layer.preferences.motion_blur = 0.5;
  EXPECT_FALSE(LayerRest(scene, layer).rests(0, 1));
  layer.preferences.motion_blur = 0;
  scene.moving_pictures.emplace_back();
  EXPECT_FALSE(LayerRest(scene, layer).rests(0, 1));
}

}  // namespace
}  // namespace talisman::layers
