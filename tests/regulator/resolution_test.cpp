// SPDX-License-Identifier: Apache-2.0
// Spatial resolution as a regulated parameter: shares, the clamp, and who waits.
#include "regulator/resolution.h"

#include <cmath>

#include <gtest/gtest.h>

#include "regulator/budget.h"

namespace talisman::regulator {
namespace {

/// A layer in view whose sprite of full resolution is 5 px off.
LayerAssessment changed_layer(int id, std::int64_t pixels, std::int64_t polygons = 10) {
  LayerAssessment layer;
  layer.layer = id;
  layer.in_view = layer.has_sprite = true;
  layer.frames_since_render = 2;
  layer.matched_points = 8;
  layer.fitted.status = warp::FitStatus::Converged;
  layer.fiducials.geometric.px = 5;
  layer.cost = {polygons, pixels, (pixels + 1023) / 1024, 0};
  return layer;
}

LayerAssessment new_layer(int id, std::int64_t pixels) {
  LayerAssessment layer = changed_layer(id, pixels);
  layer.has_sprite = false;
  return layer;
}

LayerAssessment resting_layer(int id, std::int64_t pixels, double resolution) {
  LayerAssessment layer = changed_layer(id, pixels);
  layer.identical = true;
  layer.fiducials.geometric.px = 0;
  layer.fiducials.sampling.magnification = 1 / resolution;
  layer.resolution_then = resolution;
  return layer;
}

RegulatorOptions pixels_of(std::int64_t pixels) {
  RegulatorOptions options;
  options.policy = Policy::Budget;
  options.budget.pixels = pixels;
  return options;
}

double share_of(std::vector<LayerAssessment> layers, const RegulatorOptions& options) {
  return share_of_resolution(layers, options);
}

TEST(ShareOfResolution, IsTheRootOfTheShareOfArea) {
  EXPECT_DOUBLE_EQ(share_of({changed_layer(0, 3000), new_layer(1, 1000)}, pixels_of(1000)), 0.5);
  EXPECT_EQ(share_of({changed_layer(0, 1000)}, pixels_of(1000)), 1);
  EXPECT_EQ(share_of({changed_layer(0, 1000)}, pixels_of(0)), 0);
  EXPECT_EQ(share_of({}, pixels_of(0)), 1);
}

TEST(ShareOfResolution, PolygonsAloneDoNotLowerIt) {
  RegulatorOptions options;
  options.policy = Policy::Budget;
  options.budget.polygons = 1;
  EXPECT_EQ(share_of({changed_layer(0, 1'000'000)}, options), 1);
}

TEST(ShareOfResolution, TheScarcerOfPixelsAndChunksDecides) {
  RegulatorOptions options = pixels_of(1024 * 25);
  options.budget.chunks = 4;
  EXPECT_DOUBLE_EQ(share_of({changed_layer(0, 1024 * 100)}, options), 0.2) << "4 of 100 chunks";
}

TEST(ShareOfResolution, TimeIsPixelsAndPolygons) {
  RegulatorOptions options;
  options.policy = Policy::Budget;
  options.budget.ms = 1;  // 40,000 pixels and 1500 polygons
  EXPECT_DOUBLE_EQ(share_of({changed_layer(0, 160'000)}, options), 0.5);
}

TEST(ShareOfResolution, OnlyTheSelectedAreCounted) {
  LayerAssessment exact = changed_layer(1, 1'000'000), hidden = exact, early = exact;
  exact.fiducials.geometric.px = 0.001;  // below the cut-off
  hidden.in_view = false;
  early.preferences.max_update_rate = 0.1;
  const LayerAssessment resting = resting_layer(2, 1'000'000, 0.5);
  EXPECT_EQ(share_of({changed_layer(0, 500), exact, hidden, early, resting}, pixels_of(500)), 1);
}

TEST(ShareOfResolution, WhoLacksPolygonsNeedsNoArea) {
  RegulatorOptions options = pixels_of(1000);
  options.budget.polygons = 100;
  EXPECT_EQ(share_of({changed_layer(0, 1000, 60), changed_layer(1, 9000, 60)}, options), 1)
      << "layer 1 is deferred for its polygons in any case";
}

TEST(RegulatedResolution, ChangesByATenthAtMost) {
  LayerAssessment layer = changed_layer(0, 1000);
  EXPECT_DOUBLE_EQ(regulated_resolution(layer, 0.2, {}), 0.9);
  EXPECT_DOUBLE_EQ(regulated_resolution(layer, 0.95, {}), 0.95);
  layer.resolution_then = 0.5;
  EXPECT_DOUBLE_EQ(regulated_resolution(layer, 1, {}), 0.55);
  layer.resolution_then = 0.95;
  EXPECT_EQ(regulated_resolution(layer, 1, {}), 1) << "never above what the author asks for";
}

TEST(RegulatedResolution, FirstAppearancesTakeTheShareAtOnce) {
  EXPECT_DOUBLE_EQ(regulated_resolution(new_layer(0, 1000), 0.3, {}), 0.3);
  EXPECT_DOUBLE_EQ(regulated_resolution(new_layer(0, 1000), 0, {}), RegulatorOptions{}.budget.min_resolution);
}

TEST(RegulatedResolution, EveryFrameWaitedGivesUpAnotherTenthDownToTheLeast) {
  LayerAssessment layer = changed_layer(0, 1000);
  double before = regulated_resolution(layer, 0.95, {});
  for (layer.frames_short_of_area = 1; layer.frames_short_of_area < 15; ++layer.frames_short_of_area) {
    const double now = regulated_resolution(layer, 0.95, {});
    EXPECT_NEAR(now / before, 0.9, 1e-12);
    before = now;
  }
  layer.frames_short_of_area = 1'000'000'000;  // returns at once
  EXPECT_EQ(regulated_resolution(layer, 0.95, {}), RegulatorOptions{}.budget.min_resolution);
}

TEST(RegulatedResolution, LeastOfOneNeverLowersIt) {
  RegulatorOptions sharp;
  sharp.budget.min_resolution = 1;
  LayerAssessment layer = changed_layer(0, 1000);
  layer.frames_short_of_area = 9;
  EXPECT_EQ(regulated_resolution(layer, 0, sharp), 1);
}

TEST(RegulatedResolution, WhatIsAtRestIsSharpenedWhateverTheShare) {
  EXPECT_DOUBLE_EQ(regulated_resolution(resting_layer(0, 1000, 0.5), 0.1, {}), 0.55);
  EXPECT_EQ(regulated_resolution(resting_layer(0, 1000, 1), 0.1, {}), 1);
}

TEST(PolicyBudget, SpriteAtRestIsSharpenedOnlyAsFarAsItGains) {
  std::vector<LayerAssessment> layers = {resting_layer(0, 1000, 0.5), resting_layer(1, 1000, 1)};
  regulate_resolutions(layers, pixels_of(5000));
  const FramePlan plan = regulate(7, layers, pixels_of(5000));
  EXPECT_EQ(plan.decisions[0].action, Action::Rerender);
  EXPECT_EQ(plan.decisions[0].reason, "benefit 1 > 0.004 px; resolution 0.55");
  EXPECT_DOUBLE_EQ(plan.decisions[0].resolution, 0.55);
  EXPECT_EQ(plan.decisions[1].reason, "unchanged");
}

TEST(PolicyThreshold, CoarseSpriteOfAnotherPolicyIsDrawnAgainWhenItIsTooCoarse) {
  // What `budget` left behind, seen by `threshold`: magnification 2 is beyond 1.5, 1.25 is not.
  std::vector<LayerAssessment> layers = {resting_layer(0, 1000, 0.5), resting_layer(1, 1000, 0.8)};
  const FramePlan plan = regulate(7, layers, {});
  EXPECT_EQ(plan.decisions[0].action, Action::Rerender);
  EXPECT_EQ(plan.decisions[0].reason, "sampling: magnification 2 > 1.5");
  EXPECT_EQ(plan.decisions[1].action, Action::Reuse);
  EXPECT_DOUBLE_EQ(plan.decisions[1].resolution, 0.8) << "what is shown is told";
}

}  // namespace
}  // namespace talisman::regulator
