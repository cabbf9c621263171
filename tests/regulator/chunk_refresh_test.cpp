// SPDX-License-Identifier: Apache-2.0
// Chunks that are judged alone: no point of what is left is off by more than the bound, by brute force over points.
#include "regulator/chunk_refresh.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include "layers/state.h"

namespace talisman::regulator {
namespace {

using layers::Affine2;
using layers::dvec2;
using layers::dvec3;
using layers::dvec4;
using layers::LayerState;
using layers::SpritePlacement;

constexpr layers::ivec2 kScreen{320, 256};

/// A ground of 16 × 16 cells of 4 m, from 2 m before the camera on, flat but for hills of `height_m`.
LayerContent ground(double height_m = 0.5) {
  LayerContent content;
  for (int z = 0; z < 16; ++z)
    for (int x = 0; x < 16; ++x) {
      const double h = height_m * ((x * 7 + z * 3) % 5) / 4;
      content.boxes.push_back({0, {4.0 * x - 32, 0, -4.0 * z - 6}, {4.0 * x - 28, h, -4.0 * z - 2}, 10});
    }
  content.vertices = 1000;
  content.triangles = 2560;
  return content;
}

/// Seen from `eye`, turned by `yaw_rad`, a little downwards.
LayerState seen_from(const dvec3& eye, double yaw_rad = 0) {
  LayerState state;
  state.view.display_px = kScreen;
  state.camera.near_m = 0.1;
  state.camera.world_from_camera = glm::rotate(
      glm::rotate(glm::translate(layers::dmat4(1), eye), yaw_rad, dvec3(0, 1, 0)), -0.3, dvec3(1, 0, 0));
  state.world_from_part = {layers::dmat4(1)};
  return state;
}

/// The whole display and 32 px around it, cut off on all sides.
SpritePlacement wide_placement() {
  SpritePlacement placement;
  placement.screen_from_sprite = {1, 0, -32, 0, 1, -32};
  placement.size_px = kScreen + 64;
  placement.clipped = {true, true, true, true};
  return placement;
}

SpriteChunks drawn_at(const LayerContent& content, const LayerState& then,
                      const SpritePlacement& placement = wide_placement()) {
  return whole_sprite(placement, chunk_instant(content, content_view(then), placement, {}, 0));
}

ChunkJudgement judged(const LayerContent& content, const SpriteChunks& chunks, const LayerState& now,
                      double px, const SpritePlacement& placement = wide_placement()) {
  return judge_chunks(content, chunks, content_view(now), placement, kScreen, {px, warp::Curve::aff, {}});
}

dvec2 on_display(const LayerState& state, const dvec3& p) {
  return layers::screen_from_clip(
      layers::clip_from_world(state.camera, kScreen) * state.world_from_part[0] * dvec4(p, 1), kScreen);
}

bool is_on(const dvec2& p) { return p.x >= 0 && p.y >= 0 && p.x <= kScreen.x && p.y <= kScreen.y; }

const dvec3 kEye{0, 4, 0};

TEST(ChunkRefresh, AtRestNothingIsOver) {
  const LayerContent content = ground();
  const ChunkJudgement judgement = judged(content, drawn_at(content, seen_from(kEye)), seen_from(kEye), 0.01);
  EXPECT_EQ(judgement.why_whole, "");
  EXPECT_THAT(judgement.over, ::testing::IsEmpty());
  EXPECT_LT(judgement.worst_px, 1e-9);
  EXPECT_EQ(judgement.share.step_px, 0);
  EXPECT_EQ(judgement.polygons, 0);
  EXPECT_GT(judgement.share.stored, 40);
}

/// One instant of the sprite, as the test knows it: the state, and the warp that was then.
struct KnownInstant {
  LayerState state;
  Affine2 carried;
};

/// The largest error of a point in a chunk that is left as it is: of what the chunk shows, or of what belongs there now.
/// And the largest step between two chunks that show one point.
struct Errors {
  double left_px = 0, step_px = 0;
  int points = 0;
};

/// By lot, points in all boxes; by hand, where each chunk shows them.
Errors errors_of(const LayerContent& content, const SpriteChunks& chunks,
                 const std::vector<KnownInstant>& instants, const LayerState& now,
                 const ChunkJudgement& judgement) {
  std::mt19937 lot(7);
  std::uniform_real_distribution<double> share(0, 1);
  const SpritePlacement placement = wide_placement();
  const Affine2 texel = *inverse(placement.screen_from_sprite), warp = judgement.fitted.warp.affine(),
                texel_now = *inverse(warp * placement.screen_from_sprite);
  const auto chunk_at = [&](const dvec2& at) {  // -1: outside, or drawn now
    if (!(at.x >= 0 && at.y >= 0 && at.x < placement.size_px.x && at.y < placement.size_px.y)) return -1;
    const int place = static_cast<int>(at.y) / 32 * chunks.count.x + static_cast<int>(at.x) / 32;
    return std::binary_search(judgement.over.begin(), judgement.over.end(), place) ? -1 : place;
  };
  const auto depth = [](const LayerState& state, const dvec3& p) {
    return (layers::clip_from_world(state.camera, kScreen) * dvec4(p, 1)).w;
  };
  Errors errors;
  for (const ContentBox& box : content.boxes)
    for (int k = 0; k < 60; ++k) {
      const dvec3 p = box.lo + dvec3(share(lot), share(lot), share(lot)) * (box.hi - box.lo);
      const dvec2 right = on_display(now, p);
      const bool belongs = depth(now, p) > 0.1 && is_on(right);
      const int now_in = belongs ? chunk_at(texel_now(right)) : -1;
      std::vector<dvec2> shown;
      for (std::size_t s = 0; s < instants.size(); ++s) {
        if (depth(instants[s].state, p) < 0.1) continue;
        const dvec2 first = (*inverse(instants[s].carried))(on_display(instants[s].state, p));
        const int then_in = chunk_at(texel(first));
        const bool shows = then_in >= 0 && chunks.of_chunk[then_in] == s && is_on(warp(first));
        const bool lacks = now_in >= 0 && chunks.of_chunk[now_in] == s;
        if (!shows && !lacks) continue;
        errors.left_px = std::max(errors.left_px, glm::distance(warp(first), right));
        ++errors.points;
        if (shows && belongs) shown.push_back(warp(first));
      }
      for (const dvec2& a : shown)
        for (const dvec2& b : shown) errors.step_px = std::max(errors.step_px, glm::distance(a, b));
    }
  return errors;
}

TEST(ChunkRefresh, NoPointOfAChunkThatIsLeftIsBeyondTheBound) {
  // A flight over the ground: what is near is off after one frame, what is far serves for many.
  const LayerContent content = ground();
  const double limit_px = 2;
  SpriteChunks chunks = drawn_at(content, seen_from(kEye));
  std::vector<KnownInstant> instants{{seen_from(kEye), {}}};
  int refreshed = 0;
  for (int frame = 1; frame < 12; ++frame) {
    const LayerState now = seen_from(kEye + dvec3(0.02, 0.01, -0.07) * double(frame), 0.002 * frame);
    const ChunkJudgement judgement = judged(content, chunks, now, limit_px);
    ASSERT_EQ(judgement.why_whole, "") << frame;
    EXPECT_LE(judgement.left_px, limit_px);
    const Errors errors = errors_of(content, chunks, instants, now, judgement);
    EXPECT_GT(errors.points, 1000);
    EXPECT_LE(errors.left_px, judgement.left_px + 1e-9) << frame;
    EXPECT_LE(errors.step_px, 2 * limit_px) << frame;
    EXPECT_LE(judgement.share.step_px, 2 * limit_px + 1e-9) << frame;
    if (judgement.over.empty()) continue;
    refreshed += static_cast<int>(judgement.over.size());
    const Affine2 warp = judgement.fitted.warp.affine();
    set_chunks(judgement.over, chunk_instant(content, content_view(now), wide_placement(), warp, frame),
               chunks);
    // The test's list follows the sprite's own.
    instants.push_back({now, warp});
    std::vector<KnownInstant> kept;
    for (const auto& instant : chunks.instants)
      for (const KnownInstant& known : instants)
        if (known.carried == instant->carried) {
          kept.push_back(known);
          break;
        }
    instants = kept;
    ASSERT_EQ(instants.size(), chunks.instants.size());
  }
  EXPECT_GT(refreshed, 20) << "the case says nothing unless chunks are over";
}

TEST(ChunkRefresh, AClearChunkThatMotionEntersIsOver) {
  // One small box that rises out of a layer at rest, into chunks that were clear.
  LayerContent content = ground(0);
  content.boxes.push_back({1, {-0.2, 2.4, -6.2}, {0.2, 2.8, -5.8}, 12});
  LayerState then = seen_from(kEye), now = then;
  then.world_from_part.push_back(layers::dmat4(1));
  now.world_from_part.push_back(glm::translate(layers::dmat4(1), dvec3(0, 2, 0)));
  const SpriteChunks chunks = drawn_at(content, then);
  const ChunkJudgement judgement = judged(content, chunks, now, 1);
  ASSERT_EQ(judgement.why_whole, "");
  const auto was_clear = [&](int chunk) {
    const int x = chunk % chunks.count.x, y = chunk / chunks.count.x;
    for (const ChunkRect& reach : chunks.instants[0]->reach)
      if (x >= reach.x0 && x < reach.x1 && y >= reach.y0 && y < reach.y1) return false;
    return true;
  };
  const auto chunk_at = [&](const LayerState& state, const dvec3& p) {
    const dvec2 texel = on_display(state, p) + 32.0;
    return static_cast<int>(texel.y) / 32 * chunks.count.x + static_cast<int>(texel.x) / 32;
  };
  const int left = chunk_at(then, {0, 2.6, -6}), entered = chunk_at(now, {0, 4.6, -6});
  EXPECT_FALSE(was_clear(left));
  EXPECT_TRUE(was_clear(entered));
  EXPECT_THAT(judgement.over, ::testing::IsSupersetOf({left, entered}));
  EXPECT_LT(judgement.over.size(), 12u) << "the ground rests";
}

TEST(ChunkRefresh, WhatReachesThroughTheNearPlaneHasNoBoundAndIsDrawnEachTime) {
  // A beam from behind the eye to far ahead, in the upper left of what is seen; all else rests.
  LayerContent content = ground(0);
  const ChunkJudgement before = judged(content, drawn_at(content, seen_from(kEye)), seen_from(kEye), 1);
  EXPECT_THAT(before.over, ::testing::IsEmpty());
  content.boxes.push_back({0, {-0.03, 4.02, -12}, {-0.02, 4.03, 1}, 12});
  const SpriteChunks chunks = drawn_at(content, seen_from(kEye));
  const ChunkJudgement judgement = judged(content, chunks, seen_from(kEye), 1);
  ASSERT_EQ(judgement.why_whole, "");
  EXPECT_THAT(judgement.over, ::testing::Not(::testing::IsEmpty()));
  for (const int c : judgement.over) {  // the beam lies left of the middle, above the vanishing line's foot
    EXPECT_LE(c % chunks.count.x, 6) << c;
    EXPECT_LE(c / chunks.count.x, 5) << c;
  }
  // A wall around the eye may be everywhere.
  content.boxes.push_back({0, {-1, 3, -2}, {1, 5, 1}, 12});
  EXPECT_EQ(judged(content, drawn_at(content, seen_from(kEye)), seen_from(kEye), 1).why_whole,
            "most of its chunks are off");
}

TEST(ChunkRefresh, WhatIsBehindTheEyeAsksForNothing) {
  LayerContent content = ground(0);
  content.boxes.push_back({0, {-5, 0, 20}, {5, 3, 30}, 12});     // behind
  content.boxes.push_back({0, {-5, -30, -1}, {5, -20, 1}, 12});  // far below, across the eye's plane
  const ChunkJudgement judgement = judged(content, drawn_at(content, seen_from(kEye)), seen_from(kEye), 1);
  EXPECT_EQ(judgement.why_whole, "");
  EXPECT_THAT(judgement.over, ::testing::IsEmpty());
}

TEST(ChunkRefresh, CasesInWhichAllIsDrawnAreNamed) {
  LayerContent content = ground();
  const SpriteChunks chunks = drawn_at(content, seen_from(kEye));
  SpritePlacement display = wide_placement();  // of chunks that are not shown none is over
  display.screen_from_sprite = {};
  display.size_px = kScreen;
  EXPECT_EQ(judged(content, drawn_at(content, seen_from(kEye), display), seen_from(kEye, 0.01), 1e-9, display)
                .why_whole,
            "most of its chunks are off");
  LayerState mirrored = seen_from(kEye);
  mirrored.world_from_part[0][0].x = -1;
  EXPECT_EQ(judged(content, chunks, mirrored, 1).why_whole, "the warp folds");
  EXPECT_EQ(judge_chunks(content, chunks, content_view(seen_from(kEye + dvec3(1, 0, 0))), wide_placement(),
                         kScreen, {1, warp::Curve::per, {}})
                .why_whole,
            "the warp is perspective");
  SpriteChunks many = chunks;
  const Affine2 carried;
  for (std::size_t k = 1; k < kMostChunkInstants; ++k)
    set_chunks(std::vector<int>{static_cast<int>(k)},
               chunk_instant(content, content_view(seen_from(kEye)), wide_placement(), carried, int(k)),
               many);
  EXPECT_EQ(many.instants.size(), kMostChunkInstants);
  EXPECT_EQ(judged(content, many, seen_from(kEye), 1).why_whole, "its chunks are of too many instants");
  content.deforms = true;
  EXPECT_EQ(judged(content, chunks, seen_from(kEye), 1).why_whole, "it deforms");
}

TEST(ChunkRefresh, WhatGrowsOverASideThatWasNotCutOffIsDrawnWhole) {
  // A wall of boxes of which one leaves to the right; the sprite ends where the wall ended.
  LayerContent content;
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 6; ++x)
      content.boxes.push_back(
          {x == 5 && y == 2 ? 1 : 0, {x - 3.0, y + 1.5, -10}, {x - 2.1, y + 2.4, -9.9}, 12});
  LayerState then = seen_from(kEye), now = then;
  then.world_from_part.push_back(layers::dmat4(1));
  now.world_from_part.push_back(glm::translate(layers::dmat4(1), dvec3(0.8, 0, 0)));
  SpritePlacement placement = wide_placement();
  placement.clipped = {};
  double right = 0;
  for (int y = 0; y < 5; ++y) right = std::max(right, on_display(then, {2.9, y + 2.4, -9.9}).x);
  placement.size_px.x = static_cast<int>(right) + 2 + 32;
  EXPECT_EQ(judged(content, drawn_at(content, then, placement), now, 1, placement).why_whole,
            "it outgrows its extents");
  placement.clipped.right = true;  // then that is for the visibility fiducial to say
  EXPECT_EQ(judged(content, drawn_at(content, then, placement), now, 1, placement).why_whole, "");
}

TEST(ChunkRefresh, AnEmptyLayerHasNothingToSay) {
  const LayerContent nothing;
  LayerState state = seen_from(kEye);
  const ChunkJudgement judgement = judged(nothing, drawn_at(nothing, state), state, 1);
  EXPECT_THAT(judgement.over, ::testing::IsEmpty());
  EXPECT_EQ(judgement.share.stored, 0);
  EXPECT_EQ(judgement.share.share(), 0);
}

TEST(ChunkRefresh, NumbersThatAreNoneBoundNothing) {
  const LayerContent content = ground();
  LayerState state = seen_from(kEye), broken = state;
  broken.camera.world_from_camera[3].y = std::nan("");
  EXPECT_NE(judged(content, drawn_at(content, state), broken, 1).why_whole, "");
}

TEST(SetChunks, InstantsThatNoChunkHasAreForgotten) {
  const LayerContent content = ground();
  const SpritePlacement placement = wide_placement();
  SpriteChunks chunks = drawn_at(content, seen_from(kEye));
  const auto instant = [&](int frame) {
    return chunk_instant(content, content_view(seen_from(kEye)), placement, {}, frame);
  };
  set_chunks(std::vector<int>{3, 4, 5}, instant(1), chunks);
  set_chunks(std::vector<int>{5, 6}, instant(2), chunks);
  ASSERT_EQ(chunks.instants.size(), 3u);
  chunks.drawn = {1, 1, 1};
  set_chunks(std::vector<int>{3, 4}, instant(3), chunks);
  ASSERT_EQ(chunks.instants.size(), 3u) << "that of frame 1 is gone";
  EXPECT_EQ(chunks.instants[1]->frame, 2);
  EXPECT_EQ(chunks.instants[2]->frame, 3);
  EXPECT_THAT(chunks.drawn, ::testing::ElementsAre(1, 1, 0));
  EXPECT_EQ(chunks.of_chunk[3], 2);
  EXPECT_EQ(chunks.of_chunk[6], 1);
  EXPECT_EQ(chunks.of_chunk[0], 0);
  std::vector<int> all(chunks.of_chunk.size());
  for (std::size_t c = 0; c < all.size(); ++c) all[c] = static_cast<int>(c);
  set_chunks(all, instant(4), chunks);
  EXPECT_EQ(chunks.instants.size(), 2u) << "the first stays: the grid is its own";
}

}  // namespace
}  // namespace talisman::regulator
