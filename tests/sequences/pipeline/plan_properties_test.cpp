// SPDX-License-Identifier: Apache-2.0
// What must hold of whole plans, on random fleets of layers.
#include <cmath>
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include "regulator/policies.h"
#include "sequences/pipeline/layer_planning.h"
#include "sequences/results/frame_lines.h"
#include "tests/sequences/small_run.h"
#include "tests/support/fleet.h"

namespace talisman::sequences {
namespace {

using regulator::Action;
using regulator::kNoLimit;
using regulator::Policy;
using regulator::RegulatorOptions;

constexpr unsigned kSeeds[] = {1, 2, 3};
constexpr int kPlannedFrames = 64;

SmallRun small_fleet(int layers, unsigned seed, const RegulatorOptions& options) {
  SmallRun small(tests::fleet_scene(layers, seed));
  small.settings.view.display_px = {320, 240};
  small.settings.fps = 32;
  small.settings.regulator = options;
  return small;
}

RegulatorOptions within(std::int64_t polygons, std::int64_t pixels, std::int64_t chunks = kNoLimit,
                        double ms = regulator::kNoLimitMs) {
  RegulatorOptions options;
  options.policy = Policy::Budget;
  options.budget.polygons = polygons;
  options.budget.pixels = pixels;
  options.budget.chunks = chunks;
  options.budget.ms = ms;
  return options;
}

RegulatorOptions bounded(Policy policy, double px, int lookahead = 8,
                         regulator::Prediction predict = regulator::Prediction::Known) {
  RegulatorOptions options;
  options.policy = policy;
  options.thresholds.geometric_px = px;
  options.lookahead.frames = lookahead;
  options.lookahead.predict = predict;
  return options;
}

double error_of(const std::vector<FrameReport>& reports) {
  double sum = 0;
  for (const FrameReport& report : reports)
    for (const regulator::LayerDecision& d : report.plan.decisions) sum += d.shown_geometric_px;
  return sum;
}

TEST(PlanBudget, NeverSpendsMoreThanAnyOfItsBudgetsExceptOnFirstAppearances) {
  for (const unsigned seed : kSeeds)
    for (const RegulatorOptions& options :
         {within(36, kNoLimit), within(kNoLimit, 2000), within(60, 3000), within(kNoLimit, kNoLimit, 5),
          within(kNoLimit, kNoLimit, kNoLimit, 0.05), within(48, 2500, 4, 0.04), within(0, 0, 0, 0)}) {
      const regulator::Budget budget = regulator::frame_budget(options);
      int renders = 0;
      for (const FrameReport& report : small_fleet(12, seed, options).run(kPlannedFrames, false)) {
        regulator::LayerCost spent, first;
        for (const regulator::LayerDecision& d : report.plan.decisions) {
          regulator::LayerCost& of = report.assessments[d.layer].has_sprite ? spent : first;
          of.polygons += d.cost.polygons;
          of.pixels += d.cost.pixels;
          of.chunks += d.cost.chunks;
          renders += d.cost.polygons > 0 && d.layer < 12;  // merged layers may appear in any frame
        }
        EXPECT_TRUE(regulator::after(budget, first).affords(spent))
            << "seed " << seed << " frame " << report.frame << ": " << spent.polygons << " polygons, "
            << spent.pixels << " pixels, " << spent.chunks << " chunks";
      }
      EXPECT_EQ(renders > 12, budget.polygons > 0) << "a case that draws nothing says nothing";
    }
}

TEST(PlanBudget, ErrorFallsAsPolygonsGrow) {
  // In trend: a step may undo a little of what the one before it gained, because greedy choices differ.
  for (const unsigned seed : kSeeds) {
    double least = HUGE_VAL, first = 0, last = 0;
    for (int layers = 0; layers <= 12; layers += 2) {
      last = error_of(small_fleet(12, seed, within(12 * layers, kNoLimit)).run(kPlannedFrames, false));
      EXPECT_LE(last, 1.1 * least) << "seed " << seed << ", " << layers << " cubes per frame";
      least = std::min(least, last);
      if (layers == 0) first = last;
    }
    EXPECT_LT(last, 0.01 * first) << "seed " << seed << ": all can be drawn";
  }
}

TEST(PlanBudget, ResolutionRisesAsPixelsGrow) {
  const auto mean_resolution = [](std::int64_t pixels) {
    double sum = 0;
    int shown = 0;
    for (const FrameReport& report : small_fleet(12, 1, within(kNoLimit, pixels)).run(kPlannedFrames, false))
      for (const regulator::LayerDecision& d : report.plan.decisions) {
        if (d.action == Action::Drop) continue;
        sum += d.resolution;
        ++shown;
      }
    return sum / shown;
  };
  double before = 0;
  for (const std::int64_t pixels : {300, 1000, 3000, 10'000, 100'000}) {
    const double now = mean_resolution(pixels);
    EXPECT_GE(now, before - 0.02) << pixels;
    before = now;
  }
  EXPECT_EQ(before, 1);
}

TEST(PlanBudget, ResolutionChangesByATenthFromRenderToRenderUnlessItHadToWait) {
  std::map<int, double> at_last_render;  // by layer, of which there may come to be more: aggregates
  std::map<int, int> waited;
  int changes = 0;
  for (const FrameReport& report : small_fleet(12, 2, within(kNoLimit, 2000)).run(kPlannedFrames, false))
    for (const regulator::LayerDecision& d : report.plan.decisions) {
      waited[d.layer] = d.short_of_area             ? waited[d.layer] + 1
                        : d.action == Action::Reuse ? 0
                                                    : waited[d.layer];
      if (d.action != Action::Rerender) continue;
      const double before = at_last_render[d.layer];
      if (before > 0) {
        EXPECT_LE(d.resolution, 1.1 * before * (1 + 1e-12));
        EXPECT_GE(d.resolution, std::max(std::pow(0.9, 1 + waited[d.layer]) * before * (1 - 1e-12), 0.0));
        changes += d.resolution != before;
      }
      at_last_render[d.layer] = d.resolution;
      waited[d.layer] = 0;
    }
  EXPECT_GT(changes, 20);
}

TEST(PlanBudget, LayerDearerThanAllPixelsIsDrawnInTheEndWithoutSpendingMore) {
  // One ship alone, first seen under an ample budget; then the budget is a fifth of what it takes.
  RegulatorOptions ample = within(kNoLimit, 1'000'000), scarce = within(kNoLimit, 150);
  const SmallRun small = small_fleet(1, 5, ample);
  Settings settings = small.settings;
  const Pipeline rich = make_pipeline(small.scene, small.layers, settings);
  settings.regulator = scarce;
  const Pipeline poor = make_pipeline(small.scene, small.layers, settings);
  PipelineState state(rich);
  ASSERT_GT(step(rich, state, 0, nullptr).plan.decisions[0].cost.pixels, 750);
  int first_render = -1;
  for (int frame = 1; frame < 40; ++frame) {
    const regulator::LayerDecision d = step(poor, state, frame, nullptr).plan.decisions[0];
    EXPECT_LE(d.cost.pixels, 150) << frame;
    if (first_render < 0 && d.action == Action::Rerender) first_render = frame;
    if (first_render < 0) {
      EXPECT_NE(d.reason.find("dearer than the whole budget"), std::string::npos) << d.reason;
    }
  }
  EXPECT_GT(first_render, 3) << "a tenth a frame";
  EXPECT_LE(first_render, 20);
}

TEST(PlanBudget, SceneAtRestIsSharpenedUntilNothingIsLeftToGain) {
  SmallRun small(tests::cube_scene());
  small.settings.view.display_px = {320, 240};
  small.settings.regulator = within(kNoLimit, 2000);  // the cube takes about 5500 at full resolution
  const Pipeline poor = make_pipeline(small.scene, small.layers, small.settings);
  small.settings.regulator = within(kNoLimit, 100'000);
  const Pipeline rich = make_pipeline(small.scene, small.layers, small.settings);
  PipelineState state(poor);
  const double coarse = step(poor, state, 0, nullptr).plan.decisions[0].resolution;
  EXPECT_LT(coarse, 0.7);
  double before = coarse;
  for (int frame = 1; frame < 40; ++frame) {
    const regulator::LayerDecision d = step(rich, state, frame, nullptr).plan.decisions[0];
    EXPECT_GE(d.resolution, before);
    before = d.resolution;
    if (frame > 20) {
      EXPECT_EQ(d.reason, "unchanged");
    }
  }
  EXPECT_EQ(before, 1);
}

TEST(PlanBudget, GapIsReportedOnlyWhenAskedForAndChangesNoDecision) {
  SmallRun small = small_fleet(12, 3, within(48, 2000));
  const auto plain = small.run(24, false);
  small.settings.budget_gap = true;
  const auto with_gap = small.run(24, false);
  const Pipeline pipeline = make_pipeline(small.scene, small.layers, small.settings);
  double most = 0;
  for (int frame = 0; frame < 24; ++frame) {
    EXPECT_FALSE(plain[frame].budget_gap.has_value());
    ASSERT_TRUE(with_gap[frame].budget_gap.has_value());
    const regulator::BudgetGap& gap = *with_gap[frame].budget_gap;
    EXPECT_TRUE(gap.exact);
    EXPECT_GE(gap.optimal_px, gap.greedy_px);
    most = std::max(most, gap.gap());
    for (std::size_t i = 0; i < plain[frame].plan.decisions.size(); ++i)
      EXPECT_EQ(json_of(plain[frame], plain[frame].plan.decisions[i]),
                json_of(with_gap[frame], with_gap[frame].plan.decisions[i]));
    const FrameLine line = line_of(with_gap[frame]);
    const auto read = frame_line_from_json(json_of(line));
    ASSERT_TRUE(read && read->budget_gap);
    EXPECT_EQ(read->budget_gap->optimal_px, gap.optimal_px) << "--resume reads it back";
  }
  EXPECT_GT(most, 0) << "a fleet on which greedy is always best says nothing";
}

TEST(PlanOrder, LookaheadNeedsNoMoreThanThresholdAndTheOracleFewest) {
  for (const unsigned seed : kSeeds)
    for (const double px : {0.5, 2.0}) {
      const auto renders = [&](const RegulatorOptions& options) {
        return count(small_fleet(6, seed, options).run(kPlannedFrames, false), Action::Rerender);
      };
      const int threshold = renders(bounded(Policy::Threshold, px));
      const int oracle = renders(bounded(Policy::Oracle, px));
      for (const int n : {2, 8, 32}) {
        const int known = renders(bounded(Policy::Lookahead, px, n));
        EXPECT_LE(known, threshold) << "seed " << seed << ", " << px << " px, N = " << n;
        EXPECT_LE(oracle, known) << "seed " << seed << ", " << px << " px, N = " << n;
        EXPECT_LE(oracle, renders(bounded(Policy::Lookahead, px, n, regulator::Prediction::Linear)))
            << "seed " << seed << ", " << px << " px, N = " << n;
      }
      EXPECT_LE(oracle, threshold);
    }
}

/// Fewest runs by trying every way to cut the frames.
int fewest_by_force(const std::vector<std::vector<bool>>& serves) {
  const int frames = static_cast<int>(serves.size());
  const auto run_exists = [&](int first, int last) {
    for (const std::vector<bool>& instant : serves) {
      bool all = true;
      for (int f = first; f <= last; ++f) all = all && instant[f];
      if (all) return true;
    }
    return false;
  };
  int best = frames;
  for (unsigned cuts = 0; cuts < (1u << (frames - 1)); ++cuts) {
    int runs = 0, first = 0;
    bool valid = true;
    for (int f = 0; f < frames && valid; ++f) {
      if (f + 1 < frames && !(cuts >> f & 1u)) continue;
      valid = run_exists(first, f);
      first = f + 1;
      ++runs;
    }
    if (valid) best = std::min(best, runs);
  }
  return best;
}

TEST(PlanOracle, EqualsEveryWayToCutATinySequence) {
  constexpr int kTiny = 11;
  int compared = 0;
  for (const unsigned seed : {7u, 8u, 9u}) {
    SmallRun small = small_fleet(3, seed, bounded(Policy::Oracle, 1));
    small.settings.fps = 8;  // fast, so that there is something to choose
    small.settings.frames = kTiny;
    const auto reports = small.run(kTiny, false);
    const Pipeline pipeline = make_pipeline(small.scene, small.layers, small.settings);
    PipelineState state(pipeline);
    for (int layer = 0; layer < 3; ++layer) {
      bool always_in_view = true;
      int renders = 0;
      for (const FrameReport& report : reports) {
        always_in_view = always_in_view && report.plan.decisions[layer].action != Action::Drop;
        renders += report.plan.decisions[layer].action == Action::Rerender;
      }
      if (!always_in_view) continue;  // the oracle begins a run where the layer comes back into view
      std::vector<std::vector<bool>> serves(kTiny, std::vector<bool>(kTiny));
      for (int r = 0; r < kTiny; ++r)
        for (int f = 0; f < kTiny; ++f)
          serves[r][f] = regulator::violation_of(
                             assess_sprite(pipeline, state.layers, captured_states(pipeline, state, r)[layer],
                                           captured_placement(pipeline, state, layer, r),
                                           captured_states(pipeline, state, f)[layer], 0),
                             small.settings.regulator)
                             .empty();
      EXPECT_EQ(renders, fewest_by_force(serves)) << "seed " << seed << " layer " << layer;
      compared += renders > 1 && renders < kTiny;
    }
  }
  EXPECT_GE(compared, 3) << "layers that are drawn once or always say nothing";
}

TEST(PlanPredicted, DisplayedErrorNeverExceedsTheBoundHoweverWrongThePredictionWas) {
  for (const unsigned seed : kSeeds)
    for (const double px : {0.5, 2.0}) {
      int ahead = 0;
      for (const FrameReport& report :
           small_fleet(6, seed, bounded(Policy::Lookahead, px, 12, regulator::Prediction::Linear))
               .run(kPlannedFrames, false))
        for (const regulator::LayerDecision& d : report.plan.decisions) {
          EXPECT_LE(d.shown_geometric_px, px) << "seed " << seed << " frame " << report.frame;
          ahead += d.depicts_frame > report.frame;
        }
      EXPECT_GT(ahead, 0) << "no sprite was drawn ahead";
    }
}

TEST(PlanPredicted, WithoutLookaheadItIsTheThresholdPolicy) {
  const auto threshold = small_fleet(6, 1, bounded(Policy::Threshold, 1)).run(kPlannedFrames, false);
  const auto none = small_fleet(6, 1, bounded(Policy::Lookahead, 1, 0, regulator::Prediction::Linear))
                        .run(kPlannedFrames, false);
  EXPECT_NEAR(count(none, Action::Rerender), count(threshold, Action::Rerender),
              0.03 * count(threshold, Action::Rerender))
      << "only the growth of clipped extents may differ, by the velocity that is expected";
}

TEST(PlanPredicted, ConstantMotionIsForeseenAsIfItWereKnown) {
  layers::Scene scene = tests::textured_quad_scene();
  layers::TransformTrack glide;
  const glm::dquat level(1, 0, 0, 0), turned = glm::angleAxis(0.5, layers::dvec3(0, 1, 0));
  glide.translation = {{0, 3}, {{-0.3, 0, 0}, {0.3, 0.1, -0.5}}, layers::Interpolation::Linear};
  glide.rotation = {{0, 3}, {level, turned}, layers::Interpolation::Linear};
  scene.tracks.push_back({scene.parts[0].node, glide});
  const auto renders = [&](regulator::Prediction predict) {
    SmallRun small(scene);
    small.settings.regulator = bounded(Policy::Lookahead, 0.5, 12, predict);
    return count(small.run(72, false), Action::Rerender);
  };
  // In frame 0 no velocity is known yet, so the first sprite is drawn as of then.
  EXPECT_NEAR(renders(regulator::Prediction::Linear), renders(regulator::Prediction::Known), 1);
}

TEST(PlanPredicted, SpriteOfAnExpectedInstantIsTheSameDrawnAtOnceOrLate) {
  SmallRun small = small_fleet(4, 2, bounded(Policy::Lookahead, 1, 6, regulator::Prediction::Linear));
  small.settings.frames = 20;
  const auto at_once = small.run(20, true);
  const Pipeline pipeline = make_pipeline(small.scene, small.layers, small.settings);
  const chunker::PreparedScene prepared(small.scene);
  PipelineState state(pipeline);
  int late = 0;
  for (int frame = 0; frame < 20; ++frame) {
    const bool draw = frame % 4 == 3;
    const FrameReport report = step(pipeline, state, frame, draw ? &prepared : nullptr);
    late += report.late_renders;
    if (draw) {
      EXPECT_EQ(hash_of(report.picture), hash_of(at_once[frame].picture)) << frame;
    }
  }
  EXPECT_GT(late, 0);
}

}  // namespace
}  // namespace talisman::sequences
