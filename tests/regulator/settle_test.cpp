// SPDX-License-Identifier: Apache-2.0
#include "regulator/settle.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace talisman::regulator {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A layer whose sprite is shown well within all thresholds, stretched by `magnification`, and that has been at rest.
LayerAssessment resting(int frames, double magnification = 1.2) {
  LayerAssessment layer;
  layer.layer = 0;
  layer.in_view = layer.has_sprite = true;
  layer.frames_since_render = 40;
  layer.frames_at_rest = frames;
  layer.matched_points = 8;
  layer.fitted.status = warp::FitStatus::Converged;
  layer.fiducials.geometric.px = 0.25;
  layer.fiducials.sampling.magnification = magnification;
  layer.cost = {1000, 4096, 4, 16384};
  return layer;
}

RegulatorOptions settling(int frames, Policy policy = Policy::Threshold) {
  RegulatorOptions options;
  options.policy = policy;
  options.settle_frames = frames;
  return options;
}

LayerDecision decide_settling(const LayerAssessment& layer, const RegulatorOptions& options) {
  return regulate(10, {&layer, 1}, options).decisions.at(0);
}

TEST(Settle, IsOffByDefault) {
  const LayerDecision decision = decide_settling(resting(100000), {});
  EXPECT_EQ(decision.action, Action::Reuse);
  EXPECT_EQ(decision.reason, "geometric 0.25 <= 4 px");
}

TEST(Settle, DrawsAgainAfterSoManyFramesAtRest) {
  for (const Policy policy : {Policy::Threshold, Policy::Lookahead, Policy::Oracle}) {
    EXPECT_EQ(decide_settling(resting(2), settling(3, policy)).action, Action::Reuse) << name(policy);
    const LayerDecision decision = decide_settling(resting(3), settling(3, policy));
    EXPECT_EQ(decision.action, Action::Rerender) << name(policy);
    EXPECT_EQ(decision.reason, "settled: at rest for 3 frames, magnification 1.2 > 1");
    EXPECT_TRUE(decision.settled);
    EXPECT_EQ(decision.cost, resting(3).cost);
  }
}

TEST(Settle, IsForWhatIsShownEnlargedAlone) {
  for (const double magnification : {0.7, 1.0, 1.0005})
    EXPECT_EQ(decide_settling(resting(9, magnification), settling(1)).action, Action::Reuse) << magnification;
  LayerAssessment fresh = resting(9);
  fresh.identical = true;  // drawn as it is now: no render would change it
  EXPECT_EQ(decide_settling(fresh, settling(1)).reason, "unchanged");
}

// Drawn at 0.8 of the resolution that it could have now: its texels are 1.25 times as large.
TEST(Settle, ALowerResolutionIsAnEnlargement) {
  LayerAssessment coarse = resting(5, 1.25);
  coarse.identical = true;
  coarse.resolution_then = 0.8;
  EXPECT_THAT(decide_settling(coarse, settling(5)).reason, StartsWith("settled"));
  coarse.resolution = 0.8;  // and would be drawn at no more
  EXPECT_EQ(decide_settling(coarse, settling(5)).action, Action::Reuse);
}

TEST(Settle, AnotherReasonComesFirst) {
  LayerAssessment layer = resting(5);
  layer.fiducials.geometric.px = 7;
  const LayerDecision decision = decide_settling(layer, settling(1));
  EXPECT_EQ(decision.reason, "geometric 7 > 4 px");
  EXPECT_FALSE(decision.settled);
}

TEST(Settle, IsBarredByTheMaximumRate) {
  LayerAssessment layer = resting(5);
  layer.preferences.max_update_rate = 0.01;
  const LayerDecision decision = decide_settling(layer, settling(5));
  EXPECT_EQ(decision.action, Action::Reuse);
  EXPECT_THAT(decision.reason, StartsWith("deferred: max_update_rate; settled"));
}

TEST(Settle, PoliciesWithABeatHaveNoUseForIt) {
  for (const Policy policy : {Policy::Hold, Policy::Interpolate}) {
    LayerAssessment layer = resting(50);
    layer.frames_since_render = 1;
    EXPECT_EQ(decide_settling(layer, settling(1, policy)).action, Action::Reuse) << name(policy);
  }
}

// Whatever the benefit, so that a weight of 0 does not keep a blur for ever; but within the budget.
TEST(SettleUnderABudget, SpendsWhatIsLeft) {
  LayerAssessment layer = resting(4);
  layer.preferences.importance = {0, 0, 0, 0};
  RegulatorOptions options = settling(4, Policy::Budget);
  EXPECT_EQ(decide_settling(layer, settling(5, Policy::Budget)).action, Action::Reuse);
  EXPECT_EQ(decide_settling(layer, options).action, Action::Rerender);
  EXPECT_THAT(decide_settling(layer, options).reason, StartsWith("settled: at rest for 4 frames"));
  options.budget.polygons = 999;
  const LayerDecision deferred = decide_settling(layer, options);
  EXPECT_EQ(deferred.action, Action::Reuse);
  EXPECT_TRUE(deferred.deferred);
  EXPECT_THAT(deferred.reason, HasSubstr("needs 1000; settled: at rest"));
}

TEST(Settle, NegativeFramesAreADefect) {
  EXPECT_EQ(first_defect(settling(-1)), "settle_frames is -1, must be 0 (off) or at least 1");
}

}  // namespace
}  // namespace talisman::regulator
