// SPDX-License-Identifier: Apache-2.0
// Motion words and plan trees, against exhaustive search and numbers of [F96].
#include "regulator/plan_tree.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "regulator/schedule.h"

namespace talisman::regulator {
namespace {

MotionWord word_of(const std::string& marks) {
  MotionWord word(static_cast<int>(marks.size()));
  for (std::size_t f = 0; f < marks.size(); ++f)
    if (marks[f] == '#') word.mark(static_cast<int>(f));
  return word;
}

MotionWord random_word(std::mt19937& random, int frames, double change) {
  std::bernoulli_distribution changes(change);
  MotionWord word(frames);
  for (int f = 1; f < frames; ++f)
    if (changes(random)) word.mark(f);
  return word;
}

std::vector<int> frames_of(const std::vector<PlannedDraw>& draws) {
  std::vector<int> frames;
  for (const PlannedDraw& draw : draws) frames.push_back(draw.frame);
  return frames;
}

/// Every N ≤ 12 with every k of which it is a power.
std::vector<PlanShape> small_shapes() {
  std::vector<PlanShape> shapes;
  for (int frames = 1; frames <= 12; ++frames)
    for (int children = 2; children <= 12; ++children)
      if (first_defect(PlanShape{frames, children}).empty()) shapes.push_back({frames, children});
  return shapes;
}

/// Fewest nodes of the tree that cover frames first … first + width - 1, each without a change behind its first frame:
/// every choice of nodes is tried, whatever Fig. 3.7 says.
int fewest_nodes(const PlanShape& shape, const MotionWord& word, int first, int width) {
  int split = 0;
  if (width > 1)
    for (int c = 0; c < shape.children; ++c)
      split += fewest_nodes(shape, word, first + c * (width / shape.children), width / shape.children);
  bool is_whole = true;
  for (int f = first + 1; f < first + width; ++f) is_whole = is_whole && !word.changes_at(f);
  if (is_whole) return width > 1 ? std::min(1, split) : 1;
  return split;
}

TEST(MotionWord, BitsRunsAndRests) {
  const MotionWord word = word_of("#..##...");
  EXPECT_EQ(word.runs(), 3);
  EXPECT_EQ(word.marks(), "#..##...");
  EXPECT_TRUE(word.rests_over(1, 2));
  EXPECT_FALSE(word.rests_over(1, 3));
  EXPECT_TRUE(word.rests_over(5, 100));  // beyond the slice all is at rest
  EXPECT_TRUE(word.rests_over(3, 2));
  EXPECT_EQ(word.run_start(2), 0);
  EXPECT_EQ(word.run_start(3), 3);
  EXPECT_EQ(word.run_start(7), 4);
}

TEST(MotionWord, LongWordsCrossTheBordersOfTheirStorage) {
  // 64 and 128 are where one integer ends: the bits beside them must not be lost.
  for (const int frames : {63, 64, 65, 128, 130, kLongestSlice_frames})
    for (const int at : {1, 62, 63, 64, 65, 127, 128, 129, frames - 1}) {
      if (at >= frames) continue;
      MotionWord word(frames);
      word.mark(at);
      EXPECT_EQ(word.runs(), 2);
      EXPECT_FALSE(word.rests_over(at, at)) << frames << " " << at;
      EXPECT_TRUE(word.rests_over(1, at - 1)) << frames << " " << at;
      EXPECT_TRUE(word.rests_over(at + 1, frames - 1)) << frames << " " << at;
      EXPECT_FALSE(word.rests_over(1, frames - 1));
      EXPECT_EQ(word.run_start(frames - 1), at);
    }
}

TEST(MotionWord, SlowDriftIsSeenAgainstTheLastDrawnAndNotAgainstTheLastFrame) {
  // Half of δ in each frame: never beyond δ from one frame to the next, and 15.5 δ off in frame 31.
  const auto changed = [](int then, int now) { return 0.5 * (now - then) > 1; };
  EXPECT_EQ(motion_word(32, changed, MotionReference::LastFrame).runs(), 1);
  const MotionWord word = motion_word(32, changed);
  EXPECT_EQ(word.marks(), "#..#..#..#..#..#..#..#..#..#..#.");
}

TEST(MotionWord, MotionOfExactlyDeltaIsNoChangeAndThereAndBackIsTwo) {
  const double at[] = {0, 1, 1, 3, 3, 0, 0, 0};
  const auto changed = [&](int then, int now) { return std::abs(at[now] - at[then]) > 1; };
  EXPECT_EQ(motion_word(8, changed).marks(), "#..#.#..");
}

/// The largest error of what a plan displays, in units of δ, over random one-dimensional motion.
double worst_displayed(MotionReference reference, DrawnAs as, int trials) {
  std::mt19937 random(96);
  std::uniform_real_distribution<double> velocity(-1.4, 1.4);
  const PlanShape shape{32, 2};
  double worst = 0;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<double> at{0};
    for (int f = 1; f < shape.frames; ++f) at.push_back(at.back() + velocity(random));
    const MotionWord word = motion_word(
        shape.frames, [&](int a, int b) { return std::abs(at[b] - at[a]) > 1; }, reference);
    for (int f = 0; f < shape.frames; ++f) {
      const int drawn = draw_shown(shape, word, f).frame;
      worst = std::max(worst, std::abs(at[f] - at[instant_of(word, drawn, as)]));
    }
  }
  return worst;
}

TEST(MotionWord, DrawnAsOfTheFirstFrameOfItsRunNothingIsBeyondDelta) {
  EXPECT_LE(worst_displayed(MotionReference::LastDrawn, DrawnAs::RunStart, 5000), 1);
}

TEST(MotionWord, DrawnAsOfThePresentItIsUpToTwiceAsFarOff) {
  // The tree forces a drawing inside a run; the test goes on against the run's first frame.
  const double worst = worst_displayed(MotionReference::LastDrawn, DrawnAs::Present, 5000);
  EXPECT_GT(worst, 1.2);
  EXPECT_LE(worst, 2);
}

TEST(MotionWord, AsPrintedDriftIsDisplayedManyTimesDelta) {
  EXPECT_GT(worst_displayed(MotionReference::LastFrame, DrawnAs::Present, 5000), 4);
}

TEST(PlanTree, FixedIntervalsOfThePaper) {
  const PlanShape shape{8, 2};
  // [F96 3.1.4]: 10000001, read from the right, is treated as 11010001: drawn at 0, 4, 6, 7.
  EXPECT_EQ(frames_of(planned_draws(shape, word_of("#......#"))), (std::vector<int>{0, 4, 6, 7}));
  // Fig. 3.6: changes at 0, 1, 3, 5, 7 are drawn in all eight frames.
  EXPECT_EQ(planned_draws(shape, word_of("##.#.#.#")).size(), 8u);
  EXPECT_EQ(planned_draws(shape, word_of("#.......")), (std::vector<PlannedDraw>{{0, 0, 8}}));
  // The bit of the frame itself does not matter: it is drawn anyway.
  EXPECT_EQ(planned_draws(shape, word_of("#...#...")), (std::vector<PlannedDraw>{{0, 1, 4}, {4, 1, 4}}));
}

TEST(PlanTree, ShapesAndTheirDefects) {
  EXPECT_EQ((PlanShape{1, 2}.levels()), 1);
  EXPECT_EQ((PlanShape{32, 2}.levels()), 6);
  EXPECT_EQ((PlanShape{64, 4}.levels()), 4);
  EXPECT_EQ((PlanShape{7, 7}.levels()), 2);
  EXPECT_EQ((PlanShape{64, 4}.interval(2)), 4);
  EXPECT_EQ(first_defect(PlanShape{12, 2}),
            "lookahead is 12, must be a power of tree_k 2 for the policy predictive");
  EXPECT_EQ(first_defect(PlanShape{8, 1}), "tree_k is 1, must be at least 2");
  EXPECT_EQ(first_defect(PlanShape{8192, 2}),
            "lookahead is 8192, must be 1 to 4096 for the policy predictive");
  EXPECT_NE(first_defect(PlanShape{0, 2}), "");
  EXPECT_NE(first_defect(PlanShape{-8, 2}), "");
  EXPECT_EQ(first_defect(PlanShape{1, 5}), "");  // N = 1 = k^0: every frame
  EXPECT_EQ(slice_within(100, 3), 81);
  EXPECT_EQ(slice_within(1, 3), 1);
}

TEST(PlanTree, DrawsAreTheFewestNodesOnRandomWordsAndNeverFewerThanRuns) {
  std::mt19937 random(2026);
  const std::vector<PlanShape> shapes = small_shapes();
  ASSERT_GE(shapes.size(), 20u);
  for (int trial = 0; trial < 10'000; ++trial) {
    const PlanShape shape = shapes[trial % shapes.size()];
    const MotionWord word = random_word(random, shape.frames, 0.1 * (1 + trial % 9));
    const std::vector<PlannedDraw> draws = planned_draws(shape, word);
    ASSERT_EQ(static_cast<int>(draws.size()), fewest_nodes(shape, word, 0, shape.frames)) << word.marks();
    ASSERT_LE(word.runs(), static_cast<int>(draws.size())) << word.marks();
    // Each frame shows the drawing whose node holds it, and its picture is that of the run.
    for (const PlannedDraw& draw : draws)
      for (int f = draw.frame; f < draw.frame + draw.frames; ++f) {
        ASSERT_EQ(draw_shown(shape, word, f), draw) << word.marks();
        ASSERT_EQ(word.run_start(f), word.run_start(draw.frame)) << word.marks();
      }
  }
}

TEST(PlanTree, OracleDrawsNoMoreThanLookaheadAndNoMoreThanRuns) {
  // Runs of a word are a schedule of instants too: its first frames. Lookahead chooses among more of them.
  std::mt19937 random(7);
  for (int trial = 0; trial < 10'000; ++trial) {
    const int frames = 1 + trial % 12;
    std::vector<double> at{0};
    std::uniform_real_distribution<double> velocity(-1.5, 1.5);
    for (int f = 1; f < frames; ++f) at.push_back(at.back() + velocity(random));
    const Serves serves = [&](int r, int f) { return std::abs(at[r] - at[f]) <= 1; };
    const int oracle = static_cast<int>(fewest_renders(0, frames - 1, serves).size());
    int lookahead = 0;
    for (int f = 0; f < frames; ++lookahead) f = longest_run(f, 4, frames - 1, serves).last + 1;
    const MotionWord word = motion_word(frames, [&](int a, int b) { return !serves(a, b); });
    ASSERT_LE(oracle, lookahead);
    ASSERT_LE(oracle, word.runs());
  }
}

TEST(PlanTree, PriceOfSharedIntervalsForIndependentChanges) {
  // The closed form against 20,000 random words, and the ratios of the reference.
  const std::map<int, std::vector<double>> said{{8, {1.17, 1.32, 1.45, 1.46, 1.28}},
                                                {32, {2.04, 2.36, 2.29, 1.84, 1.39}}};
  const double changes[] = {0.02, 0.05, 0.1, 0.25, 0.5};
  std::mt19937 random(20'260);
  for (const auto& [frames, ratios] : said)
    for (int i = 0; i < 5; ++i) {
      const PlanShape shape{frames, 2};
      double draws = 0, runs = 0;
      constexpr int kTrials = 20'000;
      for (int trial = 0; trial < kTrials; ++trial) {
        const MotionWord word = random_word(random, frames, changes[i]);
        draws += static_cast<double>(planned_draws(shape, word).size());
        runs += word.runs();
      }
      EXPECT_NEAR(draws / kTrials, expected_draws(shape, changes[i]),
                  0.02 * expected_draws(shape, changes[i]));
      EXPECT_NEAR(runs / kTrials, expected_runs(frames, changes[i]), 0.02 * frames);
      EXPECT_NEAR(expected_draws(shape, changes[i]) / expected_runs(frames, changes[i]), ratios[i], 0.012);
    }
  EXPECT_DOUBLE_EQ(expected_draws({32, 2}, 0), 1);
  EXPECT_DOUBLE_EQ(expected_draws({32, 2}, 1), 32);
  EXPECT_DOUBLE_EQ(expected_draws({1, 2}, 0.3), 1);
}

TEST(PlanTree, JoinsOfASlice) {
  EXPECT_EQ(joins_of_slice({8, 2}, Joining::EachFrame), 24);
  EXPECT_EQ(joins_of_slice({8, 2}, Joining::Copy), 14);
  EXPECT_EQ(joins_of_slice({8, 2}, Joining::InPlace), 7);
  EXPECT_EQ(joins_of_slice({16, 4}, Joining::Copy), 20);
  EXPECT_EQ(joins_of_slice({9, 9}, Joining::EachFrame), 9);
  for (const Joining joining : kAllJoinings) {
    EXPECT_EQ(joins_of_slice({1, 2}, joining), 0);
    EXPECT_EQ(joining_from_name(name(joining)), joining);
  }
}

}  // namespace
}  // namespace talisman::regulator
