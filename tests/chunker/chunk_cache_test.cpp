// SPDX-License-Identifier: Apache-2.0
#include "chunker/chunk_cache.h"

#include <algorithm>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace talisman::chunker {
namespace {

/// Every chunk is stored.
CompressedSprite full_sprite(layers::ivec2 chunks) {
  Sprite sprite(chunks * kChunkSize);
  Chunk chunk;
  for (Texel& t : chunk.texels) t = {9, 9, 9, 255};
  for (int row = 0; row < chunks.y; ++row)
    for (int column = 0; column < chunks.x; ++column) sprite.store(column, row, chunk);
  return compress(sprite, {});
}

layers::dmat3 shifted(double x, double y) {
  layers::dmat3 m(1.0);
  m[2] = {x, y, 1};
  return m;
}

CacheCounters reads(const CompressedSprite& sprite, const layers::dmat3& map, layers::ivec2 display,
                    int capacity) {
  ChunkCache cache(capacity);
  const PlacedCompressed placed{&sprite, map};
  touch_chunks({&placed, 1}, display, cache);
  return cache.counters();
}

TEST(ChunkCache, TheChunkThatWasUsedLongestAgoGoes) {
  ChunkCache cache(2);
  cache.touch(0, 1, 100);
  cache.touch(0, 2, 100);
  cache.touch(0, 1, 100);  // hit: 2 is now the older one
  cache.touch(0, 3, 100);  // 2 goes
  cache.touch(0, 1, 100);  // hit
  cache.touch(0, 2, 100);  // miss
  EXPECT_EQ(cache.counters(), (CacheCounters{2, 4, 400}));
  EXPECT_DOUBLE_EQ(cache.counters().hit_rate(), 2.0 / 6);
}

TEST(ChunkCache, ChunksOfOtherSpritesAreOthers) {
  ChunkCache cache(8);
  cache.touch(0, 1, 10);
  cache.touch(1, 0, 10);
  cache.touch(1, 1, 10);
  EXPECT_EQ(cache.counters().misses, 3);
}

TEST(ChunkCache, WithoutRoomEveryAccessIsAMiss) {
  ChunkCache cache(0);
  for (int i = 0; i < 3; ++i) cache.touch(0, 0, 7);
  EXPECT_EQ(cache.counters(), (CacheCounters{0, 3, 21}));
  EXPECT_EQ(ChunkCache(4).counters().hit_rate(), 0);
}

// A list that is searched from its end is the oracle.
TEST(ChunkCache, RandomAccessesEqualAPlainList) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    const int capacity = static_cast<int>(random() % 9);
    ChunkCache cache(capacity);
    std::vector<int> used;
    std::int64_t hits = 0;
    for (int i = 0; i < 500; ++i) {
      const int chunk = static_cast<int>(random() % 12);
      cache.touch(3, chunk, 1);
      const auto at = std::find(used.begin(), used.end(), chunk);
      hits += at != used.end();
      if (at != used.end()) used.erase(at);
      used.push_back(chunk);
      if (static_cast<int>(used.size()) > capacity) used.erase(used.begin());
    }
    ASSERT_EQ(cache.counters().hits, hits) << "seed " << seed;
    ASSERT_EQ(cache.counters().hits + cache.counters().misses, 500);
    ASSERT_EQ(cache.counters().bytes_read, cache.counters().misses);
  }
}

TEST(TouchChunks, TexelOnPixelReadsTheTileItsRightAndItsLowerNeighbours) {
  // The bilinear footprint of a tile's last pixel is one texel further: 2 × 2 chunks but at the sprite's end.
  const CompressedSprite sprite = full_sprite({4, 4});
  const CacheCounters c = reads(sprite, shifted(0, 0), {128, 128}, 1000);
  EXPECT_EQ(c.hits + c.misses, (3 * 2 + 1) * (3 * 2 + 1));
  EXPECT_EQ(c.misses, 16) << "each chunk is fetched once when all have room";
  EXPECT_EQ(c.bytes_read, sprite.bytes() - 16 * 4);
}

TEST(TouchChunks, ASmallCacheFetchesARowAgainForTheNextBand) {
  const CompressedSprite sprite = full_sprite({4, 4});
  // Two columns and rows fit, a row of the sprite does not.
  const CacheCounters small = reads(sprite, shifted(0, 0), {128, 128}, 4);
  EXPECT_GT(small.misses, 16);
  EXPECT_GT(small.hits, 0) << "the neighbour to the right is the next tile's own";
  EXPECT_EQ(small.hits + small.misses, 49);
}

TEST(TouchChunks, MoreRoomNeverReadsMore) {
  const CompressedSprite sprite = full_sprite({5, 6});
  layers::dmat3 turned(1.0);
  turned[0] = {0.8, 0.6, 0};
  turned[1] = {-0.6, 0.8, 0};
  turned[2] = {60, -20, 1};
  std::int64_t misses = std::numeric_limits<std::int64_t>::max();
  for (const int capacity : {0, 1, 2, 4, 8, 16, 32}) {
    const CacheCounters c = reads(sprite, turned, {200, 170}, capacity);
    EXPECT_LE(c.misses, misses) << capacity;
    misses = c.misses;
  }
  EXPECT_GT(misses, 0);
}

TEST(TouchChunks, ClearChunksAndSpritesBesideTheDisplayAskForNothing) {
  const CompressedSprite clear = compress(Sprite({96, 96}), {});
  EXPECT_EQ(reads(clear, shifted(0, 0), {96, 96}, 8), CacheCounters{});
  const CompressedSprite full = full_sprite({1, 1});
  for (const double away : {-33.0, 97.0, 1e9, -1e300})
    EXPECT_EQ(reads(full, shifted(away, 0), {96, 96}, 8), CacheCounters{}) << away;
  EXPECT_EQ(reads(full, shifted(0, 0), {0, 0}, 8), CacheCounters{});
}

TEST(TouchChunks, MapsThatShowNothingAskForNothing) {
  const CompressedSprite sprite = full_sprite({2, 2});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  layers::dmat3 singular(0.0), broken(1.0), behind(1.0);
  broken[0][0] = nan;
  behind[2] = {0, 0, -1};
  for (const layers::dmat3& map : {singular, broken, behind})
    EXPECT_EQ(reads(sprite, map, {64, 64}, 8), CacheCounters{});
}

TEST(TouchChunks, TheSpriteBehindComesFirstInEachBand) {
  // Two sprites of a chunk on each other: with room for one chunk, each band reads both again.
  const CompressedSprite a = full_sprite({1, 2}), b = full_sprite({1, 2});
  ChunkCache cache(1);
  const PlacedCompressed placed[] = {{&a, shifted(0, 0)}, {&b, shifted(0, 0)}};
  touch_chunks(placed, {32, 64}, cache);
  // Band 0 touches chunks 0 and 1 of a, then of b; band 1 chunk 1 of a, then of b. Nothing is ever still
  // there.
  EXPECT_EQ(cache.counters().misses, 6);
  EXPECT_EQ(cache.counters().hits, 0);
}

}  // namespace
}  // namespace talisman::chunker
