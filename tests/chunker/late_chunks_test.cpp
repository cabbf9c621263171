// SPDX-License-Identifier: Apache-2.0
// Chunks that are drawn when they are first read hold the bytes of those drawn at once; what is not read is not drawn.
#include "chunker/late_chunks.h"

#include <cstring>
#include <optional>

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include "chunker/shadow_map.h"
#include "tests/chunker/composite_fixtures.h"
#include "tests/chunker/render_support.h"
#include "tests/support/scenes.h"

namespace talisman::chunker {
namespace {

using layers::ivec2;

constexpr ivec2 kLateScreen{150, 110};  // the last chunks are cut

struct BothWays {
  RenderResult at_once, late;
};

BothWays draw_both(const layers::Scene& scene, const RenderOptions& options = {}) {
  const PreparedScene prepared(scene);
  const auto placement = tests::display_placement(kLateScreen);
  const auto parts = tests::all_parts(scene);
  return {render(prepared, scene.at(0.3), parts, kLateScreen, placement, options),
          render_late(prepared, scene.at(0.3), parts, kLateScreen, placement, options)};
}

RenderCounters counted_late(const RenderResult& late) {
  RenderCounters sum = late.counters;
  return sum += late.sprite.late_chunks()->rest();
}

TEST(LateChunks, ReadBackwardsTheyAreThoseDrawnAtOnce) {
  for (const int samples : {1, 4, 16}) {
    RenderOptions options;
    options.samples = samples;
    const auto [at_once, late] = draw_both(talisman::tests::moving_scene(), options);
    ASSERT_NE(late.sprite.late_chunks(), nullptr);
    for (int row = late.sprite.chunks().y; row-- > 0;)
      for (int column = late.sprite.chunks().x; column-- > 0;) {
        EXPECT_EQ(late.sprite.opaque_blocks(column, row), at_once.sprite.opaque_blocks(column, row));
        const Chunk *chunk = late.sprite.chunk(column, row), *expected = at_once.sprite.chunk(column, row);
        ASSERT_EQ(chunk == nullptr, expected == nullptr) << column << " " << row;
        if (chunk != nullptr) {
          EXPECT_EQ(std::memcmp(chunk, expected, sizeof(Chunk)), 0) << column << " " << row;
        }
      }
  }
}

TEST(LateChunks, FragmentsThatOverflowAreDrawnInQuartersAsAtOnce) {
  RenderOptions options;
  options.max_fragments_per_chunk = 16;
  const auto [at_once, late] = draw_both(talisman::tests::moving_scene(), options);
  EXPECT_GT(at_once.counters.chunk_subdivisions, 0);
  tests::expect_same(late.sprite, at_once.sprite, "in quarters");
}

TEST(LateChunks, AllOfThemCountWhatIsCountedAtOnce) {
  const auto [at_once, late] = draw_both(talisman::tests::moving_scene());
  EXPECT_EQ(late.counters.pixels_filled, 0);
  EXPECT_GT(late.sprite.late_chunks()->count(), 0);
  tests::expect_same(late.sprite, at_once.sprite, "all");
  EXPECT_EQ(counted_late(late), at_once.counters);
  EXPECT_EQ(late.sprite.late_chunks()->rest(), RenderCounters{}) << "nothing is counted twice";
}

TEST(LateChunks, ManyReadersOfOneChunkSeeTheSameBytes) {
  // A wide sprite of few chunks, all read by every task: most find a chunk that another one draws.
  const BothWays both = draw_both(talisman::tests::displaced_sphere_scene(20000));
  const RenderResult &late = both.late, &at_once = both.at_once;  // bindings cannot be captured
  tbb::parallel_for(0, 64, [&](int) {
    for (int row = 0; row < late.sprite.chunks().y; ++row)
      for (int column = 0; column < late.sprite.chunks().x; ++column) {
        const Chunk *chunk = late.sprite.chunk(column, row), *expected = at_once.sprite.chunk(column, row);
        const bool same = (chunk == nullptr) == (expected == nullptr) &&
                          (chunk == nullptr || std::memcmp(chunk, expected, sizeof(Chunk)) == 0);
        if (!same) ADD_FAILURE() << column << " " << row;
      }
  });
  EXPECT_EQ(counted_late(late), at_once.counters) << "a chunk is drawn once";
}

TEST(LateChunks, OutliveTheTexturesThatTheyWereSetUpWith) {
  const layers::Scene scene = talisman::tests::textured_quad_scene();
  std::optional<PreparedScene> prepared(scene);
  const auto placement = tests::display_placement(kLateScreen);
  const auto parts = tests::all_parts(scene);
  const Sprite at_once = render(*prepared, scene.at(0), parts, kLateScreen, placement).sprite;
  const Sprite late = render_late(*prepared, scene.at(0), parts, kLateScreen, placement).sprite;
  prepared.reset();
  tests::expect_same(late, at_once, "textures gone");
}

TEST(LateChunks, SpriteThatLooksUpShadowsIsDrawnAtOnce) {
  // Maps are drawn anew when casters move: what is drawn from them later would be the shadow of another time.
  const layers::Scene scene = talisman::tests::moving_scene();
  const PreparedScene prepared(scene);
  const std::vector<int> casters = tests::all_parts(scene);
  const ShadowMap map = make_shadow_map(scene.at(0), 1, casters, {});
  const std::vector<const ShadowMap*> maps{nullptr, &map};
  ShadeInputs inputs;
  inputs.shadow_maps = maps;
  const RenderResult result = render_late(prepared, scene.at(0), casters, kLateScreen,
                                          tests::display_placement(kLateScreen), {}, inputs);
  EXPECT_EQ(result.sprite.late_chunks(), nullptr);
}

TEST(LateChunks, EmptyPlacementIsAnEmptySprite) {
  const layers::Scene scene = talisman::tests::cube_scene();
  const PreparedScene prepared(scene);
  const RenderResult result = render_late(prepared, scene.at(0), tests::all_parts(scene), kLateScreen, {});
  EXPECT_EQ(result.sprite.size_px(), ivec2(0, 0));
  EXPECT_EQ(result.sprite.stored_chunks(), 0);
}

TEST(DrawLateChunks, WhatLiesOutsideTheDisplayIsNotDrawn) {
  // Moved by 4 chunks to the left: of 5 columns the last remains, of 22 texels.
  const auto [at_once, late] = draw_both(talisman::tests::textured_quad_scene());
  const std::vector<PlacedSprite> stack{placed(late.sprite, translation(-128, 0))};
  draw_late_chunks(stack, kLateScreen);
  const RenderCounters drawn = counted_late(late);
  EXPECT_GT(at_once.counters.chunks_rendered, 4 * drawn.chunks_rendered);
  const Frame frame = composite(stack, kLateScreen, {}).frame;
  EXPECT_EQ(late.sprite.late_chunks()->rest(), RenderCounters{}) << "all that is composited was drawn before";
  EXPECT_EQ(
      difference(frame,
                 composite(std::vector{placed(at_once.sprite, translation(-128, 0))}, kLateScreen, {}).frame),
      "");
}

TEST(DrawLateChunks, WhatLiesBehindOpaqueTexelsIsNotDrawn) {
  const Sprite wall = make_sprite(kLateScreen, [](int x, int) {
    return x < 96 ? Texel{9, 8, 7, 255} : Texel{};
  });
  const auto [at_once, late] = draw_both(talisman::tests::textured_quad_scene());
  std::vector<PlacedSprite> stack{placed(late.sprite, dmat3(1)), placed(wall, dmat3(1))};
  draw_late_chunks(stack, kLateScreen);
  // Tiles 0 … 2 of a line are hidden; tile 3 reads the column of texels before its own, too, of chunk column 2.
  const RenderCounters drawn = counted_late(late);
  EXPECT_GT(drawn.chunks_rendered, 0);
  EXPECT_LE(drawn.chunks_rendered + drawn.chunks_clear,
            3 * late.sprite.chunks().y + late.counters.chunks_clear);
  const Frame frame = composite(stack, kLateScreen, {}).frame;
  stack[0].sprite = &at_once.sprite;
  EXPECT_EQ(difference(frame, composite(stack, kLateScreen, {}).frame), "");
}

TEST(DrawLateChunks, AnyMapCompositesAsIfAllWasDrawn) {
  for (const dmat3& map :
       {affine(0.7, -0.7, 60, 0.7, 0.7, -20), affine(-1, 0, 140, 0, 1, 0.5), affine(0.2, 0, 3, 0, 0.2, 4),
        affine(3, 0, -100, 0, 3, -120), affine(1, 1, 0, 1, 1.001, 0)}) {
    for (const double w : {0.0, 2e-3}) {
      dmat3 perspective = map;
      perspective[0][2] = w;
      const auto [at_once, late] = draw_both(talisman::tests::moving_scene());
      const std::vector<PlacedSprite> stack{placed(late.sprite, perspective), placed(late.sprite, map)},
          expected{placed(at_once.sprite, perspective), placed(at_once.sprite, map)};
      draw_late_chunks(stack, kLateScreen);
      late.sprite.late_chunks()->rest();
      const Frame frame = composite(stack, kLateScreen, {}).frame;
      EXPECT_EQ(difference(frame, composite(expected, kLateScreen, {}).frame), "");
      EXPECT_EQ(late.sprite.late_chunks()->rest(), RenderCounters{})
          << "the compositor found a chunk not drawn";
    }
  }
}

}  // namespace
}  // namespace talisman::chunker
