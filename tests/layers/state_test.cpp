// SPDX-License-Identifier: Apache-2.0
#include "layers/state.h"

#include <limits>

#include <gtest/gtest.h>

#include "layers/clip.h"
#include "tests/layers/worlds.h"
#include "tests/support/scenes.h"

namespace talisman::tests {
namespace {

using layers::CameraState;
using layers::LayerState;

constexpr double kNanState = std::numeric_limits<double>::quiet_NaN();

dvec2 screen_of(const CameraState& camera, layers::ivec2 display, const dvec3& world) {
  return layers::screen_from_clip(layers::clip_from_world(camera, display) * dvec4(world, 1), display);
}

TEST(ClipFromWorld, CornersAndDepthsOfTheView) {
  CameraState camera;
  camera.fov_y_rad = 2 * std::atan(0.5);  // half a metre up at a distance of one
  camera.near_m = 2;
  camera.far_m = 10;
  const layers::ivec2 display(400, 200);
  const auto matrix = layers::clip_from_world(camera, display);
  const dvec4 near_top_right = matrix * dvec4(2, 1, -2, 1), far_bottom_left = matrix * dvec4(-10, -5, -10, 1);
  EXPECT_NEAR(glm::length(near_top_right - dvec4(2, 2, -2, 2)), 0, 1e-12);
  EXPECT_NEAR(glm::length(far_bottom_left - dvec4(-10, -10, 10, 10)), 0, 1e-12);
  // The screen's y points down.
  EXPECT_NEAR(glm::length(layers::screen_from_clip(near_top_right, display) - dvec2(400, 0)), 0, 1e-9);
  EXPECT_NEAR(glm::length(layers::screen_from_clip(far_bottom_left, display) - dvec2(0, 200)), 0, 1e-9);
}

TEST(ClipFromWorld, AMovedCameraSeesWhatItLooksAtInTheCentre) {
  const auto camera = camera_at(moved_by({5, 6, 7}) * turned_by(0.8, {0, 1, 0}));
  const dvec3 ahead = dvec3(camera.world_from_camera * dvec4(0, 0, -9, 1));
  EXPECT_NEAR(glm::length(screen_of(camera, {640, 480}, ahead) - dvec2(320, 240)), 0, 1e-9);
}

TEST(ClipFromWorld, ADisplayWithoutAreaIsFinite) {
  const auto matrix = layers::clip_from_world({}, {0, 0});
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(std::isfinite(glm::length(matrix[i])));
}

TEST(Capture, ABoxInViewHasTheBoundsOfItsCorners) {
  const World world(box_corners({1, 1, 1}));
  const LayerState state = world.at(moved_by({0.3, 0, -10}));
  ASSERT_TRUE(state.in_view());
  EXPECT_FALSE(state.clipped);
  EXPECT_TRUE(state.touches_display);
  EXPECT_NEAR(state.nearest_w_m, 9, 1e-12);
  EXPECT_EQ(state.clip_points.size(), 8u);
  EXPECT_EQ(state.world_points.size(), 8u);
  // The widest corners are the nearest ones.
  const dvec2 hi = screen_of({}, world.view.display_px, {1.3, -1, -9});
  EXPECT_NEAR(glm::length(state.screen_bounds_px.hi - hi), 0, 1e-9);
}

TEST(Capture, BoundsEndAtTheEnlargedView) {
  const World world(box_corners({100, 0.1, 0.1}));
  const LayerState state = world.at(moved_by({0, 0, -10}));
  EXPECT_TRUE(state.clipped);
  EXPECT_NEAR(state.screen_bounds_px.lo.x, -256, 1e-6);
  EXPECT_NEAR(state.screen_bounds_px.hi.x, 1024 + 256, 1e-6);
}

TEST(Capture, ABoxBesideTheDisplayButInTheMarginDoesNotTouchIt) {
  const World world(box_corners({0.1, 0.1, 0.1}));
  // Half the display at 10 m is 10 tan(0.45) = 4.83 m.
  const LayerState state = world.at(moved_by({6, 0, -10}));
  EXPECT_TRUE(state.in_view());
  EXPECT_FALSE(state.clipped);
  EXPECT_FALSE(state.touches_display);
  EXPECT_FALSE(world.at(moved_by({9, 0, -10})).in_view());
}

TEST(Capture, BehindTheCameraIsOutOfView) {
  const World world(box_corners({1, 1, 1}));
  const LayerState state = world.at(moved_by({0, 0, 10}));
  EXPECT_FALSE(state.in_view());
  EXPECT_FALSE(state.touches_display);
  EXPECT_FALSE(state.clipped);
  EXPECT_EQ(state.nearest_w_m, 0);
}

TEST(Capture, TheNearestDepthOfASolidAroundTheCameraIsTheNearPlane) {
  // Inside a dome no face is near, but the solid starts at the near plane; beside it, its faces decide.
  const World dome(box_corners({50, 50, 50}));
  EXPECT_DOUBLE_EQ(dome.at(dmat4(1.0)).nearest_w_m, 0.1);
  const dmat4 mirrored = glm::scale(dmat4(1.0), dvec3(-1, 1, 1));
  EXPECT_DOUBLE_EQ(dome.at(mirrored).nearest_w_m, 0.1);
  EXPECT_NEAR(dome.at(moved_by({0, 0, -57})).nearest_w_m, 7, 1e-9);
}

TEST(Capture, ACrossedNearPlaneIsTheNearestDepth) {
  const World wall(box_corners({0.5, 0.5, 20}));
  const LayerState state = wall.at(moved_by({0, -0.8, 0}));
  EXPECT_TRUE(state.clipped);
  EXPECT_GT(state.nearest_w_m, 0.1);
  EXPECT_LT(state.nearest_w_m, 1.0);
}

TEST(Capture, PointsAroundTheNearPlaneByABillionth) {
  // A square that faces the camera at near · (1 ± 1e-9): either side of the plane, the numbers stay finite.
  const World square(box_corners({0.01, 0.01, 0}));
  for (const double distance : {0.1 * (1 - 1e-9), 0.1, 0.1 * (1 + 1e-9), 0.1 * (1 + 4e-9)}) {
    const LayerState state = square.at(moved_by({0, 0, -distance}));
    EXPECT_LT(state.screen_bounds_px.width(), 1024);
    if (distance <= 0.1) {
      EXPECT_FALSE(state.in_view());
    }
    if (state.in_view()) {
      EXPECT_GT(state.nearest_w_m, 0.1);
    }
  }
  EXPECT_TRUE(square.at(moved_by({0, 0, -0.1 * (1 + 4e-9)})).in_view());
}

TEST(Capture, NothingFiniteIsOutOfView) {
  const World world(box_corners({1, 1, 1}));
  CameraState camera;
  camera.world_from_camera[3][0] = kNanState;
  EXPECT_TRUE(world.at(moved_by({0, 0, -5}), camera).clip_points.empty());
  EXPECT_FALSE(world.at(moved_by({0, 0, -5}), camera).in_view());
  EXPECT_FALSE(world.at(glm::scale(dmat4(1.0), dvec3(1e300)) * moved_by({0, 0, -1e300})).in_view());
  for (const double bad : {0.0, -1.0, kNanState}) {
    camera = {};
    camera.near_m = bad;
    EXPECT_FALSE(world.at(moved_by({0, 0, -5}), camera).in_view()) << bad;
  }
  camera = {};
  camera.world_from_camera = dmat4(0.0);  // has no inverse
  EXPECT_FALSE(world.at(moved_by({0, 0, -5}), camera).in_view());
}

TEST(Capture, ADisplayWithoutAreaSeesNothing) {
  World world(box_corners({1, 1, 1}));
  for (const layers::ivec2 display : {layers::ivec2(0, 0), layers::ivec2(640, 0), layers::ivec2(-5, 480)}) {
    world.view.display_px = display;
    EXPECT_FALSE(world.at(moved_by({0, 0, -5})).in_view());
  }
}

TEST(Capture, AnEmptyLayerIsOutOfView) {
  const World world({});
  const LayerState state = world.at(moved_by({0, 0, -5}));
  EXPECT_FALSE(state.in_view());
  EXPECT_EQ(state.world_from_part.size(), 1u);
}

TEST(Capture, DegenerateHullsAreInView) {
  for (const dvec3 half_size : {dvec3(0, 0, 0), dvec3(1, 0, 0), dvec3(0, 0, 1), dvec3(1, 1, 0)}) {
    const World world(box_corners(half_size));
    const LayerState state = world.at(moved_by({0.1, 0.2, -5}));
    EXPECT_TRUE(state.in_view());
    EXPECT_TRUE(state.touches_display);
    EXPECT_NEAR(state.nearest_w_m, 5 - half_size.z, 1e-12);
  }
}

TEST(Capture, LightsMatterOnlyToLitParts) {
  World world(box_corners({1, 1, 1}));
  EXPECT_EQ(world.at(dmat4(1.0)).lights.size(), 1u);
  world.scene.materials[0].unlit = true;
  EXPECT_TRUE(world.at(dmat4(1.0)).lights.empty());
  // Without a material a part has the default one, which is lit.
  world.scene.parts[0].material = -1;
  EXPECT_EQ(world.at(dmat4(1.0)).lights.size(), 1u);
}

TEST(SamePixels, EachThingThatChangesPixelsIsSeenAndTimeIsNot) {
  World world(box_corners({1, 1, 1}));
  const dmat4 place = moved_by({0, 0, -5});
  const LayerState state = world.at(place);
  LayerState other = world.at(place);
  other.time_s = 99;
  EXPECT_TRUE(state.same_pixels(other));
  // One unit in the last place is a change.
  EXPECT_FALSE(state.same_pixels(world.at(moved_by({0, 0, std::nextafter(-5.0, 0.0)}))));
  CameraState camera;
  camera.fov_y_rad = std::nextafter(camera.fov_y_rad, 0.0);
  EXPECT_FALSE(state.same_pixels(world.at(place, camera)));
  world.lights[0].color.x = 0.5f;
  EXPECT_FALSE(state.same_pixels(world.at(place)));
  world.lights[0].color.x = 1;
  EXPECT_TRUE(state.same_pixels(world.at(place)));
  world.view.display_px.x += 1;
  EXPECT_FALSE(state.same_pixels(world.at(place)));
}

TEST(SamePixels, LightsDoNotChangeAnUnlitLayer) {
  World world(box_corners({1, 1, 1}));
  world.scene.materials[0].unlit = true;
  const LayerState state = world.at(dmat4(1.0));
  world.lights[0].color.x = 0.5f;
  EXPECT_TRUE(state.same_pixels(world.at(dmat4(1.0))));
}

TEST(SamePixels, NotANumberIsNeverTheSame) {
  const World world(box_corners({1, 1, 1}));
  const LayerState state = world.at(moved_by({0, kNanState, -5}));
  EXPECT_FALSE(state.same_pixels(state));
}

TEST(Capture, SkinnedPartsAddTheirJointsToWhatIsCompared) {
  const layers::Scene scene = skinned_bar_scene();
  const auto set = factor(scene, one_layer_per_part(scene));
  const auto bound = make_layer_bound(scene, set.layers[0], layers::BoundKind::Box8);
  const auto at = [&](double time) { return capture(scene.at(time), set.layers[0], bound, {}); };
  EXPECT_EQ(at(0).world_from_part.size(), 1 + scene.skins[0].joints.size());
  EXPECT_TRUE(at(0).same_pixels(at(0)));
  // The node of the part stands still; only its joints bend.
  EXPECT_EQ(at(0).world_from_part[0], at(0.5).world_from_part[0]);
  EXPECT_FALSE(at(0).same_pixels(at(0.5)));
}

TEST(Capture, EveryVertexInViewIsInsideTheBoundsAndNotNearerThanTheNearest) {
  const layers::Scene scene = moving_scene();
  const auto set = factor(scene, one_layer_per_part(scene));
  layers::View view;
  view.display_px = {320, 240};
  int seen = 0;
  for (const auto& layer : set.layers) {
    const auto bound = make_layer_bound(scene, layer, layers::BoundKind::Dop26);
    for (double time = 0; time < 4; time += 0.25) {
      const auto frame = scene.at(time);
      const LayerState state = capture(frame, layer, bound, view);
      const dmat4 clip_from_world = layers::clip_from_world(frame.camera, view.display_px);
      for (const dvec3& p : world_positions(frame, scene.parts[layer.parts[0]])) {
        const dvec4 clip = clip_from_world * dvec4(p, 1);
        if (layers::outcode(layers::view_half_spaces(frame.camera.near_m, view.clip_margin, 0), clip) != 0)
          continue;
        ++seen;
        ASSERT_TRUE(state.in_view());
        const dvec2 screen = layers::screen_from_clip(clip, view.display_px);
        EXPECT_GE(std::min(screen.x - state.screen_bounds_px.lo.x, screen.y - state.screen_bounds_px.lo.y),
                  -1e-4);
        EXPECT_GE(std::min(state.screen_bounds_px.hi.x - screen.x, state.screen_bounds_px.hi.y - screen.y),
                  -1e-4);
        EXPECT_GE(clip.w, state.nearest_w_m * (1 - 1e-6));
      }
    }
  }
  EXPECT_GT(seen, 1000);
}

void expect_same_state(const LayerState& a, const LayerState& b) {
  EXPECT_TRUE(a.same_pixels(b));
  EXPECT_EQ(a.time_s, b.time_s);
  EXPECT_EQ(a.world_points, b.world_points);
  EXPECT_EQ(a.clip_points, b.clip_points);
  EXPECT_EQ(a.screen_points, b.screen_points);
  EXPECT_EQ(a.world_from_body, b.world_from_body);
  EXPECT_EQ(a.world_normals, b.world_normals);
  EXPECT_EQ(a.point_colors, b.point_colors);
  EXPECT_EQ(a.screen_bounds_px, b.screen_bounds_px);
  EXPECT_EQ(a.touches_display, b.touches_display);
  EXPECT_EQ(a.clipped, b.clipped);
  EXPECT_EQ(a.nearest_w_m, b.nearest_w_m);
  EXPECT_EQ(a.world_from_receiver, b.world_from_receiver);
  EXPECT_EQ(a.traces.size(), b.traces.size());
}

// A state that held another layer at another time, in view, cut or out of view, with colours or without, must
// not show that.
TEST(FrameCapture, AStateThatIsUsedAgainIsAsGoodAsANewOne) {
  const layers::Scene scene = moving_scene();
  const layers::LayerSet set = layers::factor(scene, one_layer_per_part(scene));
  std::vector<layers::LayerBound> bounds;
  for (const layers::Layer& layer : set.layers) {
    bounds.push_back(layers::make_layer_bound(scene, layer, static_cast<layers::BoundKind>(layer.id % 3)));
    bounds.back().follows_faces = layer.id % 2 == 0;
    if (layer.id % 2 == 1) bounds.back().surface = layers::mean_surface(scene, layer);
  }
  std::mt19937 random(4);
  LayerState used;
  used.traces.resize(2);
  used.world_from_influence.resize(3);
  used.world_from_receiver = dmat4(7.0);
  for (int k = 0; k < 300; ++k) {
    SCOPED_TRACE("step " + std::to_string(k));
    const layers::Layer& layer = set.layers[random() % set.layers.size()];
    layers::SceneFrame frame = scene.at(uniform(random, 0, 10));
    if (k % 5 == 0) frame.camera = camera_at(moved_by(uniform3(random, -6, 6)) * random_rotation(random));
    if (k % 17 == 0) frame.camera.near_m = -1;  // nothing can be in view
    const layers::View view{{320, 240}, k % 2 == 0 ? 0.25 : 0.0};
    layers::FrameCapture(frame, view).capture(layer, bounds[layer.id], used);
    expect_same_state(used, capture(frame, layer, bounds[layer.id], view));
  }
}

TEST(BoundsOf, NoPointsAreEmpty) { EXPECT_TRUE(layers::bounds_of({}).empty()); }

TEST(BoundsOf, PointsAreEnclosed) {
  const std::vector<dvec3> points{{1, 5, -2}, {-3, 4, 8}};
  EXPECT_EQ(layers::bounds_of(points).lo, dvec3(-3, 4, -2));
  EXPECT_EQ(layers::bounds_of(points).hi, dvec3(1, 5, 8));
}

}  // namespace
}  // namespace talisman::tests
