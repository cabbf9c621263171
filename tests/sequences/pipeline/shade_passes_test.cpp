// SPDX-License-Identifier: Apache-2.0
// Shade layers end to end: decisions, passes and pictures of a small room.
#include "sequences/pipeline/shade_passes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/pipeline/step.h"
#include "tests/sequences/room_show.h"

namespace talisman::sequences {
namespace {

using regulator::Action;
using regulator::Policy;
using tests::Room;

using tests::run;
using tests::Show;
using tests::with_flying_ball;

constexpr int kShadedFrames = 16;

TEST(ShadePasses, RoomWithoutEffectsMakesNone) {
  const Show plain = run(with_flying_ball(Room()), Policy::Threshold, kShadedFrames, true);
  EXPECT_EQ(plain.passes(), ShadeCounters{});
}

TEST(ShadePasses, LightAndCastersAtRestAreMappedOnce) {
  // The camera moves, so every layer is drawn again in every frame of `reference`; the map is not.
  const Show still = run(Room().casting().factored().spinning(2), Policy::Reference, kShadedFrames, true);
  EXPECT_EQ(still.passes().shadow_maps_drawn, 1);
  EXPECT_GT(still.passes().shadow_maps_reused, kShadedFrames);
}

TEST(ShadePasses, MovingCasterIsMappedOncePerFrameHoweverManyLayersLookItUp) {
  const Show moving =
      run(with_flying_ball(Room().casting().shining().factored()), Policy::Reference, kShadedFrames, true);
  EXPECT_EQ(moving.passes().shadow_maps_drawn, kShadedFrames);
}

TEST(ShadePasses, MovingShadowLeavesItsReceiverAlone) {
  const Show factored =
      run(with_flying_ball(Room().casting().factored()), Policy::Threshold, kShadedFrames, true);
  EXPECT_EQ(factored.renders("floor"), 1);
  EXPECT_GT(factored.renders("floor/shadow of lamp"), 2);
  const Show unfactored = run(with_flying_ball(Room().casting()), Policy::Threshold, kShadedFrames, true);
  EXPECT_GT(unfactored.renders("floor"), 2);  // the same shadow, in the floor's own sprite
}

TEST(ShadePasses, PlanWithoutPixelsMakesTheSameDecisionsAndPasses) {
  const Room room = with_flying_ball(Room().casting().mirroring().shining().textured_twice().factored());
  for (const Policy policy : {Policy::Threshold, Policy::Hold, Policy::Lookahead, Policy::Budget}) {
    const Show planned = run(room, policy, kShadedFrames, false),
               drawn = run(room, policy, kShadedFrames, true);
    EXPECT_EQ(planned.passes(), drawn.passes());
    for (int frame = 0; frame < kShadedFrames; ++frame)
      for (std::size_t i = 0; i < planned.layers.layers.size(); ++i) {
        const auto& a = planned.reports[frame].plan.decisions[i];
        const auto& b = drawn.reports[frame].plan.decisions[i];
        EXPECT_EQ(a.reason, b.reason);
        EXPECT_EQ(a.action, b.action);
      }
  }
}

using tests::difference;
using tests::Difference;

int lit_pixels_changed(const chunker::Frame& a, const chunker::Frame& b) {
  return difference(a, b).above_two;
}

TEST(ShadePasses, FactoredPictureIsTheUnfactoredOne) {
  // Where cover is whole the two differ by the rounding of sprites alone; at edges by β(1-β)(1-s)(B - G).
  const Room room = Room().casting().mirroring().shining();
  const Show whole = run(room, Policy::Reference, 1, true);
  const Show terms = run(Room(room).factored(), Policy::Reference, 1, true);
  const Difference d = difference(terms.reports[0].picture, whole.reports[0].picture);
  std::printf("factored against unfactored: max %d, mean %.4f, above two %d of %d\n", d.max, d.mean,
              d.above_two, 160 * 120 * 3);
  EXPECT_LT(d.mean, 0.5);
  EXPECT_LE(d.above_two, 160 * 120 * 3 / 100);
  // And the effects are there at all: shadow, reflection and highlight each change the picture.
  const Show plain = run(Room(), Policy::Reference, 1, true);
  EXPECT_GT(lit_pixels_changed(plain.reports[0].picture, whole.reports[0].picture), 500);
}

TEST(ShadePasses, DirectShowsWhatSpritesShow) {
  const Room room = Room().casting().mirroring().shining().factored();
  const Show sprites = run(room, Policy::Reference, 1, true), direct = run(room, Policy::Direct, 1, true);
  EXPECT_LT(difference(sprites.reports[0].picture, direct.reports[0].picture).mean, 0.6);
}

TEST(ShadePasses, ThresholdZeroEqualsReferenceByteForByte) {
  const Room room = with_flying_ball(Room().casting().mirroring().shining().textured_twice().factored());
  const Show zero = run(room, Policy::Threshold, 8, true, 0),
             reference = run(room, Policy::Reference, 8, true);
  for (int frame = 0; frame < 8; ++frame)
    EXPECT_EQ(difference(zero.reports[frame].picture, reference.reports[frame].picture).max, 0) << frame;
}

TEST(ShadePasses, ShadowIsDrawnWhetherItsBaseIsDrawnOrNot) {
  // At threshold 0 with a caster that moves and one layer held back by its author: the base is drawn in frame
  // 0 only, the shadow in every frame, or every other one. All pictures stay near the reference.
  Room room = with_flying_ball(Room().casting().factored());
  const Show reference = run(room, Policy::Reference, 8, true);
  room.specs[0].shading.shadows->max_update_rate = 0.5;
  const Show slow = run(room, Policy::Threshold, 8, true, 0.01);
  EXPECT_EQ(slow.renders("floor"), 1);
  EXPECT_EQ(slow.renders("floor/shadow of lamp"), 4);
  for (int frame = 0; frame < 8; ++frame)
    EXPECT_LT(difference(slow.reports[frame].picture, reference.reports[frame].picture).mean, 0.5) << frame;
}

TEST(ShadePasses, MirrorThroughTheEyeAndBehindItDrawNothingStrange) {
  for (const double height : {0.0, -1e-9, -3.0}) {  // eye in the plane of the floor, just below, below
    Room room = Room().mirroring().factored();
    room.scene.nodes[2].local.translation.y = height;
    const Show edge_on = run(room, Policy::Reference, 1, true);
    EXPECT_EQ(edge_on.reports[0].picture.pixels.size(), 160u * 120u);
    Room plain;
    plain.scene.nodes[2].local.translation.y = height;
    const Show without = run(plain, Policy::Reference, 1, true);
    EXPECT_EQ(lit_pixels_changed(edge_on.reports[0].picture, without.reports[0].picture), 0) << height;
  }
}

TEST(ShadePasses, LightBelowTheFloorLeavesNoShadowOnIt) {
  Room room = Room().casting().factored();
  room.scene.nodes[3].local.translation = {1, -4, 1};
  const Show below = run(room, Policy::Reference, 1, true);
  Room dark = Room();
  dark.scene.nodes[3].local.translation = {1, -4, 1};
  const Show plain = run(dark, Policy::Reference, 1, true);
  EXPECT_LE(difference(below.reports[0].picture, plain.reports[0].picture).mean, 0.5);
}

TEST(MultipliersAt, FadeAndBlendFollowTheirKeysWithoutARender) {
  Room room = Room().textured_twice().factored();
  room.specs[0].shading.second_blend = {{0, 1}, {0, 1}, layers::Interpolation::Linear};
  room.specs[1].fade = {{0}, {0.25}, layers::Interpolation::Step};
  const Show blended = run(room, Policy::Threshold, 24, true);
  EXPECT_EQ(blended.renders("floor/texture 2"), 1);
  const layers::Layer& second = blended.layers.layers[1];
  EXPECT_FLOAT_EQ(multipliers_at(second, 0.5).color.x, 0.5f);
  EXPECT_FLOAT_EQ(multipliers_at(second, 0.5).alpha, 1);
  EXPECT_FLOAT_EQ(multipliers_at(blended.layers.layers[2], 9).alpha, 0.25f);
  EXPECT_GT(lit_pixels_changed(blended.reports[0].picture, blended.reports[23].picture), 1000);
}

}  // namespace
}  // namespace talisman::sequences
