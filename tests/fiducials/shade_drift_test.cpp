// SPDX-License-Identifier: Apache-2.0
// How far shadows, highlights and reflections ran over a surface.
#include "fiducials/shade_drift.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "layers/state.h"

namespace talisman::fiducials {
namespace {

using layers::dmat4;
using layers::dvec3;
using layers::LayerState;
using layers::ShadeTrace;

/// A receiver 10 m in front of the default camera, across the view, with one trace of one place.
LayerState receiver(const dvec3& place, bool on_receiver = true) {
  LayerState state;
  state.view.display_px = {1000, 1000};
  state.screen_bounds_px = {{100, 100}, {900, 700}};
  state.touches_display = true;
  state.world_from_receiver[3] = layers::dvec4(0, 0, -10, 1);
  state.traces.push_back({ShadeTrace::Kind::Shadow, 0, 1, on_receiver, {place}});
  return state;
}

/// Pixels per metre at the receiver.
double scale() { return 500 / std::tan(layers::CameraState{}.fov_y_rad / 2) / 10; }

TEST(ShadeMotion, AtRestZero) {
  const ShadeMotion motion = shade_motion(receiver({1, 0, 0}), receiver({1, 0, 0}));
  EXPECT_TRUE(motion.computed);
  EXPECT_EQ(motion.px, 0);
  EXPECT_EQ(motion.trace, -1);
}

TEST(ShadeMotion, WithoutTracesNotComputed) {
  LayerState plain = receiver({0, 0, 0});
  plain.traces.clear();
  const ShadeMotion motion = shade_motion(plain, plain);
  EXPECT_FALSE(motion.computed);
  EXPECT_NE(motion.why_not, "");
  EXPECT_EQ(motion.px, 0);
}

TEST(ShadeMotion, IsTheDisplacementOnTheDisplay) {
  const ShadeMotion motion = shade_motion(receiver({0, 0, 0}), receiver({0.3, 0.4, 0}));
  EXPECT_NEAR(motion.px, 0.5 * scale(), 1e-9);
  EXPECT_NEAR(motion.where_px.x, 500 + 0.3 * scale(), 1e-9);
  EXPECT_NEAR(motion.where_px.y, 500 - 0.4 * scale(), 1e-9);
  EXPECT_EQ(motion.trace, 0);
}

TEST(ShadeMotion, MotionOfTheReceiverIsNoMotionOfTheShade) {
  // The warp carries the sprite along: what rests on the surface has not moved.
  LayerState now = receiver({1, 0, 0});
  now.world_from_receiver[3] += layers::dvec4(1, 1, -5, 0);
  EXPECT_EQ(shade_motion(receiver({1, 0, 0}), now).px, 0);
}

TEST(ShadeMotion, WhatHappensBesideTheReceiverDoesNotCount) {
  EXPECT_EQ(shade_motion(receiver({0, 0, 0}, false), receiver({1, 0, 0}, false)).px, 0);
  EXPECT_GT(shade_motion(receiver({0, 0, 0}, false), receiver({1, 0, 0}, true)).px, 0);  // it comes in
}

TEST(ShadeMotion, PathIsCutOffAtTheDisplay) {
  // From the middle to a million metres to the right: half the display, and a pixel.
  const ShadeMotion motion = shade_motion(receiver({0, 0, 0}), receiver({1e6, 0, 0}));
  EXPECT_NEAR(motion.px, 501, 1e-3);
}

TEST(ShadeMotion, PathThatRunsBehindTheEyeIsFinite) {
  const ShadeMotion motion = shade_motion(receiver({0, 0, 0}), receiver({0.1, 0, 500}));
  EXPECT_TRUE(std::isfinite(motion.px));
  EXPECT_GT(motion.px, 0);
  // Both ends behind the eye: nothing of it is seen.
  EXPECT_EQ(shade_motion(receiver({0, 0, 400}), receiver({9, 0, 500})).px, 0);
}

TEST(ShadeMotion, PlaceThatCameIntoBeingCrossesTheReceiver) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NEAR(shade_motion(receiver({nan, nan, nan}), receiver({0, 0, 0})).px, 1000, 1e-9);  // 800 × 600
  EXPECT_EQ(shade_motion(receiver({nan, nan, nan}), receiver({nan, nan, nan})).px, 0);
}

TEST(ShadeMotion, WorstPlaceLiesOnTheDisplayThoughTheReceiverReachesBeyond) {
  // It appears on a receiver whose bounds reach from the left half of the display far out of it: its seen part is
  // 500 x 1000 px, and the middle of that is on the display.
  const double nan = std::numeric_limits<double>::quiet_NaN();
  LayerState then = receiver({nan, nan, nan}), now = receiver({0, 0, 0});
  now.screen_bounds_px = {{-9500, -2000}, {500, 3000}};
  const ShadeMotion motion = shade_motion(then, now);
  EXPECT_NEAR(motion.px, std::hypot(500, 1000), 1e-9);
  EXPECT_EQ(motion.where_px, dvec2(250, 500));
  // A path that runs out of the display ends at its edge.
  const ShadeMotion out = shade_motion(receiver({0, 0, 0}), receiver({1e6, 0, 0}));
  EXPECT_EQ(out.where_px.x, 1000);
}

TEST(ShadeMotion, IsAddedToTheGeometricFiducial) {
  const LayerState then = receiver({0, 0, 0}), now = receiver({0.3, 0.4, 0});
  layers::Correspondences matched;
  for (const layers::dvec2& p : {dvec2{100, 100}, dvec2{900, 100}, dvec2{900, 700}}) {
    matched.then_px.push_back(p);
    matched.now_px.push_back(p + dvec2(3, 0));
    matched.point.push_back(-1);
  }
  matched.overlap = true;
  const warp::FitResult held;  // shown where it was: 3 px off
  const Report report = assess(then, now, {}, matched, held);
  EXPECT_NEAR(report.geometric.px, 3 + 0.5 * scale(), 1e-9);
  EXPECT_NEAR(report.shade.px, 0.5 * scale(), 1e-9);
}

}  // namespace
}  // namespace talisman::fiducials
