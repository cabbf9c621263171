// SPDX-License-Identifier: Apache-2.0
#include "chunker/sprite.h"

#include <random>

#include <gtest/gtest.h>

namespace talisman::chunker {
namespace {

Chunk filled(std::uint8_t v) {
  Chunk chunk;
  for (Texel& t : chunk.texels) t = {v, v, v, v};
  return chunk;
}

// One chunk, and one texel more and less: the border cases of rounding up.
TEST(Sprite, RoundsUpToWholeChunks) {
  EXPECT_EQ(Sprite({32, 32}).chunks(), layers::ivec2(1, 1));
  EXPECT_EQ(Sprite({31, 33}).chunks(), layers::ivec2(1, 2));
  EXPECT_EQ(Sprite({1, 0}).chunks(), layers::ivec2(1, 0));
  EXPECT_EQ(Sprite().chunks(), layers::ivec2(0, 0));
}

TEST(Sprite, ClearChunksAreNotStored) {
  Sprite sprite({96, 64});
  sprite.store(1, 0, filled(7));
  sprite.store(2, 1, Chunk{});
  EXPECT_EQ(sprite.stored_chunks(), 1);
  EXPECT_EQ(sprite.clear_chunks(), 5);
  EXPECT_EQ(sprite.bytes(), 4096 + 6 * 4);
  EXPECT_EQ(sprite.chunk(2, 1), nullptr);
  EXPECT_EQ(sprite.texel(33, 5), (Texel{7, 7, 7, 7}));
}

TEST(Sprite, TexelsOutsideAreClear) {
  Sprite sprite({32, 32});
  sprite.store(0, 0, filled(9));
  for (const layers::ivec2 p :
       {layers::ivec2(-1, 0), layers::ivec2(0, -1), layers::ivec2(32, 0), layers::ivec2(0, 32)})
    EXPECT_EQ(sprite.texel(p.x, p.y), Texel{}) << p.x << " " << p.y;
}

// Storing and clearing in random order moves chunks about in memory; a plain array is the oracle.
TEST(Sprite, RandomStoresAndClearsKeepTheOthers) {
  std::mt19937 random(20240607);
  Sprite sprite({5 * 32, 4 * 32});
  std::vector<int> expected(20, 0);
  for (int step = 0; step < 2000; ++step) {
    const int place = static_cast<int>(random() % 20), value = static_cast<int>(random() % 3);
    sprite.store(place % 5, place / 5, filled(static_cast<std::uint8_t>(value)));
    expected[place] = value;
    std::int64_t stored = 0;
    for (int i = 0; i < 20; ++i) {
      ASSERT_EQ(sprite.texel(i % 5 * 32 + 3, i / 5 * 32 + 31).a, expected[i])
          << "step " << step << " place " << i;
      stored += expected[i] != 0 ? 1 : 0;
    }
    ASSERT_EQ(sprite.stored_chunks(), stored);
  }
}

TEST(Sprite, AssembleEqualsStoring) {
  const std::vector<int> places{1, 2, 5};
  const std::vector<Chunk> chunks{filled(1), Chunk{}, filled(3)};
  const Sprite sprite = Sprite::assemble({96, 64}, places, chunks);
  EXPECT_EQ(sprite.texel(40, 0).r, 1);
  EXPECT_EQ(sprite.texel(95, 63).r, 3);
  EXPECT_EQ(sprite.stored_chunks(), 2);
}

TEST(SpriteDeathTest, AChunkOutsideIsAProgrammerMistake) {
  Sprite sprite({32, 32});
  EXPECT_DEATH(sprite.store(1, 0, Chunk{}), "check failed");
}

TEST(SpriteStore, KeepsOneSpritePerLayer) {
  SpriteStore store;
  EXPECT_EQ(store.find(3), nullptr);
  EXPECT_EQ(store.bytes(), 0);
  Sprite sprite({32, 32});
  sprite.store(0, 0, filled(1));
  store.put(3, sprite);
  ASSERT_NE(store.find(3), nullptr);
  EXPECT_EQ(store.find(2), nullptr);  // a gap, not a sprite
  EXPECT_EQ(store.find(-1), nullptr);
  EXPECT_EQ(store.bytes(), sprite.bytes());
  store.put(3, Sprite({0, 0}));
  EXPECT_EQ(store.bytes(), 0);
  store.drop(3);
  store.drop(99);
  EXPECT_EQ(store.find(3), nullptr);
}

}  // namespace
}  // namespace talisman::chunker
