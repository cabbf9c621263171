// SPDX-License-Identifier: Apache-2.0
// Is the answer of the search as cheap as the best of 64 settings, all of them drawn whole?
#include "sequences/experiments/tuning/search.h"

#include <cmath>

#include <gtest/gtest.h>

#include "sequences/pipeline/step.h"
#include "tests/sequences/temporary_folder.h"
#include "tests/support/sequences.h"

namespace talisman::sequences {
namespace {

constexpr int kFrames = 16;
constexpr int kSettings = 64;

const Sequence& moving() {
  static const Sequence sequence = tests::moving_sequence(kFrames);
  return sequence;
}

Settings settings() {
  Settings settings;
  settings.view.display_px = {96, 72};
  settings.fps = moving().fps;
  settings.frames = kFrames;
  return settings;
}

/// One threshold by the plain way: every frame is drawn, and compared with the reference.
struct Drawn {
  double cost_ms = 0;
  std::vector<double> flip, squared;
};

Drawn drawn_with(double px) {
  Settings of_run = settings();
  of_run.regulator.thresholds.geometric_px = px;
  const Pipeline pipeline = make_pipeline(*moving().scene, moving().layers, of_run);
  const chunker::PreparedScene prepared(*moving().scene);
  PipelineState state(pipeline);
  Drawn drawn;
  for (int frame = 0; frame < kFrames; ++frame) {
    const FrameReport report = step(pipeline, state, frame, &prepared);
    drawn.cost_ms += line_of(report).modelled_drawing_ms;
    const Quality quality =
        compare(to_image8(report.picture), to_image8(draw_reference(pipeline, frame, prepared)));
    drawn.flip.push_back(quality.flip);
    drawn.squared.push_back(std::pow(10, -quality.psnr_db / 10));
  }
  return drawn;
}

/// Other thresholds than those of the search: evenly spaced on a logarithmic axis from 1/16 to 32 px.
const std::vector<Drawn>& brute_force() {
  static const std::vector<Drawn> all = [] {
    std::vector<Drawn> drawn;
    for (int k = 0; k < kSettings; ++k)
      drawn.push_back(drawn_with(std::exp2(-4 + 9.0 * k / (kSettings - 1))));
    return drawn;
  }();
  return all;
}

double best_cost(const TuneGoal& goal) {
  double best = HUGE_VAL;
  for (const Drawn& drawn : brute_force())
    if (goal.holds(goal.kind == GoalKind::Flip ? drawn.flip : drawn.squared))
      best = std::min(best, drawn.cost_ms);
  return best;
}

TuneReport tuned(const TuneGoal& goal) {
  const tests::TemporaryFolder folder;
  const std::atomic<bool> stop = false;
  return tune(moving(), settings(), {0, kFrames - 1}, goal, folder.path(), ProgressKind::None, stop);
}

class TuneAgainstBruteForce : public ::testing::TestWithParam<TuneGoal> {};

TEST_P(TuneAgainstBruteForce, IsWithinTenPerCentOfTheBest) {
  const TuneGoal goal = GetParam();
  const double best = best_cost(goal);
  ASSERT_TRUE(std::isfinite(best)) << goal.in_words();
  const TuneReport report = tuned(goal);
  ASSERT_TRUE(report.common && report.common->holds);
  EXPECT_LE(report.common->point.plan.cost_ms, 1.1 * best) << goal.in_words();
  EXPECT_LE(report.frames_drawn, kMostFullRenders * kFrames);
  // What is said of it is what the plain way measures.
  const Drawn again = drawn_with(report.common->point.plan.thresholds.geometric_px);
  const std::vector<double>& badness = goal.kind == GoalKind::Flip ? again.flip : again.squared;
  EXPECT_EQ(report.common->point.quality.badness, badness);
  EXPECT_NEAR(report.common->point.plan.cost_ms, again.cost_ms, 1e-9);
  if (report.per_layer) {
    EXPECT_LT(report.per_layer->point.plan.cost_ms, report.common->point.plan.cost_ms);
  }
}

INSTANTIATE_TEST_SUITE_P(Goals, TuneAgainstBruteForce,
                         ::testing::Values(TuneGoal{GoalKind::Flip, 0.005, false},
                                           TuneGoal{GoalKind::Flip, 0.02, false},
                                           TuneGoal{GoalKind::Flip, 0.01, true},
                                           TuneGoal{GoalKind::Psnr, 30, false},
                                           TuneGoal{GoalKind::Psnr, 34, true}));

TEST(TuneGrid, HasSixtyFourSettingsThatReadAsTheyArePrinted) {
  const std::vector<double> grid = tuned_grid();
  ASSERT_EQ(grid.size(), 64u);
  EXPECT_EQ(grid.front(), 0);
  EXPECT_EQ(grid.back(), 64);
  for (std::size_t k = 1; k < grid.size(); ++k) {
    EXPECT_GT(grid[k], grid[k - 1]);
    EXPECT_EQ(as_printed(grid[k]), grid[k]);
  }
}

TEST(TuneGoal, MeanPsnrIsThatOfTheMeanSquaredError) {
  const TuneGoal goal{GoalKind::Psnr, 30, true};
  EXPECT_DOUBLE_EQ(goal.largest_badness(), 1e-3);
  // 0 and 2e-3: identical and 26.99 dB; the mean is 30 dB.
  EXPECT_TRUE(goal.holds(std::vector<double>{0, 2e-3}));
  EXPECT_FALSE(goal.holds(std::vector<double>{0, 2.1e-3}));
  EXPECT_DOUBLE_EQ(goal.shown(1e-3), 30);
  Quality identical;
  identical.psnr_db = HUGE_VAL;
  EXPECT_EQ(goal.badness_of(identical), 0);
}

}  // namespace
}  // namespace talisman::sequences
