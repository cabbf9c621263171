// SPDX-License-Identifier: Apache-2.0
// Subdivision that is never wrong, against the full scan.
#include "regulator/certified_words.h"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace talisman::regulator {
namespace {

/// A place for each frame, linear between keys; it stands still for much of the time.
struct Track {
  std::vector<double> at;
  double motion(int then, int now) const { return std::abs(at[now] - at[then]); }
  /// What the keys between two frames leave possible: the extent of the track there.
  double bound(int a, int b) const {
    const auto [lo, hi] = std::minmax_element(at.begin() + a, at.begin() + b + 1);
    return *hi - *lo;
  }
};

Track random_track(std::mt19937& random, int frames, double moving) {
  std::bernoulli_distribution moves(moving);
  std::uniform_real_distribution<double> velocity(-0.8, 0.8);
  std::uniform_int_distribution<int> length(1, 12);
  Track track{{0}};
  const bool ever = moves(random);  // 1 - moving of the things never move
  while (static_cast<int>(track.at.size()) < frames) {
    const double v = ever ? velocity(random) : 0;
    for (int k = length(random); k > 0 && static_cast<int>(track.at.size()) < frames; --k)
      track.at.push_back(track.at.back() + v);
  }
  return track;
}

CertifiedWord certified(const Track& track, double delta) {
  return certified_word(
      static_cast<int>(track.at.size()), delta, [&](int a, int b) { return track.motion(a, b); },
      [&](int a, int b) { return track.bound(a, b); });
}

MotionWord full_scan(const Track& track, double delta) {
  return motion_word(static_cast<int>(track.at.size()),
                     [&](int a, int b) { return track.motion(a, b) > delta; });
}

/// Of 10,000 random tracks, each of which has the word of its full scan.
struct Cost {
  std::int64_t evaluations = 0, scanned = 0;
};
Cost cost_beside_the_full_scan(unsigned seed, double moving) {
  std::mt19937 random(seed);
  Cost cost;
  for (int trial = 0; trial < 10'000; ++trial) {
    const int frames = 1 + trial % 70;
    const Track track = random_track(random, frames, moving);
    const CertifiedWord found = certified(track, 1);
    EXPECT_EQ(found.word, full_scan(track, 1)) << trial;
    cost.evaluations += found.evaluations;
    cost.scanned += frames - 1;
  }
  return cost;
}

TEST(CertifiedWord, IsThatOfTheFullScanWithAThirdOfTheEvaluationsWhereMostRest) {
  const Cost cost = cost_beside_the_full_scan(2018, 0.1);
  EXPECT_LE(3 * cost.evaluations, cost.scanned);
}

TEST(CertifiedWord, IsThatOfTheFullScanWhereAllMovesAndCostsNoMuchMore) {
  const Cost cost = cost_beside_the_full_scan(2019, 1);
  EXPECT_LE(cost.evaluations, cost.scanned);
}

TEST(CertifiedWord, MotionThatReturnsIsSeenAndTheTestOfBothEndsMissesIt) {
  Track track{std::vector<double>(33, 0.0)};
  track.at[11] = 5;  // there and back
  const CertifiedWord found = certified(track, 1);
  EXPECT_EQ(found.word, full_scan(track, 1));
  EXPECT_EQ(found.word.runs(), 3);
  // As printed: first and last frame of the interval alone.
  EXPECT_LE(track.motion(0, 32), 1);
}

TEST(CertifiedWord, WithoutAnyBoundItIsTheFullScan) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 200; ++trial) {
    const Track track = random_track(random, 1 + trial % 40, 0.5);
    const CertifiedWord found = certified_word(
        static_cast<int>(track.at.size()), 1, [&](int a, int b) { return track.motion(a, b); },
        [](int, int) { return std::numeric_limits<double>::infinity(); });
    ASSERT_EQ(found.word, full_scan(track, 1));
  }
}

TEST(CertifiedWord, WhatIsNotANumberHasChanged) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const CertifiedWord found = certified_word(
      8, 1, [&](int, int now) { return now == 5 ? nan : 0.0; }, [](int, int) { return HUGE_VAL; });
  EXPECT_EQ(found.word.marks(), "#....#..");
}

TEST(CertifiedWord, OneFrameAndNothingAtAll) {
  EXPECT_EQ(certified({{0}}, 1).evaluations, 0);
  EXPECT_EQ(certified({std::vector<double>(64, 0.0)}, 0).evaluations, 0);
  EXPECT_EQ(certified({std::vector<double>(64, 0.0)}, 0).word.runs(), 1);
}

}  // namespace
}  // namespace talisman::regulator
