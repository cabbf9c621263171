// SPDX-License-Identifier: Apache-2.0
// Decisions about shadow maps against hand-made frames: no scene, no pixel.
#include "regulator/shadow_maps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "regulator/budget.h"

namespace talisman::regulator {
namespace {

using ::testing::HasSubstr;

constexpr int kFloor = 0, kBall = 1;

/// A layer in view, drawn before, whose sprite is `error_px` off, its shadow included.
LayerAssessment shown_layer(int id, double error_px, std::int64_t polygons) {
  LayerAssessment layer;
  layer.layer = id;
  layer.in_view = layer.has_sprite = true;
  layer.frames_since_render = 1;
  layer.matched_points = 8;
  layer.fitted.status = warp::FitStatus::Converged;
  layer.fiducials.geometric.px = error_px;
  layer.cost = {polygons, 1000, 1, 4096};
  return layer;
}

/// The map of a sun, out of date: the shadow on the floor has moved by `moved_px`.
MapAssessment old_map(double moved_px, std::int64_t polygons) {
  MapAssessment map;
  map.name = "shadow map of sun";
  map.map = shown_layer(0, moved_px, polygons);
  map.uses = {{kFloor, moved_px}};
  return map;
}

RegulatorOptions within(std::int64_t polygons) {
  RegulatorOptions options;
  options.policy = Policy::Budget;
  options.budget.polygons = polygons;
  return options;
}

FramePlan plan(const std::vector<LayerAssessment>& layers, const MapAssessment& map,
               const RegulatorOptions& options) {
  return regulate(regular_beat(10, options), layers, options, {&map, 1});
}

TEST(ShadowMapInABudget, IsDrawnWithItsReceiverWhereBothFit) {
  const FramePlan both = plan({shown_layer(kFloor, 5, 2)}, old_map(5, 100), within(102));
  EXPECT_EQ(both.maps[0].action, Action::Rerender);
  EXPECT_EQ(both.decisions[kFloor].action, Action::Rerender);
  EXPECT_EQ(both.decisions[kFloor].shown_geometric_px, 0);
  EXPECT_EQ(both.maps[0].cost.polygons, 100);
}

TEST(ShadowMapInABudget, DearerThanTheWholeBudgetItIsKeptAndSoIsAReceiverThatWouldGainByNothingElse) {
  const FramePlan kept = plan({shown_layer(kFloor, 5, 2)}, old_map(5, 100), within(50));
  EXPECT_EQ(kept.maps[0].action, Action::Reuse);
  EXPECT_TRUE(kept.maps[0].over_budget);
  EXPECT_EQ(kept.maps[0].shown_geometric_px, 5);
  EXPECT_THAT(kept.maps[0].reason, HasSubstr("dearer than the whole budget of 50 polygons, needs 100"));
  EXPECT_EQ(kept.decisions[kFloor].action, Action::Reuse);
  EXPECT_THAT(kept.decisions[kFloor].reason, HasSubstr("old shadow map"));
}

TEST(ShadowMapInABudget, ReceiverThatGainsOtherwiseIsDrawnFromTheOldMapAndSaysHowFarItsShadowIsOff) {
  const FramePlan held = plan({shown_layer(kFloor, 9, 2)}, old_map(5, 100), within(50));
  EXPECT_EQ(held.maps[0].action, Action::Reuse);
  EXPECT_EQ(held.decisions[kFloor].action, Action::Rerender);
  EXPECT_EQ(held.decisions[kFloor].shown_geometric_px, 5);
  EXPECT_THAT(held.decisions[kFloor].reason, HasSubstr("old shadow map of sun"));
}

TEST(ShadowMapInABudget, CompetesWithLayersForWhatItMends) {
  // 100 polygons: either the map with the floor (6 px) or the ball.
  const auto layers = [](double ball_px) {
    return std::vector{shown_layer(kFloor, 6, 2), shown_layer(kBall, ball_px, 99)};
  };
  const FramePlan ball = plan(layers(20), old_map(6, 98), within(100));
  EXPECT_EQ(ball.decisions[kBall].action, Action::Rerender);
  EXPECT_EQ(ball.maps[0].action, Action::Reuse);
  const FramePlan shadow = plan(layers(2), old_map(6, 98), within(100));
  EXPECT_EQ(shadow.decisions[kBall].action, Action::Reuse);
  EXPECT_EQ(shadow.maps[0].action, Action::Rerender);
}

TEST(ShadowMapInABudget, OfAFirstAppearanceIsDrawnBeyondTheBudgetAndSaysSo) {
  LayerAssessment floor = shown_layer(kFloor, 0, 2);
  floor.has_sprite = false;
  MapAssessment map = old_map(0, 100);
  map.map.has_sprite = false;
  const FramePlan first = plan({floor}, map, within(10));
  EXPECT_EQ(first.decisions[kFloor].action, Action::Rerender);
  EXPECT_EQ(first.maps[0].action, Action::Rerender);
  EXPECT_THAT(first.maps[0].reason, HasSubstr("overdraws budget"));
}

TEST(ShadowMap, IsNotDrawnWhereNoLayerThatLooksItUpIs) {
  RegulatorOptions options;
  options.policy = Policy::Threshold;
  const FramePlan rest = plan({shown_layer(kFloor, 1, 2)}, old_map(5, 100), options);
  EXPECT_EQ(rest.decisions[kFloor].action, Action::Reuse);
  EXPECT_EQ(rest.maps[0].action, Action::Reuse);
  EXPECT_EQ(rest.maps[0].cost, LayerCost{});
}

TEST(ShadowMap, HasAThresholdOfItsOwn) {
  RegulatorOptions options;
  options.policy = Policy::Threshold;
  const std::vector floor = {shown_layer(kFloor, 9, 2)};
  EXPECT_EQ(plan(floor, old_map(0.7, 100), options).maps[0].action, Action::Rerender) << "0: never old";
  options.thresholds.shadow_map_px = 1;
  const FramePlan held = plan(floor, old_map(0.7, 100), options);
  EXPECT_EQ(held.maps[0].reason, "shadow moved 0.7 <= 1 px");
  EXPECT_EQ(held.decisions[kFloor].shown_geometric_px, 0.7);
  EXPECT_EQ(plan(floor, old_map(1.5, 100), options).maps[0].action, Action::Rerender);
}

TEST(ShadowMap, OutOfViewItIsDropped) {
  MapAssessment map = old_map(5, 100);
  map.uses.clear();
  map.map.in_view = false;
  for (const Policy policy : {Policy::Reference, Policy::Budget, Policy::Threshold}) {
    RegulatorOptions options = within(1000);
    options.policy = policy;
    EXPECT_EQ(plan({shown_layer(kFloor, 9, 2)}, map, options).maps[0].action, Action::Drop);
  }
}

}  // namespace
}  // namespace talisman::regulator
