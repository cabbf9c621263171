// SPDX-License-Identifier: Apache-2.0
// What the regulator makes of the photometric and the facing fiducials: no scene, no pixel.
#include <cmath>

#include <gtest/gtest.h>

#include "regulator/budget.h"
#include "regulator/decision.h"
#include "regulator/policies.h"

namespace talisman::regulator {
namespace {

using fiducials::LightRef;

/// A layer whose only error is that of its light.
LayerAssessment lit_layer(double color, double light_angle_rad = 0) {
  LayerAssessment layer;
  layer.layer = 0;
  layer.in_view = layer.has_sprite = true;
  layer.frames_since_render = 1;
  layer.matched_points = 8;
  layer.fitted.status = warp::FitStatus::Converged;
  layer.fiducials.photometric.computed = true;
  layer.fiducials.photometric.color = color;
  layer.fiducials.photometric.color_light = {1, "lamp"};
  layer.fiducials.photometric.light_angle_rad = light_angle_rad;
  layer.fiducials.photometric.angle_light = {0, "sun"};
  layer.fiducials.photometric.multiplier = {0.5, 0.75, 1};
  return layer;
}

TEST(ViolationOf, PhotometricErrorNamesItsLight) {
  EXPECT_EQ(violation_of(lit_layer(0.081), {}), "photometric 0.081 > 0.05 (light 'lamp')");
  EXPECT_EQ(violation_of(lit_layer(0.05), {}), "") << "the threshold itself is still good enough";
  LayerAssessment nameless = lit_layer(0.081);
  nameless.fiducials.photometric.color_light = {3, ""};
  EXPECT_EQ(violation_of(nameless, {}), "photometric 0.081 > 0.05 (light 3)");
  nameless.fiducials.photometric.color_light = {};
  EXPECT_EQ(violation_of(nameless, {}), "photometric 0.081 > 0.05");
}

TEST(ViolationOf, LightAngleIsRegulatedOnlyWhereItIsAskedFor) {
  RegulatorOptions options;
  EXPECT_EQ(violation_of(lit_layer(0, 1), options), "");
  options.thresholds.light_angle_rad = 0.25;
  EXPECT_EQ(violation_of(lit_layer(0, 0.5), options),
            "photometric: light angle 0.5 > 0.25 rad (light 'sun')");
  LayerAssessment shiny = lit_layer(0, 0.5);
  shiny.fiducials.photometric.angle_light = {LightRef::kEye, ""};
  EXPECT_EQ(violation_of(shiny, options), "photometric: light angle 0.5 > 0.25 rad (highlights: the eye)");
}

TEST(ViolationOf, ZeroSwitchesPhotometryOffAndNotComputedNeverViolates) {
  RegulatorOptions off;
  off.thresholds.photometric = 0;
  EXPECT_EQ(violation_of(lit_layer(1.7, 3), off), "");
  LayerAssessment unlit = lit_layer(1.7, 3);
  unlit.fiducials.photometric.computed = false;
  off.thresholds.photometric = off.thresholds.light_angle_rad = 0.01;
  EXPECT_EQ(violation_of(unlit, off), "");
}

// Twice as important is half as far off; a weight of 0 leaves displacements alone.
TEST(ViolationOf, DisplacementCountsByItsWeight) {
  LayerAssessment layer = lit_layer(0);
  layer.fiducials.geometric.px = 3;
  EXPECT_EQ(violation_of(layer, {}), "");
  layer.preferences.importance.geometric = 2;
  EXPECT_EQ(violation_of(layer, {}), "geometric 3 > 2 px");
  layer.fiducials.geometric.px = 1e6;
  layer.preferences.importance.geometric = 0;
  EXPECT_EQ(violation_of(layer, {}), "");
  RegulatorOptions nothing;
  nothing.thresholds.geometric_px = 0;
  EXPECT_NE(violation_of(layer, nothing), "") << "0 px reuses only what is identical, whatever the weight";
}

TEST(ViolationOf, NaNIsAViolation) { EXPECT_NE(violation_of(lit_layer(std::nan("")), {}), ""); }

TEST(ViolationOf, TurnedSidesAreRegulatedOnlyWhereTheyAreAskedFor) {
  LayerAssessment layer = lit_layer(0);
  layer.fiducials.turned.computed = true;
  layer.fiducials.turned.px = 40;
  RegulatorOptions options;
  EXPECT_EQ(violation_of(layer, options), "");
  options.thresholds.turned_px = 32;
  EXPECT_EQ(violation_of(layer, options), "visibility: side turned to the eye 40 > 32 px");
}

TEST(ColorWarp, IsShownWithReusedSpritesOnly) {
  EXPECT_EQ(reuse(lit_layer(0), "").shown_color, layers::dvec3(0.5, 0.75, 1));
  EXPECT_EQ(rerender(lit_layer(0), "").shown_color, layers::dvec3(1, 1, 1));
  EXPECT_EQ(reuse_in_place(lit_layer(0), "").shown_color, layers::dvec3(1, 1, 1))
      << "held sprites are shown as they are";
  EXPECT_EQ(drop(lit_layer(0)).shown_color, layers::dvec3(1, 1, 1));
}

TEST(BenefitPx, CountsLightAtTheStatedRateAndTurnedSidesInPixels) {
  LayerAssessment layer = lit_layer(0.05);
  EXPECT_DOUBLE_EQ(benefit_px(layer), 4);
  layer.preferences.importance.photometric = 0.5;
  EXPECT_DOUBLE_EQ(benefit_px(layer), 2);
  layer.fiducials.turned.px = 10;
  EXPECT_DOUBLE_EQ(benefit_px(layer), 2) << "a fiducial that is not computed does not count";
  layer.fiducials.turned.computed = true;
  EXPECT_DOUBLE_EQ(benefit_px(layer), 12);
  layer.preferences.importance.photometric = layer.preferences.importance.visibility = 0;
  EXPECT_EQ(benefit_px(layer), 0);
}

TEST(FollowsLight, OnlyWhereOldSpritesAreCarriedByWarps) {
  RegulatorOptions options;
  for (const Policy policy : kAllPolicies) {
    options.policy = policy;
    const bool warps = policy != Policy::Direct && policy != Policy::Reference && policy != Policy::Hold &&
                       policy != Policy::Predictive;
    EXPECT_EQ(follows_light(options), warps) << name(policy);
  }
  options.policy = Policy::Threshold;
  options.color_warp = false;
  EXPECT_TRUE(follows_light(options));
  options.thresholds.photometric = 0;
  EXPECT_FALSE(follows_light(options));
  options.thresholds.light_angle_rad = 0.1;
  EXPECT_TRUE(follows_light(options));
}

TEST(FirstDefect, OfPhotometricThresholds) {
  const auto defect = [](auto set) {
    RegulatorOptions options;
    set(options);
    return first_defect(options);
  };
  EXPECT_EQ(defect([](RegulatorOptions& o) { o.thresholds.photometric = -1; }),
            "photometric is -1, must be at least 0 (0: off)");
  EXPECT_NE(defect([](RegulatorOptions& o) { o.thresholds.photometric = std::nan(""); }), "");
  EXPECT_NE(defect([](RegulatorOptions& o) { o.thresholds.light_angle_rad = 3.2; }), "");
  EXPECT_NE(defect([](RegulatorOptions& o) { o.thresholds.light_angle_rad = std::nan(""); }), "");
  EXPECT_NE(defect([](RegulatorOptions& o) { o.thresholds.turned_px = -1; }), "");
  EXPECT_EQ(defect([](RegulatorOptions& o) { o.thresholds.light_angle_rad = 3.14159; }), "");
}

}  // namespace
}  // namespace talisman::regulator
