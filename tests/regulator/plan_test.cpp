// SPDX-License-Identifier: Apache-2.0
// Each policy against hand-made assessments: no scene, no pixel.
#include "regulator/plan.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace talisman::regulator {
namespace {

using ::testing::HasSubstr;

/// A layer in view that was rendered `age` frames ago and whose warped sprite is `error_px` off.
LayerAssessment layer_with_error(double error_px, int age = 1) {
  LayerAssessment layer;
  layer.layer = 0;
  layer.in_view = layer.has_sprite = true;
  layer.frames_since_render = age;
  layer.matched_points = 8;
  layer.fitted.status = warp::FitStatus::Converged;
  layer.fitted.warp.now_from_then[2][0] = 7;  // moved by 7 px in x
  layer.fiducials.geometric.px = error_px;
  layer.held_geometric_px = 7 + error_px;
  layer.cost = {1000, 4096, 4, 16384};
  return layer;
}

LayerDecision decide(const LayerAssessment& layer, const RegulatorOptions& options, int frame = 10) {
  return regulate(frame, {&layer, 1}, options).decisions.at(0);
}

RegulatorOptions threshold_of(double px) {
  RegulatorOptions options;
  options.policy = Policy::Threshold;
  options.thresholds.geometric_px = px;
  return options;
}

RegulatorOptions every(Policy policy, int frames) {
  RegulatorOptions options;
  options.policy = policy;
  options.hold_frames = frames;
  return options;
}

TEST(Regulate, WhatRanOverALayerIsNamedWithItsShareOfTheError) {
  LayerAssessment layer = layer_with_error(6.75);
  layer.fiducials.shade.computed = true;
  layer.fiducials.shade.px = 6;
  layer.fiducials.shade.what = "the shadow of 'rotor' in light 'key'";
  EXPECT_EQ(decide(layer, threshold_of(4)).reason,
            "geometric 6.75 > 4 px (0.750 of place + 6.000 of the shadow of 'rotor' in light 'key')");
  layer.fiducials.geometric.px = 6;  // all of it
  EXPECT_EQ(decide(layer, threshold_of(4)).reason,
            "geometric 6 > 4 px (of the shadow of 'rotor' in light 'key')");
  layer.fiducials.shade.what.clear();  // who planned did not know the scene
  EXPECT_THAT(decide(layer, threshold_of(4)).reason, HasSubstr("of what ran over it"));
  layer.fiducials.shade.px = 0;
  EXPECT_EQ(decide(layer, threshold_of(4)).reason, "geometric 6 > 4 px");
}

TEST(Regulate, NoLayersGiveAnEmptyPlan) { EXPECT_TRUE(regulate(3, {}, {}).decisions.empty()); }

TEST(Regulate, LayerOutOfViewIsDroppedByEveryPolicy) {
  LayerAssessment layer = layer_with_error(100, 5);
  layer.in_view = false;
  for (const Policy policy : kAllPolicies) {
    const LayerDecision decision = decide(layer, every(policy, 3));
    EXPECT_EQ(decision.action, Action::Drop) << name(policy);
    EXPECT_EQ(decision.cost, LayerCost{}) << name(policy);
  }
}

TEST(Regulate, FirstAppearanceIsRenderedByEveryPolicyOnAnyFrameButBetweenBeats) {
  LayerAssessment layer = layer_with_error(0);
  layer.has_sprite = false;
  for (const Policy policy : kAllPolicies)
    for (const int frame : {0, 1, 2, 3}) {
      if (keeps_beat(every(policy, 3)) && frame % 3 != 0) continue;
      const LayerDecision decision = decide(layer, every(policy, 3), frame);
      EXPECT_EQ(decision.action, Action::Rerender) << name(policy) << " frame " << frame;
      EXPECT_EQ(decision.shown_geometric_px, 0);
      EXPECT_EQ(decision.cost, layer.cost);
    }
}

TEST(Regulate, ReferenceRendersEvenWhatIsIdentical) {
  LayerAssessment layer = layer_with_error(0);
  layer.identical = true;
  EXPECT_EQ(decide(layer, every(Policy::Reference, 3)).action, Action::Rerender);
  EXPECT_EQ(decide(layer, every(Policy::Direct, 3)).action, Action::Rerender);
}

TEST(PolicyHold, RendersEveryThirdFrameAndLeavesTheSpriteInPlaceBetween) {
  LayerAssessment layer = layer_with_error(0.5);
  EXPECT_EQ(decide(layer, every(Policy::Hold, 3), 9).action, Action::Rerender);
  for (const int frame : {10, 11}) {
    layer.frames_since_render = frame - 9;
    const LayerDecision held = decide(layer, every(Policy::Hold, 3), frame);
    EXPECT_EQ(held.action, Action::Reuse);
    EXPECT_TRUE(held.shown_warp.is_identity());
    EXPECT_DOUBLE_EQ(held.shown_geometric_px, 7.5) << "the error is that of not moving the sprite";
    EXPECT_DOUBLE_EQ(held.warp_geometric_px, 0.5);
  }
}

// [LS97 7.2]: the picture stands. What left the view since is still shown, what came into view is not.
TEST(PolicyHold, BetweenBeatsThePictureIsThatOfTheBeat) {
  LayerAssessment left = layer_with_error(0.5);
  left.in_view = false;
  left.frames_since_render = 1;
  EXPECT_EQ(decide(left, every(Policy::Hold, 3), 10).action, Action::Reuse);
  EXPECT_EQ(decide(left, every(Policy::Interpolate, 3), 10).action, Action::Drop);
  EXPECT_EQ(decide(left, every(Policy::Hold, 3), 9).action, Action::Drop) << "the beat sees that it left";
  LayerAssessment entered = layer_with_error(0);
  entered.has_sprite = false;
  for (const Policy policy : {Policy::Hold, Policy::Interpolate}) {
    const LayerDecision waits = decide(entered, every(policy, 3), 10);
    EXPECT_EQ(waits.action, Action::Drop);
    EXPECT_THAT(waits.reason, HasSubstr("first shown on the next beat"));
    EXPECT_EQ(decide(entered, every(policy, 3), 12).action, Action::Rerender);
  }
}

// A sprite of an earlier beat, of a layer that was away on the last one, is never shown again.
TEST(PolicyHold, NothingStaleReturns) {
  LayerAssessment stale = layer_with_error(0.5);
  stale.frames_since_render = 5;
  for (const Policy policy : {Policy::Hold, Policy::Interpolate})
    for (const int frame : {10, 11}) EXPECT_EQ(decide(stale, every(policy, 3), frame).action, Action::Drop);
}

// A run that begins between two beats: its first frame is one.
TEST(PolicyHold, BeatMayBeAnotherThanTheRegularOne) {
  LayerAssessment layer = layer_with_error(0.5);
  const RegulatorOptions options = every(Policy::Hold, 3);
  EXPECT_EQ(regulate(FrameBeat{10, 10}, {&layer, 1}, options).decisions[0].action, Action::Rerender);
  layer.frames_since_render = 1;
  EXPECT_EQ(regulate(FrameBeat{11, 10}, {&layer, 1}, options).decisions[0].action, Action::Reuse);
}

TEST(PolicyInterpolate, CarriesTheSpriteByTheWarpBetweenRenders) {
  const LayerAssessment layer = layer_with_error(0.5);
  const LayerDecision moved = decide(layer, every(Policy::Interpolate, 3), 10);
  EXPECT_EQ(moved.action, Action::Reuse);
  EXPECT_EQ(moved.shown_warp, layer.fitted.warp);
  EXPECT_DOUBLE_EQ(moved.shown_geometric_px, 0.5);
  EXPECT_EQ(decide(layer, every(Policy::Interpolate, 3), 12).action, Action::Rerender);
}

TEST(PolicyInterpolate, WithoutAFitTheSpriteStaysInPlace) {
  LayerAssessment layer = layer_with_error(0.5);
  layer.fitted.status = warp::FitStatus::NotFinite;
  EXPECT_TRUE(decide(layer, every(Policy::Interpolate, 3), 10).shown_warp.is_identity());
}

TEST(PolicyInterpolate, EveryFrameIsTheReference) {
  const LayerAssessment layer = layer_with_error(0.5);
  for (int frame = 0; frame < 5; ++frame)
    EXPECT_EQ(decide(layer, every(Policy::Interpolate, 1), frame).action, Action::Rerender);
}

TEST(PolicyThreshold, ErrorAtTheThresholdIsReusedAndJustAboveIsNot) {
  EXPECT_EQ(decide(layer_with_error(4), threshold_of(4)).action, Action::Reuse);
  const LayerDecision above = decide(layer_with_error(std::nextafter(4, 5)), threshold_of(4));
  EXPECT_EQ(above.action, Action::Rerender);
  EXPECT_THAT(above.reason, HasSubstr("geometric"));
  EXPECT_EQ(above.shown_geometric_px, 0) << "what is displayed is fresh";
}

TEST(PolicyThreshold, ReasonNamesValueAndLimit) {
  EXPECT_EQ(decide(layer_with_error(4.7), threshold_of(4)).reason, "geometric 4.7 > 4 px");
  EXPECT_EQ(decide(layer_with_error(1.25), threshold_of(4)).reason, "geometric 1.25 <= 4 px");
}

TEST(PolicyThreshold, ZeroReusesOnlyTheIdentical) {
  // A motion that the warp follows exactly still changes the samples, so its pixels differ from fresh ones.
  LayerAssessment layer = layer_with_error(0);
  EXPECT_EQ(decide(layer, threshold_of(0)).action, Action::Rerender);
  layer.identical = true;
  EXPECT_EQ(decide(layer, threshold_of(0)).action, Action::Reuse);
}

TEST(PolicyThreshold, NotANumberIsNeverGoodEnough) {
  EXPECT_EQ(decide(layer_with_error(NAN), threshold_of(4)).action, Action::Rerender);
  LayerAssessment layer = layer_with_error(0);
  layer.fiducials.sampling.magnification = NAN;
  EXPECT_EQ(decide(layer, threshold_of(4)).action, Action::Rerender);
}

TEST(PolicyThreshold, TooFewMatchedPointsDoNotCountAsNoError) {
  // Two points are always matched exactly by an affine map: an error of 0 that means nothing.
  LayerAssessment layer = layer_with_error(0);
  layer.matched_points = 2;
  const LayerDecision decision = decide(layer, threshold_of(4));
  EXPECT_EQ(decision.action, Action::Rerender);
  EXPECT_THAT(decision.reason, HasSubstr("matched points 2 < 3"));
}

TEST(PolicyThreshold, EachSamplingAndVisibilityFiducialCanDecideAlone) {
  LayerAssessment stretched = layer_with_error(1);
  stretched.fiducials.sampling.magnification = 1.6;
  EXPECT_THAT(decide(stretched, threshold_of(4)).reason, HasSubstr("magnification 1.6 > 1.5"));

  LayerAssessment squeezed = layer_with_error(1);
  squeezed.fiducials.sampling.minification = 0.4;
  EXPECT_THAT(decide(squeezed, threshold_of(4)).reason, HasSubstr("minification 0.4 < 0.5"));

  LayerAssessment skewed = layer_with_error(1);
  skewed.fiducials.sampling.anisotropy = 2.5;
  EXPECT_THAT(decide(skewed, threshold_of(4)).reason, HasSubstr("anisotropy 2.5 > 2"));

  LayerAssessment uncovered = layer_with_error(1);
  uncovered.fiducials.visibility.uncovered_px = 9;
  EXPECT_EQ(decide(uncovered, threshold_of(4)).action, Action::Reuse) << "not computed: it must not count";
  uncovered.fiducials.visibility.computed = true;
  EXPECT_THAT(decide(uncovered, threshold_of(4)).reason, HasSubstr("uncovered edge 9 > 1 px"));
}

TEST(PolicyThreshold, SwitchedOffFiducialsDoNotDecide) {
  RegulatorOptions options = threshold_of(4);
  options.thresholds.magnification = options.thresholds.minification = options.thresholds.anisotropy = 0;
  options.thresholds.uncovered_px = -1;
  LayerAssessment layer = layer_with_error(1);
  layer.fiducials.sampling = {100, 0.01, 1e4, {0, 0}};
  layer.fiducials.visibility.computed = true;
  layer.fiducials.visibility.uncovered_px = 500;
  EXPECT_EQ(decide(layer, options).action, Action::Reuse);
}

TEST(PolicyThreshold, MinimumRateRendersALayerThatIsGoodEnough) {
  LayerAssessment layer = layer_with_error(0.1, 9);
  layer.preferences.min_update_rate = 0.1;
  EXPECT_EQ(decide(layer, threshold_of(4)).action, Action::Reuse);
  layer.frames_since_render = 10;
  EXPECT_EQ(decide(layer, threshold_of(4)).action, Action::Rerender);
}

TEST(PolicyThreshold, MaximumRateDefersALayerThatIsNotGoodEnough) {
  LayerAssessment layer = layer_with_error(9, 3);
  layer.preferences.max_update_rate = 0.25;
  const LayerDecision deferred = decide(layer, threshold_of(4));
  EXPECT_EQ(deferred.action, Action::Reuse);
  EXPECT_THAT(deferred.reason, HasSubstr("deferred: max_update_rate"));
  EXPECT_DOUBLE_EQ(deferred.shown_geometric_px, 9) << "the error that is displayed is told, not hidden";
  layer.frames_since_render = 4;
  EXPECT_EQ(decide(layer, threshold_of(4)).action, Action::Rerender);
}

TEST(PolicyThreshold, MoreThresholdNeverMeansMoreRendersForTheSameAssessments) {
  std::vector<LayerAssessment> layers;
  for (int i = 0; i < 50; ++i) {
    layers.push_back(layer_with_error(0.2 * i));
    layers.back().layer = i;
  }
  int before = 51;
  for (const double px : {0.25, 0.5, 1.0, 2.0, 4.0, 8.0}) {
    int renders = 0;
    for (const LayerDecision& d : regulate(1, layers, threshold_of(px)).decisions)
      renders += d.action == Action::Rerender;
    EXPECT_LE(renders, before);
    before = renders;
  }
  EXPECT_LT(before, 10);
}

TEST(RegulatorOptions, DefectsNameOptionValueAndRule) {
  RegulatorOptions options;
  EXPECT_EQ(first_defect(options), "");
  options.thresholds.geometric_px = -1;
  EXPECT_EQ(first_defect(options), "geometric_px is -1, must be at least 0");
  options = {};
  options.hold_frames = 0;
  EXPECT_EQ(first_defect(options), "hold_frames is 0, must be at least 1");
  options = {};
  options.lookahead.frames = -1;
  EXPECT_EQ(first_defect(options), "lookahead_frames is -1, must be at least 0");
  options = {};
  options.budget.pixels = -1;
  EXPECT_EQ(first_defect(options), "budget_pixels is -1, must be at least 0");
  for (double Thresholds::*field :
       {&Thresholds::geometric_px, &Thresholds::magnification, &Thresholds::minification,
        &Thresholds::anisotropy, &Thresholds::uncovered_px}) {
    options = {};
    options.thresholds.*field = NAN;
    EXPECT_NE(first_defect(options), "");
  }
  options = {};
  options.budget.cutoff_px = NAN;
  EXPECT_NE(first_defect(options), "");
}

TEST(RegulatorOptions, PolicyNamesRoundTrip) {
  for (const Policy policy : kAllPolicies) EXPECT_EQ(policy_from_name(name(policy)), policy);
  EXPECT_EQ(policy_from_name("thresh"), std::nullopt);
}

}  // namespace
}  // namespace talisman::regulator
