// SPDX-License-Identifier: Apache-2.0
// Intervals that follow the words, against all cuts and against fixed ones.
#include "regulator/plan_intervals.h"

#include <random>

#include <gtest/gtest.h>

namespace talisman::regulator {
namespace {

std::vector<MotionWord> random_words(std::mt19937& random, int count, int frames, double change) {
  std::bernoulli_distribution changes(change);
  std::vector<MotionWord> words(static_cast<std::size_t>(count), MotionWord(frames));
  for (MotionWord& word : words)
    for (int frame = 1; frame < frames; ++frame)
      if (changes(random)) word.mark(frame);
  return words;
}

std::int64_t draws_of(const PlanIntervals& intervals, const std::vector<MotionWord>& words,
                      const std::vector<std::int64_t>& weights = {}) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < words.size(); ++i)
    sum += static_cast<std::int64_t>(intervals.planned_draws(words[i]).size()) *
           (weights.empty() ? 1 : weights[i]);
  return sum;
}

/// The fewest drawings of what does not rest in a … b - 1 as a whole, with `levels` levels below it, by trying all cuts.
std::int64_t fewest_below(const std::vector<MotionWord>& words, int a, int b, int levels) {
  std::vector<MotionWord> restless;
  for (const MotionWord& word : words)
    if (!word.rests_over(a + 1, b - 1)) restless.push_back(word);
  if (levels == 1) return static_cast<std::int64_t>(restless.size()) * (b - a);
  std::int64_t fewest = INT64_MAX;
  for (unsigned cuts = 0; cuts < 1u << (b - a - 1); ++cuts) {
    std::int64_t sum = 0;
    int begin = a;
    for (int end = a + 1; end <= b; ++end) {
      if (end < b && !(cuts >> (end - a - 1) & 1)) continue;
      for (const MotionWord& word : restless) sum += word.rests_over(begin + 1, end - 1);
      sum += fewest_below(restless, begin, end, levels - 1);
      begin = end;
    }
    fewest = std::min(fewest, sum);
  }
  return fewest;
}

TEST(PlanIntervals, FixedOnesAreThoseOfThePlanTree) {
  std::mt19937 random(1);
  for (const PlanShape& shape : {PlanShape{1, 2}, {2, 2}, {8, 2}, {16, 4}, {9, 3}, {5, 5}, {64, 2}}) {
    const PlanIntervals fixed(shape);
    EXPECT_EQ(fixed.levels(), shape.levels());
    for (const MotionWord& word : random_words(random, 40, shape.frames, 0.15)) {
      EXPECT_EQ(fixed.planned_draws(word), planned_draws(shape, word)) << word.marks();
      for (int frame = 0; frame < shape.frames; ++frame)
        EXPECT_EQ(fixed.draw_shown(word, frame), draw_shown(shape, word, frame));
    }
  }
}

TEST(PlanIntervals, FittedOnesAreTheBestOfAllCuts) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 300; ++trial) {
    const PlanShape shape = trial % 3 == 0   ? PlanShape{4, 2}
                            : trial % 3 == 1 ? PlanShape{8, 2}
                                             : PlanShape{9, 3};
    const std::vector<MotionWord> words =
        random_words(random, 1 + trial % 7, shape.frames, 0.05 * (1 + trial % 8));
    std::int64_t whole = 0;
    for (const MotionWord& word : words) whole += word.rests_over(1, shape.frames - 1);
    EXPECT_EQ(draws_of(fitted_intervals(shape, words), words),
              whole + fewest_below(words, 0, shape.frames, shape.levels() - 1))
        << trial;
  }
}

// Fixed intervals are one of the cuts, and a buffer for each thing is what no cut can beat.
TEST(PlanIntervals, FittedOnesNeverDrawMoreThanFixedOnesNorFewerThanRuns) {
  std::mt19937 random(3);
  std::int64_t fixed = 0, fitted = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const PlanShape shape = trial % 2 ? PlanShape{16, 2} : PlanShape{16, 4};
    const std::vector<MotionWord> words = random_words(random, 20, shape.frames, 0.02 * (1 + trial % 20));
    std::vector<std::int64_t> weights;
    for (std::size_t i = 0; i < words.size(); ++i) weights.push_back(random() % 50);
    const std::int64_t of_fixed = draws_of(PlanIntervals(shape), words, weights);
    const std::int64_t of_fitted = draws_of(fitted_intervals(shape, words, weights), words, weights);
    std::int64_t runs = 0;
    for (std::size_t i = 0; i < words.size(); ++i) runs += words[i].runs() * weights[i];
    ASSERT_LE(of_fitted, of_fixed) << trial;
    ASSERT_LE(runs, of_fitted) << trial;
    fixed += of_fixed;
    fitted += of_fitted;
  }
  EXPECT_LT(fitted, fixed);
}

// Each level cuts the one above; every drawing shows one run of its thing.
TEST(PlanIntervals, FittedOnesAreATree) {
  std::mt19937 random(4);
  const PlanShape shape{32, 2};
  const std::vector<MotionWord> words = random_words(random, 30, 32, 0.1);
  const PlanIntervals intervals = fitted_intervals(shape, words);
  for (int level = 0; level < intervals.levels(); ++level)
    for (int frame = 0; frame < 32; ++frame) {
      ASSERT_LE(intervals.first(level, frame), frame);
      ASSERT_GT(intervals.end(level, frame), frame);
      ASSERT_EQ(intervals.first(level, intervals.first(level, frame)), intervals.first(level, frame));
      if (level == 0) continue;
      ASSERT_LE(intervals.first(level - 1, frame), intervals.first(level, frame));
      ASSERT_GE(intervals.end(level - 1, frame), intervals.end(level, frame));
    }
  for (const MotionWord& word : words)
    for (const PlannedDraw& draw : intervals.planned_draws(word))
      ASSERT_EQ(word.run_start(draw.frame + draw.frames - 1), word.run_start(draw.frame)) << word.marks();
}

TEST(PlanIntervals, AllChangeAtOneFrameThatIsNoPowerOfTwo) {
  MotionWord word(8);
  word.mark(3);
  const std::vector<MotionWord> words(5, word);
  EXPECT_EQ(draws_of(PlanIntervals({8, 2}), words), 5 * 4);  // 0-1, 2, 3, 4-7
  EXPECT_EQ(draws_of(fitted_intervals({8, 2}, words), words), 5 * 2);
}

TEST(PlanIntervals, NothingToChoose) {
  for (const PlanShape& shape : {PlanShape{1, 2}, {8, 8}, {8, 2}}) {
    EXPECT_EQ(fitted_intervals(shape, {}), PlanIntervals(shape));
    const std::vector<MotionWord> still(3, MotionWord(shape.frames));
    EXPECT_EQ(draws_of(fitted_intervals(shape, still), still), 3);
  }
}

}  // namespace
}  // namespace talisman::regulator
