// SPDX-License-Identifier: Apache-2.0
// Levels in memory by hand, and against a simulator that is slow and obvious.
#include "regulator/memory/level_cache.h"

#include <algorithm>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

namespace talisman::regulator {
namespace {

using Bytes = std::int64_t;
using Wants = std::vector<LevelWant>;

TEST(LevelCache, CoarseLevelsAreReadFirstAndOfTheseTheSoonest) {
  LevelCache cache({{10, 20}, {10, 20}, {10}}, 1000);
  // 0 and 1 are seen with two levels, 2 may be in three frames: 10 + 10 + 10 first, then the fine ones.
  const Wants seen = {{0, 1, 0}, {1, 1, 0}}, ahead = {{2, 0, 3}};
  MemoryFrame frame = cache.step(seen, ahead, 25);
  EXPECT_EQ(frame.read_bytes, 25);
  EXPECT_EQ(cache.resident_levels(0), 1);
  EXPECT_EQ(cache.resident_levels(1), 1);
  EXPECT_EQ(cache.resident_levels(2), 0) << "5 of its 10 bytes came through";
  EXPECT_EQ(frame.resident_bytes, 30) << "its room is taken";
  EXPECT_EQ(frame.skipped_levels, 2);
  frame = cache.step(seen, ahead, 25);
  EXPECT_EQ(cache.resident_levels(2), 1);
  EXPECT_EQ(cache.drawn(), (std::vector<int>{1, 0}));
  EXPECT_EQ(frame.skipped_levels, 1);
  frame = cache.step(seen, ahead, 25);
  EXPECT_EQ(frame.read_bytes, 20) << "no more is wanted";
  EXPECT_EQ(frame.skipped_levels, 0);
  EXPECT_EQ(frame.resident_bytes, 70);
}

TEST(LevelCache, WhatWasWantedLongestAgoGoesFirst) {
  LevelCache cache({{10}, {10}, {10}, {10}}, 30);
  cache.step(Wants{{0, 0, 0}}, {}, 1000);
  cache.step(Wants{{1, 0, 0}}, {}, 1000);
  cache.step(Wants{{2, 0, 0}}, {}, 1000);
  cache.step({}, Wants{{0, 0, 5}}, 1000);  // looked ahead again
  const MemoryFrame frame = cache.step(Wants{{3, 0, 0}}, {}, 1000);
  EXPECT_EQ(frame.released_bytes, 10);
  EXPECT_EQ(cache.resident_levels(0), 1);
  EXPECT_EQ(cache.resident_levels(1), 0);
  EXPECT_EQ(cache.resident_levels(2), 1);
  EXPECT_EQ(frame.wasted_bytes, 0) << "it was drawn";
}

TEST(LevelCache, OfOneFrameTheLatestGoesFirstAndOfOneItemTheFinest) {
  LevelCache cache({{10, 10}, {10}, {10}}, 30);
  cache.step({}, Wants{{1, 0, 1}, {0, 1, 2}}, 1000);
  EXPECT_EQ(cache.resident_bytes(), 30);
  const MemoryFrame frame = cache.step(Wants{{2, 0, 0}}, {}, 1000);
  EXPECT_EQ(cache.resident_levels(0), 1);
  EXPECT_EQ(cache.resident_levels(1), 1);
  EXPECT_EQ(frame.wasted_bytes, 10) << "it never was drawn";
}

TEST(LevelCache, OneByteTooFewLeavesTheFineLevelOut) {
  for (const Bytes limit : {59, 60}) {
    LevelCache cache({{10, 20}, {10, 20}}, limit);
    const MemoryFrame frame = cache.step(Wants{{0, 1, 0}, {1, 1, 0}}, {}, 1000);
    EXPECT_EQ(frame.skipped_levels, limit == 59 ? 1 : 0);
    EXPECT_EQ(frame.resident_bytes, limit == 59 ? 40 : 60);
    EXPECT_EQ(frame.wanted_bytes, 60);
  }
}

TEST(LevelCache, WithoutMemoryNothingIsDrawnAndNothingHangs) {
  LevelCache cache({{10, 20}, {0}}, 0);
  const MemoryFrame frame = cache.step(Wants{{0, 1, 0}, {1, 0, 0}}, Wants{{0, 0, 1}}, 1000);
  EXPECT_EQ(cache.drawn(), (std::vector<int>{-1, 0})) << "what takes no room fits";
  EXPECT_EQ(frame.skipped_levels, 2);
  EXPECT_EQ(frame.skipped_items, 1);
  EXPECT_EQ(frame.read_bytes, 0);
}

TEST(LevelCache, WithoutBandwidthNothingIsReadButWhatHasNoBytes) {
  LevelCache cache({{10}, {0, 0, 1}}, 100);
  const MemoryFrame frame = cache.step(Wants{{0, 0, 0}, {1, 2, 0}}, {}, 0);
  EXPECT_EQ(frame.read_bytes, 0);
  EXPECT_EQ(frame.resident_bytes, 0);
  EXPECT_EQ(frame.skipped_levels, 4);
}

TEST(LevelCache, AReadThatIsNoLongerWantedIsGivenUp) {
  LevelCache cache({{100}, {10}}, 100);
  cache.step(Wants{{0, 0, 0}}, {}, 60);
  const MemoryFrame frame = cache.step(Wants{{1, 0, 0}}, {}, 60);
  EXPECT_EQ(frame.wasted_bytes, 60);
  EXPECT_EQ(frame.skipped_levels, 0);
  EXPECT_EQ(cache.resident_bytes(), 10);
}

TEST(LevelCache, WhatIsSharedIsReadOnceAndSkippedByEachThatWantsIt) {
  LevelCache cache({{10, 20, 40}}, 100);
  MemoryFrame frame = cache.step(Wants{{0, 2, 0}, {0, 1, 0}}, {}, 10);
  EXPECT_EQ(frame.skipped_levels, 3);
  EXPECT_EQ(frame.wanted_bytes, 70);
  frame = cache.step(Wants{{0, 2, 0}, {0, 1, 0}}, {}, 20);
  EXPECT_EQ(cache.drawn(), (std::vector<int>{1, 1}));
}

/// The same rules without a clever thing: sets of pairs, and a search through all of them for each decision.
class SlowCache {
 public:
  using Pair = std::pair<int, int>;
  SlowCache(std::vector<std::vector<Bytes>> bytes, Bytes limit) : bytes_(std::move(bytes)), limit_(limit) {}

