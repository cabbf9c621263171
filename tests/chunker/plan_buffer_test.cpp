// SPDX-License-Identifier: Apache-2.0
// Buffers with depth: joins texel by texel, against a join that is written out, and counters by hand.
#include "chunker/plan_buffer.h"

#include <random>

#include <gtest/gtest.h>

namespace talisman::chunker {
namespace {

constexpr int kTexels = kChunkSize * kChunkSize;

struct Picture {
  Chunk color{};
  DepthChunk depth{};
};

/// Few different depths and numbers, so that all are met: clear texels, equal depths, equal numbers.
Picture random_picture(std::mt19937& random) {
  Picture picture;
  picture.depth.clear();
  for (int i = 0; i < kTexels; ++i) {
    const unsigned roll = random();
    if (roll % 5 == 0) continue;
    picture.depth.z[i] = 0.25f * static_cast<float>(1 + roll / 8 % 3);
    picture.depth.part[i] = roll / 64 % 4;
    const auto byte = [&](int shift) { return static_cast<std::uint8_t>(roll >> shift); };
    picture.color.texels[i] = {byte(8), byte(16), byte(24), 255};
  }
  return picture;
}

void expect_joined(const Picture& a, const Picture& b, const Picture& joined) {
  for (int i = 0; i < kTexels; ++i) {
    const bool take =
        b.depth.z[i] > a.depth.z[i] || (b.depth.z[i] == a.depth.z[i] && b.depth.part[i] < a.depth.part[i]);
    const Picture& seen = take ? b : a;
    ASSERT_EQ(joined.color.texels[i], seen.color.texels[i]) << i;
    ASSERT_EQ(joined.depth.z[i], seen.depth.z[i]) << i;
    ASSERT_EQ(joined.depth.part[i], seen.depth.part[i]) << i;
  }
}

TEST(JoinChunks, TheNearerIsSeenAndAtEqualDepthTheLowerNumber) {
  std::mt19937 random(18);
  for (int trial = 0; trial < 50; ++trial) {
    const Picture a = random_picture(random), b = random_picture(random);
    Picture joined = a;
    join_chunks(b.color, b.depth, joined.color, joined.depth);
    expect_joined(a, b, joined);
  }
}

// Groups of texels of which none is seen, all are, or all are at equal depth: those are joined without looking at all of it.
TEST(JoinChunks, GroupsThatAreAllBehindBeforeOrEqualAreJoinedAsOneTexelIs) {
  std::mt19937 random(20);
  for (int trial = 0; trial < 50; ++trial) {
    Picture a = random_picture(random), b = random_picture(random);
    for (int group = 0; group < kTexels; group += 4)
      for (int i = group; i < group + 4; ++i) {
        const int kind = (group >> (2 + trial % 4)) % 4;
        if (kind == 0) b.depth.z[i] = a.depth.z[i] / 2;
        if (kind == 1) b.depth.z[i] = a.depth.z[i] + 1;
        if (kind == 2) b.depth.z[i] = a.depth.z[i];
      }
    Picture joined = a;
    join_chunks(b.color, b.depth, joined.color, joined.depth);
    expect_joined(a, b, joined);
  }
}

// Of a picture that ends inside its second chunk: what lies beyond is not of it.
TEST(PlanBuffer, EdgesAreTexelsOfThePictureThatAreCoveredInPart) {
  PlanBuffer buffer({kChunkSize + 3, 2});
  Picture picture;
  picture.color.texels[0].a = 1;                 // counts
  picture.color.texels[1].a = 255;               // covered
  picture.color.texels[2].a = 254;               // counts in the first chunk and in the second
  picture.color.texels[3].a = 7;                 // in the first chunk alone
  picture.color.texels[kChunkSize].a = 128;      // second row: counts
  picture.color.texels[2 * kChunkSize].a = 128;  // below the picture
  EXPECT_EQ(buffer.edge_texels(), 0);
  buffer.put(0, picture.color, picture.depth);
  EXPECT_EQ(buffer.edge_texels(), 4);
  buffer.put(1, picture.color, picture.depth);
  EXPECT_EQ(buffer.edge_texels(), 4 + 3);
}

TEST(PlanBuffer, JoinsInAnyOrderShowTheSame) {
  std::mt19937 random(19);
  std::vector<Picture> pictures;
  for (int i = 0; i < 4; ++i) {
    pictures.push_back(random_picture(random));
    for (std::uint32_t& part : pictures.back().depth.part)
      if (part < 4) part = 4 * part + static_cast<std::uint32_t>(i);  // a part is in one buffer
  }
  std::vector<int> order = {0, 1, 2, 3};
  std::vector<Texel> first;
  do {
    PlanBuffer sum({kChunkSize, kChunkSize});
    JoinCounters counters;
    for (const int i : order) {
      PlanBuffer one({kChunkSize, kChunkSize});
      one.put(0, pictures[i].color, pictures[i].depth);
      sum.join(one, counters);
    }
    const std::vector<Texel> texels(sum.color(0)->texels, sum.color(0)->texels + kTexels);
    if (first.empty()) first = texels;
    ASSERT_EQ(texels, first);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(PlanBuffer, ClearChunksTakeNoMemoryAndAreNotCompared) {
  std::mt19937 random(20);
  const Picture picture = random_picture(random);
  // 3 × 2 chunks, the last column one texel wide.
  PlanBuffer a({65, 40}), b({65, 40});
  EXPECT_TRUE(a.is_clear());
  EXPECT_EQ(a.bytes(), 6 * 4);
  a.put(1, picture.color, picture.depth);
  b.put(1, picture.color, picture.depth);
  b.put(5, picture.color, picture.depth);
  EXPECT_EQ(a.bytes(), 6 * 4 + 1024 * 12);
  JoinCounters counters;
  a.join(b, counters);
  EXPECT_EQ(counters, (JoinCounters{1, 1024, 1024, 0, 4 * 1024}));
  PlanBuffer copy({65, 40});
  counters = {};
  copy.copy(a, counters);
  EXPECT_EQ(counters, (JoinCounters{0, 0, 2 * 1024, 0, 0}));
  EXPECT_EQ(copy.sprite().texel(40, 3), a.sprite().texel(40, 3));
  EXPECT_EQ(copy.color(0), nullptr);
  counters = {};
  copy.clear(counters);
  EXPECT_EQ(counters, (JoinCounters{0, 0, 0, 2 * 1024, 0}));
  EXPECT_TRUE(copy.is_clear());
  EXPECT_EQ(copy.bytes(), 6 * 4);
}

TEST(PlanBuffer, EmptyAndMinimalDisplays) {
  JoinCounters counters;
  PlanBuffer none({0, 0}), one({1, 1});
  none.join(PlanBuffer({0, 0}), counters);
  EXPECT_EQ(one.chunks(), layers::ivec2(1, 1));
  EXPECT_EQ(one.sprite().size_px(), layers::ivec2(1, 1));
  EXPECT_EQ(one.sprite().stored_chunks(), 0);
}

}  // namespace
}  // namespace talisman::chunker
