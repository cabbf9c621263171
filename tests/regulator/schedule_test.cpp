// SPDX-License-Identifier: Apache-2.0
// Runs and schedules over predicates, against exhaustive search.
#include "regulator/schedule.h"

#include <algorithm>
#include <cstdlib>
#include <random>

#include <gtest/gtest.h>

namespace talisman::regulator {
namespace {

/// A predicate as a table; a fresh sprite always serves its own frame.
struct Table {
  int frames;
  std::vector<char> cells;
  Serves serves() const {
    return [this](int r, int f) { return r == f || cells[r * frames + f] != 0; };
  }
};

Table random_table(std::mt19937& random, int frames, double density) {
  std::bernoulli_distribution good(density);
  Table table{frames, std::vector<char>(frames * frames)};
  for (char& cell : table.cells) cell = good(random);
  return table;
}

bool valid(const FrameRun& run, const Serves& serves) {
  for (int frame = run.first; frame <= run.last; ++frame)
    if (!serves(run.instant, frame)) return false;
  return run.frames() > 0;
}

/// Tries every cut of first … last into runs and every instant for each run.
int fewest_by_brute_force(int first, int last, int frames, const Serves& serves) {
  if (first > last) return 0;
  int fewest = 1 << 20;
  for (int end = first; end <= last; ++end)
    for (int instant = 0; instant < frames; ++instant)
      if (valid({instant, first, end}, serves))
        fewest = std::min(fewest, 1 + fewest_by_brute_force(end + 1, last, frames, serves));
  return fewest;
}

TEST(FewestRenders, EqualsExhaustiveSearchOnRandomPredicates) {
  // Neither monotone nor symmetric: gaps, sprites that serve only far frames, everything and nothing.
  constexpr unsigned kSeed = 20'261;
  std::mt19937 random(kSeed);
  for (int trial = 0; trial < 400; ++trial) {
    const int frames = 1 + trial % 8;
    const Table table = random_table(random, frames, 0.1 + 0.2 * (trial % 5));
    const std::vector<FrameRun> runs = fewest_renders(0, frames - 1, table.serves());
    ASSERT_EQ(static_cast<int>(runs.size()), fewest_by_brute_force(0, frames - 1, frames, table.serves()))
        << "seed " << kSeed << " trial " << trial;
    int next = 0;
    for (const FrameRun& run : runs) {
      EXPECT_TRUE(valid(run, table.serves())) << "seed " << kSeed << " trial " << trial;
      EXPECT_EQ(run.first, next);
      next = run.last + 1;
    }
    EXPECT_EQ(next, frames);
  }
}

TEST(FewestRenders, SteadyMotionIsServedFromTheMiddleOfEachRun) {
  // |r - f| ≤ 3: a sprite serves three frames before and three after its instant, seven in all.
  const auto runs = fewest_renders(0, 20, [](int r, int f) { return std::abs(r - f) <= 3; });
  ASSERT_EQ(runs.size(), 3u);
  EXPECT_EQ(runs[0], (FrameRun{3, 0, 6}));
  EXPECT_EQ(runs[1], (FrameRun{10, 7, 13}));
  EXPECT_EQ(runs[2], (FrameRun{17, 14, 20}));
}

TEST(FewestRenders, OneFrameAndNoFrames) {
  const Serves own_only = [](int r, int f) { return r == f; };
  EXPECT_TRUE(fewest_renders(5, 4, own_only).empty());
  EXPECT_EQ(fewest_renders(5, 5, own_only), (std::vector<FrameRun>{{5, 5, 5}}));
  EXPECT_EQ(fewest_renders(5, 9, own_only).size(), 5u);
}

TEST(FewestRenders, AnInstantBeforeTheRunIsUsedWhereItServesLonger) {
  // The motion swings back: what frame 0 looked like is right again from frame 4 on.
  const Serves swings_back = [](int r, int f) { return r == f || (r == 0 && f >= 4); };
  const auto runs = fewest_renders(0, 7, swings_back);
  EXPECT_EQ(runs.size(), 5u);
  EXPECT_EQ(runs.back(), (FrameRun{0, 4, 7}));
}

TEST(FewestRenders, AFrameThatNoInstantServesIsAProgrammingError) {
  EXPECT_DEATH(fewest_renders(0, 3, [](int, int f) { return f != 2; }), "instant");
}

/// Obvious: measures the run of each instant from its start.
FrameRun longest_by_brute_force(int frame, int first, int last_instant, int last, const Serves& serves) {
  FrameRun best{-1, frame, frame - 1};
  const auto consider = [&](int instant) {
    int end = frame - 1;
    while (end < last && serves(instant, end + 1)) ++end;
    if (end > best.last) best = {instant, frame, end};
  };
  for (int instant = frame; instant <= last_instant; ++instant) consider(instant);
  for (int instant = std::min(frame - 1, last_instant); instant >= first; --instant) consider(instant);
  return best;
}

TEST(LongestRun, EqualsExhaustiveSearchOnRandomPredicates) {
  constexpr unsigned kSeed = 77;
  std::mt19937 random(kSeed);
  for (int trial = 0; trial < 500; ++trial) {
    const int frames = 12, frame = trial % frames;
    const Table table = random_table(random, frames, 0.5 + 0.1 * (trial % 5));
    for (const int lookahead : {0, 1, 4, 100}) {
      const int last_instant = std::min(frame + lookahead, frames - 1);
      EXPECT_EQ(longest_run(frame, lookahead, frames - 1, table.serves()),
                longest_by_brute_force(frame, frame, last_instant, frames - 1, table.serves()))
          << "seed " << kSeed << " trial " << trial << " lookahead " << lookahead;
    }
    EXPECT_EQ(longest_run(frame, Instants{0, frames - 1}, frames - 1, table.serves()),
              longest_by_brute_force(frame, 0, frames - 1, frames - 1, table.serves()))
        << "seed " << kSeed << " trial " << trial;
  }
}

TEST(LongestRun, WithoutLookaheadTheInstantIsNow) {
  EXPECT_EQ(longest_run(4, 0, 100, [](int r, int f) { return std::abs(r - f) <= 5; }), (FrameRun{4, 4, 9}));
}

TEST(LongestRun, TiesGoToTheEarliestInstantFromTheFrameOn) {
  EXPECT_EQ(longest_run(4, Instants{0, 20}, 20, [](int, int) { return true; }), (FrameRun{4, 4, 20}));
  // Only instants before the frame serve it: the latest of those.
  EXPECT_EQ(longest_run(4, Instants{0, 20}, 20, [](int r, int) { return r < 3; }), (FrameRun{2, 4, 20}));
}

TEST(LongestRun, NoInstantThatServesTheFrameGivesAnEmptyRun) {
  const FrameRun none = longest_run(4, 10, 20, [](int, int f) { return f != 4; });
  EXPECT_EQ(none.instant, -1);
  EXPECT_EQ(none.frames(), 0);
}

TEST(LongestRun, HugeLookaheadEndsWithTheSequence) {
  EXPECT_EQ(longest_run(4, 1 << 30, 9, [](int r, int f) { return std::abs(r - f) <= 2; }),
            (FrameRun{6, 4, 8}));
}

TEST(LongestRun, AsksFarLessThanEveryPair) {
  // Steady motion: an instant that cannot win is dismissed by one or two questions.
  int asked = 0;
  const auto run = longest_run(0, 200, 400, [&](int r, int f) {
    ++asked;
    return std::abs(r - f) <= 10;
  });
  EXPECT_EQ(run, (FrameRun{10, 0, 20}));
  EXPECT_LT(asked, 400) << "all pairs would be 201 · 401";
  EXPECT_LE(asked, 10 + 20 + 200 + 5)
      << "the two runs that are followed, and one question for each other instant";
}

}  // namespace
}  // namespace talisman::regulator
