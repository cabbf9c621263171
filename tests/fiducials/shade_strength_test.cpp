// SPDX-License-Identifier: Apache-2.0
// How strong an old shadow should be, now that the other lights have changed.
#include "fiducials/shade_strength.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace talisman::fiducials {
namespace {

using layers::dvec3;
using layers::LayerState;
using layers::Light;
using layers::LightState;
using layers::ShadeTrace;

LightState sun(double from_vertical_rad, const dvec3& color) {
  LightState light;
  light.kind = Light::Kind::Directional;
  light.direction = {std::sin(from_vertical_rad), -std::cos(from_vertical_rad), 0};
  light.color = layers::vec3(color);
  return light;
}

/// A white floor before the camera with one shadow of light 0 on it, under two suns.
struct Floor {
  explicit Floor(int light = 0) {
    shade.kind = layers::LayerKind::Shadow;
    shade.light = light;
    shade.rigid_node = 0;
    shade.plane = layers::SurfacePlane{0, {0, 0, 0}, {0, 1, 0}};
    bound.surface.emplace();
    bound.surface->base = {1, 1, 1};
  }
  static LayerState under(const LightState& first, const LightState& second) {
    LayerState state;
    state.view.display_px = {1000, 1000};
    state.world_from_receiver[3] = layers::dvec4(0, -1, -10, 1);
    state.lights = {first, second};
    state.traces.push_back({ShadeTrace::Kind::Shadow, 0, 1, true, {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}});
    return state;
  }
  Photometric compare(const LayerState& then, const LayerState& now) const {
    return shade_strength_of(then, now, bound, shade);
  }
  layers::Layer shade;
  layers::LayerBound bound;
};

constexpr double kThird = 3.14159265358979 / 3;

TEST(ShadeStrength, FollowsTheOtherLights) {
  // The second sun sinks to 60° from the vertical: its light is halved. q was 0.5 of 1, and is 0.5 of 0.75; a floor of
  // 0.75 is off by 0.75 · (2/3 - 1/2) per channel where it is in full shadow.
  const LightState first = sun(0, dvec3(0.5));
  const Photometric p =
      Floor().compare(Floor::under(first, sun(0, dvec3(0.5))), Floor::under(first, sun(kThird, dvec3(0.5))));
  EXPECT_TRUE(p.computed);
  EXPECT_NEAR(p.color, std::sqrt(3.0) * 0.75 * (2.0 / 3 - 0.5), 1e-9);
  EXPECT_EQ(p.color_light.index, 1);
  EXPECT_EQ(p.multiplier, dvec3(1));
}

TEST(ShadeStrength, PerChannelWhereAllLightsAreInOneLayer) {
  // Red and blue light do not share: as one ratio per channel nothing changes, as one number for three much does.
  const LightState red = sun(0, {0.5, 0, 0});
  const LayerState then = Floor::under(red, sun(0, {0, 0, 0.5})),
                   now = Floor::under(red, sun(kThird, {0, 0, 0.5}));
  EXPECT_EQ(Floor(-1).compare(then, now).color, 0);
  const double before = 0.2126 / (0.2126 + 0.0722), after = 0.2126 / (0.2126 + 0.0361);
  EXPECT_NEAR(Floor(0).compare(then, now).color, std::hypot(0.5, 0.25) * (after - before), 1e-6);
}

TEST(ShadeStrength, OfOneLightAloneIsOneWhateverItDoes) {
  const LightState dark = sun(0, dvec3(0));
  EXPECT_EQ(Floor()
                .compare(Floor::under(sun(0, dvec3(0.9)), dark), Floor::under(sun(kThird, dvec3(0.2)), dark))
                .color,
            0);
}

TEST(ShadeStrength, WhereNoShadowLiesNothingIsOff) {
  const LightState first = sun(0, dvec3(0.5));
  LayerState then = Floor::under(first, sun(0, dvec3(0.5))),
             now = Floor::under(first, sun(kThird, dvec3(0.5)));
  then.traces[0].on_receiver = now.traces[0].on_receiver = false;
  EXPECT_EQ(Floor().compare(then, now).color, 0);
  now.traces[0].on_receiver = true;  // it comes in, and is drawn for its place anyway
  EXPECT_GT(Floor().compare(then, now).color, 0.1);
}

TEST(ShadeStrength, HardInputsStayInRange) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const LightState first = sun(0, dvec3(0.5)), odd = sun(nan, dvec3(0.5)), bright = sun(0, dvec3(1e30));
  for (const LightState& other : {odd, bright, sun(2, dvec3(0.5))}) {
    LayerState then = Floor::under(first, first), now = Floor::under(first, other);
    for (dvec3& place : now.traces[0].places) place = dvec3(nan);
    const double color = Floor().compare(then, now).color;
    EXPECT_TRUE(color >= 0 && color <= std::sqrt(3.0)) << color;
  }
  LayerState none;
  EXPECT_EQ(Floor().compare(none, none).color, 0);
  Floor without;
  without.bound.surface.reset();
  without.bound.surface_why_not = "nothing moves";
  EXPECT_FALSE(without.compare(none, none).computed);
  EXPECT_EQ(without.compare(none, none).why_not, "nothing moves");
}

}  // namespace
}  // namespace talisman::fiducials
