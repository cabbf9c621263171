// SPDX-License-Identifier: Apache-2.0
// Which of the author's pairs can be kept together: against the obvious way, one pair after the other.
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "layers/visibility_order.h"

namespace talisman::layers {
namespace {

/// Every pair is tried on its own against those kept before it.
std::vector<ExplicitPair> kept_one_by_one(const std::vector<ExplicitPair>& pairs,
                                          const std::vector<int>& groups) {
  std::vector<ExplicitPair> kept;
  for (const ExplicitPair& p : pairs) {
    const int behind = groups[p.behind], front = groups[p.front];
    if (behind == kAbsent || front == kAbsent || p.behind == p.front || behind > front) continue;
    if (!leads_to(kept, p.front, p.behind)) kept.push_back(p);
  }
  return kept;
}

TEST(ExplicitPairs, AreKeptAsIfTriedOneByOne) {
  std::mt19937 random(7);
  int with_cycles = 0, without = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const int layers = 1 + static_cast<int>(random() % 12);
    std::vector<int> groups;
    for (int id = 0; id < layers; ++id)
      groups.push_back(random() % 6 == 0 ? kAbsent : static_cast<int>(random() % 2));
    std::vector<ExplicitPair> pairs;
    for (std::size_t k = random() % 20; k > 0; --k)
      pairs.push_back({static_cast<int>(random() % layers), static_cast<int>(random() % layers)});
    const KeptPairs kept = keep_pairs(pairs, [&](int layer) { return groups[layer]; });
    ASSERT_EQ(kept.pairs, kept_one_by_one(pairs, groups)) << "trial " << trial;
    (cyclic_core(pairs).empty() ? without : with_cycles) += 1;
  }
  EXPECT_GT(with_cycles, 200);
  EXPECT_GT(without, 200);
}

TEST(ExplicitPairs, OnlyWhatLiesOnACycleOrBetweenTwoIsOfItsCore) {
  EXPECT_TRUE(cyclic_core({}).empty());
  const std::vector<ExplicitPair> line{{0, 1}, {1, 2}, {0, 2}, {2, 9}, {0, 1}};
  EXPECT_TRUE(cyclic_core(line).empty());
  std::vector<ExplicitPair> ring = line;
  ring.push_back({9, 1});
  EXPECT_EQ(cyclic_core(ring), (std::vector<char>{0, 1, 1, 0, 0, 0, 0, 0, 0, 1}));
  const std::vector<ExplicitPair> self{{3, 3}};
  EXPECT_EQ(cyclic_core(self), (std::vector<char>{0, 0, 0, 1}));
  const std::vector<ExplicitPair> two{{0, 1}, {1, 0}, {1, 2}, {2, 3}, {3, 4}, {4, 3}, {4, 5}};
  EXPECT_EQ(cyclic_core(two), (std::vector<char>{1, 1, 1, 1, 1, 0}));
}

TEST(ExplicitPairs, WhatContradictsTheGroupsClosesNoCycle) {
  // 1 is before 0 by its group; the pair that says otherwise is left out, and the one after it is kept.
  const std::vector<ExplicitPair> pairs{{1, 0}, {0, 1}};
  const std::vector<int> groups{-1, 0};
  const KeptPairs kept = keep_pairs(pairs, [&](int layer) { return groups[layer]; });
  EXPECT_EQ(kept.pairs, (std::vector<ExplicitPair>{{0, 1}}));
  EXPECT_EQ(kept.defect, "explicit pair: layer 1 behind layer 0 contradicts the groups of the two");
}

}  // namespace
}  // namespace talisman::layers
