// SPDX-License-Identifier: Apache-2.0
// Which frame of an image sequence or a video is shown when, and what that means for the state of a layer.
#include "layers/moving_picture.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "layers/predict.h"
#include "layers/shade_state.h"
#include "tests/support/room.h"

namespace talisman::layers {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

MovingPicture of_rate(double fps, int frames) {
  MovingPicture picture;
  picture.fps = fps;
  picture.frame_count = frames;
  return picture;
}

TEST(FrameAt, EveryFrameOfItsOwnRateIsShownWhenItsTimeHasCome) {
  // k / fps · fps is often less than k by a rounding: without the tolerance a frame would be shown twice and the next
  // not at all.
  for (const double fps : {24.0, 25.0, 24000.0 / 1001, 30000.0 / 1001, 60.0, 7.3})
    for (int k = 0; k < 100'000; ++k) ASSERT_EQ(frame_at(of_rate(fps, 100'000), k / fps), k) << fps;
}

TEST(FrameAt, AnotherRateShowsTheFrameThatHasBegun) {
  // In whole numbers: frame k of a sequence of a frames/s shows frame floor(k · b / a) of a video of b frames/s.
  for (const auto& [a, b] : {std::pair{24, 30}, {30, 24}, {25, 24}, {24, 25}, {60, 24}, {24, 60}})
    for (int k = 0; k < 5000; ++k)
      ASSERT_EQ(frame_at(of_rate(b, 20'000), static_cast<double>(k) / a), k * b / a) << a << " " << b;
}

TEST(FrameAt, TheFirstAndTheLastFrameHold) {
  MovingPicture picture = of_rate(10, 5);
  picture.start_s = 2;
  EXPECT_EQ(frame_at(picture, -100), 0);
  EXPECT_EQ(frame_at(picture, 2), 0);
  EXPECT_EQ(frame_at(picture, 2.1), 1);
  EXPECT_EQ(frame_at(picture, 2.39), 3);
  EXPECT_EQ(frame_at(picture, 2.5), 4);
  EXPECT_EQ(frame_at(picture, 1e9), 4);
}

TEST(FrameAt, ALoopBeginsAgainAtItsEndHoweverOften) {
  MovingPicture picture = of_rate(24, 7);
  picture.loop = true;
  for (int k = 0; k < 50'000; ++k) ASSERT_EQ(frame_at(picture, k / 24.0), k % 7) << k;
  EXPECT_EQ(frame_at(picture, -1), 0) << "before its start it has not begun";
}

TEST(FrameAt, FramesWithTimesOfTheirOwn) {
  MovingPicture picture = of_rate(24, 3);
  picture.starts_s = {0, 0.1, 0.7};
  picture.length_s = 1;
  EXPECT_EQ(frame_at(picture, 0.099), 0);
  EXPECT_EQ(frame_at(picture, 0.1), 1);
  EXPECT_EQ(frame_at(picture, 0.69), 1);
  EXPECT_EQ(frame_at(picture, 0.7), 2);
  EXPECT_EQ(frame_at(picture, 5), 2);
  picture.loop = true;
  EXPECT_EQ(frame_at(picture, 5.2), 1);
}

/// The floor shows a moving picture of 4 frames at 10 frames/s, of which three are held; the ball does not.
tests::Room room_with_picture() {
  tests::Room room;
  for (int k = 0; k < 3; ++k) room.scene.textures.push_back({"frame", 1, 1, {0, 0, 0, 255}});
  room.scene.materials[0].texture = 1;
  room.scene.moving_pictures = {{"news", 1, 10, 0, 4, false, {}, 0, {0, 1, 3}, {1, 2, 3}}};
  return room;
}

TEST(TextureAt, IsThatOfTheFrameHeldLast) {
  const tests::Room room = room_with_picture();
  ASSERT_EQ(first_defect(room.scene), "");
  EXPECT_EQ(texture_at(room.scene.at(0), 1), 1);
  EXPECT_EQ(texture_at(room.scene.at(0.1), 1), 2);
  EXPECT_EQ(texture_at(room.scene.at(0.2), 1), 2) << "frame 2 is not held";
  EXPECT_EQ(texture_at(room.scene.at(0.3), 1), 3);
  EXPECT_EQ(texture_at(room.scene.at(0.3), 0), 0) << "a texture that stands still";
}

LayerState state_at(const tests::Room& room, const LayerSet& set, int layer, double t_s) {
  std::vector<LayerState> states;
  const SceneFrame frame = room.scene.at(t_s);
  for (const Layer& each : set.layers)
    states.push_back(capture(frame, each, make_layer_bound(room.scene, each, BoundKind::Box8), {}));
  capture_influences(frame, set, states);
  return states[layer];
}

TEST(PictureState, ALayerIsTheSameWhileItsFrameIs) {
  const tests::Room room = room_with_picture();
  const LayerSet set = factor(room.scene, room.specs);
  EXPECT_THAT(state_at(room, set, 0, 0.15).pictures, ElementsAre(ShownPicture{0, 1}));
  EXPECT_TRUE(state_at(room, set, 0, 0.1).same_pixels(state_at(room, set, 0, 0.19)));
  EXPECT_FALSE(state_at(room, set, 0, 0.1).same_pixels(state_at(room, set, 0, 0.2)));
  EXPECT_THAT(state_at(room, set, 1, 0.1).pictures, IsEmpty());
  EXPECT_TRUE(state_at(room, set, 1, 0.1).same_pixels(state_at(room, set, 1, 0.2)));
}

TEST(PictureState, AMirrorShowsTheFramesOfWhatItMirrors) {
  tests::Room room = room_with_picture();
  room.mirroring();
  std::swap(room.scene.materials[0].texture, room.scene.materials[1].texture);
  const LayerSet set = factor(room.scene, room.specs);
  ASSERT_TRUE(set.layers[0].holds.reflection);
  EXPECT_THAT(state_at(room, set, 0, 0.3).pictures, ElementsAre(ShownPicture{0, 3}));
  EXPECT_FALSE(state_at(room, set, 0, 0.2).same_pixels(state_at(room, set, 0, 0.3)));
}

TEST(PictureState, AShadeLayerShowsTheFramesOfItsSurface) {
  tests::Room room = room_with_picture();
  room.textured_twice().factored();
  room.scene.materials[0].texture2 = 1;
  const LayerSet set = factor(room.scene, room.specs);
  ASSERT_EQ(set.layers[1].base, 0);
  const SceneFrame frame = room.scene.at(0.1);
  const LayerState base =
      capture(frame, set.layers[0], make_layer_bound(room.scene, set.layers[0], BoundKind::Box8), {});
  EXPECT_THAT(shade_state(base, set.layers[1]).pictures, ElementsAre(ShownPicture{0, 1}));
}

TEST(PictureState, WhatIsAheadIsNotPredicted) {
  const tests::Room room = room_with_picture();
  const SceneFrame ahead = predict_linear(room.scene.at(0), room.scene.at(0.1), 2);
  EXPECT_THAT(ahead.picture_frames, ElementsAre(1)) << "a frame that nobody has seen yet";
}

TEST(NewPicture, IsNamedWithItsFrame) {
  const tests::Room room = room_with_picture();
  const std::vector<ShownPicture> then = {{0, 1}}, now = {{0, 3}};
  EXPECT_EQ(new_picture_in_words(room.scene, then, now), "new frame of 'news', 3");
  EXPECT_EQ(new_picture_in_words(room.scene, then, then), "");
  EXPECT_EQ(bytes_of(room.scene, now[0]), 4);
}

TEST(MovingPictureDefect, EachRuleIsSaid) {
  const auto defect_with = [](auto change) {
    tests::Room room = room_with_picture();
    change(room.scene.moving_pictures[0]);
    return first_defect(room.scene);
  };
  using P = MovingPicture;
  EXPECT_EQ(defect_with([](P& p) { p.fps = 0; }), "moving picture 'news': fps 0, rule: finite, above 0");
  EXPECT_EQ(defect_with([](P& p) { p.frame_count = 0; }),
            "moving picture 'news': frame count 0, rule: at least 1");
  EXPECT_EQ(defect_with([](P& p) { p.textures.pop_back(); }),
            "moving picture 'news': 3 frames and 2 textures, rule: at least 1, and as many");
  EXPECT_EQ(defect_with([](P& p) {
              p.frames = {0, 3, 3};
            }),
            "moving picture 'news': frames, rule: numbers of frames grow");
  EXPECT_EQ(defect_with([](P& p) { p.textures[2] = 4; }),
            "moving picture 'news': texture 4, rule: from 0 to below 4");
  EXPECT_EQ(defect_with([](P& p) { p.texture = 0; }),
            "moving picture 'news': texture 0, rule: that of its first frame, 1");
  EXPECT_EQ(defect_with([](P& p) {
              p.starts_s = {0, 1};
            }),
            "moving picture 'news': 2 starts, rule: as many as frames, 4");
  EXPECT_EQ(defect_with([](P& p) {
              p.starts_s = {0, 1, 1, 2};
            }),
            "moving picture 'news': starts, rule: starts of frames grow from 0 to below the finite length");
}

}  // namespace
}  // namespace talisman::layers