  std::pair<int, Bytes> step(const Wants& seen, const Wants& ahead, Bytes budget) {
    ++frame_;
    claimed_.clear();
    claim_all(seen, ahead);
    if (under_way_ && !claimed_.count(*under_way_)) under_way_.reset();
    while (true) {
      if (!under_way_) {
        under_way_ = next_read();
        if (!under_way_) break;
        left_ = of(*under_way_);
        if (budget == 0 && left_ > 0) {
          under_way_.reset();
          break;
        }
        while (used() > limit_) release_one();
      }
      const Bytes now = std::min(budget, left_);
      budget -= now, left_ -= now;
      if (left_ > 0) break;
      there_.insert(*under_way_);
      under_way_.reset();
    }
    int skipped = 0;
    for (const LevelWant& want : seen) {
      int best = -1;
      while (best < want.level && there_.count({want.item, best + 1})) ++best;
      skipped += want.level - best;
    }
    return {skipped, used()};
  }
  int levels(int item) const {
    return static_cast<int>(
        std::count_if(there_.begin(), there_.end(), [&](const Pair& p) { return p.first == item; }));
  }

 private:
  Bytes of(const Pair& p) const { return bytes_[p.first][p.second]; }
  Bytes used() const {
    Bytes sum = under_way_ ? of(*under_way_) : 0;
    for (const Pair& p : there_) sum += of(p);
    return sum;
  }
  bool claim(const Pair& p, int soonest) {
    if (claimed_.count(p)) return true;
    Bytes sum = of(p);
    for (const auto& [q, key] : claimed_) sum += of(q);
    if (sum > limit_) return false;
    const int rank = static_cast<int>(claimed_.size());
    claimed_[p] = {p.second, soonest, rank};
    last_[p] = {frame_, -rank};
    return true;
  }
  void claim_all(const Wants& seen, const Wants& ahead) {
    std::set<int> full;
    for (int level = 0; level < 10; ++level)
      for (const LevelWant& want : seen)
        if (level <= want.level && !full.count(want.item) && !claim({want.item, level}, 0))
          full.insert(want.item);
    for (const LevelWant& want : ahead)
      for (int level = 0; level <= want.level; ++level)
        if (!claim({want.item, level}, want.soonest)) return;
  }
  std::optional<Pair> next_read() const {
    std::optional<Pair> next;
    for (const auto& [p, key] : claimed_)
      if (!there_.count(p) && (!next || key < claimed_.at(*next))) next = p;
    return next;
  }
  void release_one() {
    std::optional<Pair> first;
    for (const Pair& p : there_)
      if (!claimed_.count(p) && (!first || last_[p] < last_[*first])) first = p;
    ASSERT_TRUE(first);
    there_.erase(*first);
  }

