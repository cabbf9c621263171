// SPDX-License-Identifier: Apache-2.0
// Some chunks of a sprite hold the bytes of the whole, and can take the place of others.
#include <cstring>

#include <gtest/gtest.h>

#include "chunker/late_chunks.h"
#include "chunker/render.h"
#include "tests/chunker/render_support.h"
#include "tests/support/scenes.h"

namespace talisman::chunker {
namespace {

constexpr layers::ivec2 kPartScreen{150, 110};  // the last chunks are cut

RenderedChunks some_chunks(const layers::Scene& scene, double time_s, const std::vector<int>& places) {
  const PreparedScene prepared(scene);
  return render_chunks(prepared, scene.at(time_s), tests::all_parts(scene), kPartScreen,
                       tests::display_placement(kPartScreen), places);
}

RenderResult all_chunks(const layers::Scene& scene, double time_s, bool late = false) {
  const PreparedScene prepared(scene);
  return (late ? render_late : render)(prepared, scene.at(time_s), tests::all_parts(scene), kPartScreen,
                                       tests::display_placement(kPartScreen), {}, {});
}

const std::vector<int> kSomePlaces{0, 3, 7, 8, 12, 19};

TEST(RenderChunks, TheyHoldTheBytesOfTheWhole) {
  const layers::Scene scene = talisman::tests::moving_scene();
  const RenderedChunks some = some_chunks(scene, 0.3, kSomePlaces);
  const RenderResult all = all_chunks(scene, 0.3);
  ASSERT_EQ(some.places, kSomePlaces);
  ASSERT_EQ(some.chunks.size(), kSomePlaces.size());
  std::int64_t stored = 0;
  for (std::size_t i = 0; i < some.places.size(); ++i) {
    const Chunk* expected = all.sprite.chunk(some.places[i] % 5, some.places[i] / 5);
    EXPECT_EQ(is_clear_chunk(some.chunks[i]), expected == nullptr);
    stored += expected != nullptr;
    if (expected != nullptr) {
      EXPECT_EQ(std::memcmp(&some.chunks[i], expected, sizeof(Chunk)), 0) << some.places[i];
    }
  }
  EXPECT_EQ(some.counters.chunks_rendered, stored);
  EXPECT_EQ(some.counters.chunks_clear, static_cast<std::int64_t>(kSomePlaces.size()) - stored);
  EXPECT_EQ(some.counters.polygons_in, all.counters.polygons_in);
  EXPECT_LT(some.counters.pixels_filled, all.counters.pixels_filled);
}

TEST(RenderChunks, NoneIsNothing) {
  const RenderedChunks none = some_chunks(talisman::tests::moving_scene(), 0.3, {});
  EXPECT_TRUE(none.chunks.empty());
  EXPECT_EQ(none.counters.pixels_filled, 0);
}

TEST(ReplacedChunks, AreShownWhereTheyWereReplacedAndNowhereElse) {
  const layers::Scene scene = talisman::tests::moving_scene();
  for (const bool late : {false, true}) {
    SpriteStore store;
    store.put(2, all_chunks(scene, 0.3, late).sprite);
    const RenderResult before = all_chunks(scene, 0.3), after = all_chunks(scene, 3.1);
    for (const double time_s : {1.7, 3.1}) {  // replaced twice
      const RenderedChunks some = some_chunks(scene, time_s, kSomePlaces);
      store.replace(2, some.places, some.chunks);
    }
    const Sprite& mixed = *store.find(2);
    for (int place = 0; place < 20; ++place) {
      const bool is_replaced = std::count(kSomePlaces.begin(), kSomePlaces.end(), place) > 0;
      const Sprite& expected = (is_replaced ? after : before).sprite;
      EXPECT_EQ(mixed.opaque_blocks(place % 5, place / 5), expected.opaque_blocks(place % 5, place / 5));
      for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x) {
          const int px = place % 5 * 32 + x, py = place / 5 * 32 + y;
          ASSERT_EQ(mixed.texel(px, py), expected.texel(px, py)) << late << " " << place;
        }
    }
    if (!late) {
      EXPECT_EQ(store.bytes(), mixed.bytes());
    }
  }
}

TEST(ReplacedChunks, AClearOneTakesThePlaceOfAnother) {
  const layers::Scene scene = talisman::tests::moving_scene();
  for (const bool late : {false, true}) {
    SpriteStore store;
    store.put(0, all_chunks(scene, 0.3, late).sprite);
    const std::vector<int> places{12};
    const Chunk clear{};
    ASSERT_TRUE(store.find(0)->may_hold(2, 2));
    store.replace(0, places, {&clear, 1});
    EXPECT_EQ(store.find(0)->texel(70, 70), Texel{});
    EXPECT_EQ(store.find(0)->opaque_blocks(2, 2), 0);
    const RenderedChunks some = some_chunks(scene, 0.3, places);
    store.replace(0, places, some.chunks);
    store.replace(0, places, {&clear, 1});  // of one that was replaced
    EXPECT_EQ(store.find(0)->texel(70, 70), Texel{});
    store.replace(0, places, some.chunks);
    EXPECT_EQ(store.find(0)->texel(70, 70), all_chunks(scene, 0.3).sprite.texel(70, 70));
  }
}

}  // namespace
}  // namespace talisman::chunker