  std::vector<std::vector<Bytes>> bytes_;
  Bytes limit_, left_ = 0;
  int frame_ = 0;
  std::map<Pair, std::tuple<int, int, int>> claimed_;
  std::map<Pair, std::pair<int, int>> last_;
  std::set<Pair> there_;
  std::optional<Pair> under_way_;
};

Wants wants_by_lot(std::mt19937& lot, const std::vector<std::vector<Bytes>>& bytes, bool seen) {
  Wants wants(std::uniform_int_distribution<>(0, 12)(lot));
  int soonest = 0;
  for (LevelWant& want : wants) {
    want.item = std::uniform_int_distribution<>(0, static_cast<int>(bytes.size()) - 1)(lot);
    want.level = std::uniform_int_distribution<>(0, static_cast<int>(bytes[want.item].size()) - 1)(lot);
    if (!seen) want.soonest = soonest += std::uniform_int_distribution<>(0, 2)(lot);
  }
  return wants;
}

TEST(LevelCache, RandomRunsAreThoseOfTheSlowSimulator) {
  std::mt19937 lot(5);
  for (int run = 0; run < 200; ++run) {
    std::vector<std::vector<Bytes>> bytes(std::uniform_int_distribution<>(1, 15)(lot));
    Bytes all = 0;
    for (auto& item : bytes) {
      item.resize(std::uniform_int_distribution<>(1, 4)(lot));
      for (Bytes& level : item) all += level = std::uniform_int_distribution<>(0, 30)(lot);
    }
    const Bytes limit = std::uniform_int_distribution<Bytes>(0, all + 5)(lot);
    LevelCache cache(bytes, limit);
    SlowCache slow(bytes, limit);
    for (int frame = 0; frame < 60; ++frame) {
      const Wants seen = wants_by_lot(lot, bytes, true), ahead = wants_by_lot(lot, bytes, false);
      const Bytes budget = std::uniform_int_distribution<Bytes>(0, 40)(lot);
      const MemoryFrame fast = cache.step(seen, ahead, budget);
      const auto [skipped, used] = slow.step(seen, ahead, budget);
      ASSERT_EQ(fast.skipped_levels, skipped) << run << ", frame " << frame;
      ASSERT_EQ(fast.resident_bytes, used) << run << ", frame " << frame;
      ASSERT_LE(fast.resident_bytes, limit);
      ASSERT_LE(fast.claimed_bytes, std::min(limit, fast.wanted_bytes));
      ASSERT_LE(fast.read_bytes, budget);
      for (std::size_t item = 0; item < bytes.size(); ++item)
        ASSERT_EQ(cache.resident_levels(static_cast<int>(item)), slow.levels(static_cast<int>(item)));
    }
  }
}

TEST(LevelCache, WithRoomForAllAndNoLimitOfReadingNothingIsSkipped) {
  std::mt19937 lot(6);
  const std::vector<std::vector<Bytes>> bytes(20, {100, 300, 700});
  LevelCache cache(bytes, 20 * 1100);
  Bytes read = 0;
  for (int frame = 0; frame < 500; ++frame) {
    const MemoryFrame report =
        cache.step(wants_by_lot(lot, bytes, true), wants_by_lot(lot, bytes, false), kNoLimit_bytes);
    EXPECT_EQ(report.skipped_levels, 0);
    EXPECT_EQ(report.released_bytes, 0);
    read += report.read_bytes;
  }
  EXPECT_EQ(read, 20 * 1100) << "each byte once";
}

TEST(LevelCache, TenThousandFramesNeitherDriftNorGrow) {
  std::mt19937 lot(7);
  const std::vector<std::vector<Bytes>> bytes(40, {7, 13, 29});
  LevelCache cache(bytes, 400);
  Bytes read = 0, gone = 0, given_up = 0;
  for (int frame = 0; frame < 10'000; ++frame) {
    const MemoryFrame report =
        cache.step(wants_by_lot(lot, bytes, true), wants_by_lot(lot, bytes, false), 17);
    read += report.read_bytes, gone += report.released_bytes, given_up += report.wasted_bytes;
    ASSERT_LE(report.resident_bytes, 400);
  }
  EXPECT_LE(read, 17 * 10'000);
  EXPECT_LE(gone + cache.resident_bytes(), read + 29) << "what goes, or is there, was read";
  EXPECT_LE(given_up, read);
  EXPECT_GT(gone, 10'000);
}

TEST(LevelCache, WhatItCannotBeMadeOfIsNamed) {
  EXPECT_EQ(first_defect({{1}, {2, 0}}), "");
  EXPECT_EQ(first_defect(std::vector<std::vector<Bytes>>{{1}, {}}), "item 1: no level, rule: one or more");
  EXPECT_EQ(first_defect({{1, -5}}), "item 0, level 1: -5 bytes, rule: at least 0");
}

TEST(MemoryLimits, BytesOfFramesAreThoseOfTheBandwidthToAByte) {
  MemoryLimits limits;
  EXPECT_EQ(limit_bytes(limits), kNoLimit_bytes);
  EXPECT_EQ(frame_bytes(limits, 24, 0), kNoLimit_bytes);
  limits.memory_mb = 12, limits.io_mb_per_s = 0.45;
  EXPECT_EQ(limit_bytes(limits), 12'000'000);
  EXPECT_EQ(frame_bytes(limits, 10, 0), 45'000);
  EXPECT_EQ(frame_bytes(limits, 10, 7), 45'000);
  limits.io_mb_per_s = 1e-6;  // a byte a second
  Bytes sum = 0;
  for (int frame = 0; frame < 240; ++frame) sum += frame_bytes(limits, 24, frame);
  EXPECT_EQ(sum, 10);
  limits.io_mb_per_s = 0;
  EXPECT_EQ(frame_bytes(limits, 24, 5), 0);
  limits.io_mb_per_s = 1e300;
  EXPECT_EQ(frame_bytes(limits, 24, 5), kNoLimit_bytes);
}

TEST(MemoryLimits, WhatCannotBeIsNamed) {
  EXPECT_EQ(first_defect(MemoryLimits{}), "");
  EXPECT_EQ(first_defect(MemoryLimits{-1, 1}), "memory_mb is -1, must be at least 0");
  EXPECT_EQ(first_defect(MemoryLimits{1, -0.5}), "io_mb_per_s is -0.5, must be at least 0");
  EXPECT_EQ(first_defect(MemoryLimits{1, std::nan("")}), "io_mb_per_s is nan, must be at least 0");
  PrefetchOptions options;
  EXPECT_EQ(first_defect(options), "");
  options.frames = 1001;
  EXPECT_EQ(first_defect(options), "prefetch is 1001, must be 0 … 1000 frames");
  options.frames = 4, options.speed_m_per_s = 0;
  EXPECT_EQ(first_defect(options), "prefetch_speed is 0, must be above 0 m/s and finite");
  options.speed_m_per_s = 1, options.turn_deg_per_s = HUGE_VAL;
  EXPECT_EQ(first_defect(options), "prefetch_turn is inf, must be above 0 degrees/s and finite");
}

}  // namespace
}  // namespace talisman::regulator
