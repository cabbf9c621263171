// SPDX-License-Identifier: Apache-2.0
#include "warp/quadrilateral.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/support/correspondences.h"
#include "warp/conditioning.h"

namespace talisman::warp {
namespace {

using layers::Correspondences;
using layers::dmat4;
using layers::dvec4;
using layers::LayerState;
using tests::Random;

/// A state with these world points in front of a camera at the origin that looks along -z.
LayerState state_of(std::vector<dvec3> points, const dmat4& world_from_camera = dmat4(1)) {
  LayerState state;
  state.camera.world_from_camera = world_from_camera;
  state.world_points = std::move(points);
  const dmat4 clip = layers::clip_from_world(state.camera, state.view.display_px);
  for (const dvec3& p : state.world_points) state.clip_points.push_back(clip * dvec4(p, 1));
  return state;
}

Correspondences match(const LayerState& then, const LayerState& now) {
  Correspondences matched;
  for (std::size_t i = 0; i < then.clip_points.size(); ++i) {
    matched.then_px.push_back(layers::screen_from_clip(then.clip_points[i], then.view.display_px));
    matched.now_px.push_back(layers::screen_from_clip(now.clip_points[i], now.view.display_px));
    matched.point.push_back(static_cast<int>(i));
  }
  return matched;
}

std::vector<dvec3> box(dvec3 centre, dvec3 half) {
  std::vector<dvec3> points;
  for (int i = 0; i < 8; ++i)
    points.push_back(centre +
                     half * dvec3{(i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1});
  return points;
}

std::vector<dvec3> moved(std::vector<dvec3> points, const dmat4& by) {
  for (auto& p : points) p = dvec3(by * dvec4(p, 1));
  return points;
}

/// A turn about the point (0, 0, -10) and a small move.
dmat4 small_motion(double angle_rad, dvec3 axis = {0, 1, 0}) {
  const dvec3 centre{0, 0, -10};
  return glm::translate(dmat4(1), dvec3{0.2, -0.1, 0.3} + centre) *
         glm::rotate(dmat4(1), angle_rad, glm::normalize(axis)) * glm::translate(dmat4(1), -centre);
}

// A flat object that faces the eye lies in the quadrilateral: the warp is exact under any rigid motion.
TEST(FitShade, AFlatObjectFacingTheEyeIsExact) {
  const auto points = box({0, 0, -10}, {1, 0.7, 0});
  const LayerState then = state_of(points), now = state_of(moved(points, small_motion(0.5)));
  const FitResult r = fit_shade(then, now, match(then, now));
  EXPECT_EQ(r.status, FitStatus::Converged);
  EXPECT_EQ(r.warp.family, Family::Perspective);
  EXPECT_LT(r.max_px, 1e-6);
}

// Off the axis the quadrilateral faces the eye, not the display: a plane that faces the eye there is the
// exact case.
TEST(FitShade, FacesTheEyeAlsoOffTheAxis) {
  const dvec3 centre{3, 1, -10}, forward = glm::normalize(centre),
                                 right = glm::normalize(glm::cross(forward, dvec3(0, 1, 0)));
  const dvec3 up = glm::cross(right, forward);
  std::vector<dvec3> points;
  for (double x : {-1.0, 1.0})
    for (double y : {-1.0, 1.0}) points.push_back(centre + x * right + 0.5 * y * up);
  const LayerState then = state_of(points), now = state_of(moved(points, small_motion(0.2, {1, 2, 0.5})));
  const FitResult r = fit_shade(then, now, match(then, now));
  EXPECT_EQ(r.status, FitStatus::Converged);
  EXPECT_LT(r.max_px, 1e-6);
}

// The camera may move instead of the object.
TEST(FitShade, FollowsAMovingCamera) {
  const auto points = box({0, 0, -10}, {1, 0.7, 0});
  const LayerState then = state_of(points), now = state_of(points, small_motion(0.3));
  const FitResult r = fit_shade(then, now, match(then, now));
  EXPECT_EQ(r.status, FitStatus::Converged);
  EXPECT_LT(r.max_px, 1e-6);
}

// [LS97 4.2]: Shade's method is outperformed by the least squares over the points, because it does not look
// at them.
TEST(FitShade, OnBoxesItIsWorseThanTheRefinedAndTheAffineFitInRms) {
  int worse_than_affine = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    const auto points =
        box({random.uniform(-2, 2), random.uniform(-2, 2), -10}, {1, 0.7, random.uniform(0.2, 1)});
    const LayerState then = state_of(points);
    const LayerState now =
        state_of(moved(points, small_motion(random.uniform(0.02, 0.1), {random.uniform(-1, 1), 1, 0})));
    const auto matched = match(then, now);
    const FitResult shade = fit(then, now, matched, Curve::pers),
                    refined = fit(then, now, matched, Curve::pers2);
    const FitResult affine = fit(then, now, matched, Curve::aff),
                    post_divide = fit(then, now, matched, Curve::per2);
    ASSERT_EQ(shade.status, FitStatus::Converged) << "seed " << seed;
    EXPECT_LE(refined.rms_px, shade.rms_px * (1 + 1e-9)) << "seed " << seed;
    EXPECT_NEAR(refined.rms_px, post_divide.rms_px, 1e-6 * post_divide.rms_px) << "seed " << seed;
    if (shade.rms_px > affine.rms_px) ++worse_than_affine;
  }
  EXPECT_GT(worse_than_affine, 90);
}

TEST(FitShade, AtRestIsTheIdentity) {
  const LayerState state = state_of(box({0, 0, -10}, {1, 1, 1}));
  for (Curve curve : {Curve::pers, Curve::pers2}) {
    const FitResult r = fit(state, state, match(state, state), curve);
    EXPECT_EQ(r.status, FitStatus::Converged);
    EXPECT_TRUE(r.warp.is_identity());
    EXPECT_EQ(r.max_px, 0);
  }
}

// A corner of the quadrilateral that has passed the near plane has no image; the affine fit of the remaining
// points stands in.
TEST(FitShade, ACornerBehindTheEyeFallsBackToAffine) {
  const auto points = box({0, 0, -2}, {1.5, 1.5, 0.2});
  const dmat4 turned = glm::translate(dmat4(1), dvec3(0, 0, -0.6)) *
                       glm::rotate(dmat4(1), 1.5, dvec3(0, 1, 0)) * glm::translate(dmat4(1), dvec3(0, 0, 2));
  const LayerState then = state_of(points), now = state_of(moved(points, turned));
  Correspondences matched;  // correspond() would have left out the points behind the eye
  const auto all = match(then, now);
  for (std::size_t i = 0; i < all.then_px.size(); ++i)
    if (now.clip_points[i].w > now.camera.near_m) {
      matched.then_px.push_back(all.then_px[i]);
      matched.now_px.push_back(all.now_px[i]);
    }
  ASSERT_LT(matched.then_px.size(), all.then_px.size());
  const FitResult r = fit_shade(then, now, matched);
  EXPECT_NE(r.status, FitStatus::Converged);
  EXPECT_NE(r.warp.family, Family::Perspective);
  EXPECT_TRUE(std::isfinite(r.max_px));
}

// The eye inside the box; no points; one point; points on a line; NaN: never an exception, never a non-finite
// number.
TEST(FitShade, DegenerateLayersGiveSoundResults) {
  const std::vector<std::vector<dvec3>> layers{{},
                                               {{0, 0, -5}},
                                               box({0, 0, 0}, {1, 1, 1}),
                                               box({0, 0, -5}, {1, 0, 0}),
                                               box({0, 0, -5}, {0, 0, 0}),
                                               box({0, 0, -5}, {std::nan(""), 1, 1}),
                                               box({0, 0, 5}, {1, 1, 1}),
                                               box({0, 0, -1e9}, {1e-6, 1e-6, 1e-6})};
  for (std::size_t i = 0; i < layers.size(); ++i)
    for (Curve curve : {Curve::pers, Curve::pers2}) {
      const LayerState then = state_of(layers[i]), now = state_of(moved(layers[i], small_motion(0.1)));
      const auto matched = match(then, now);
      const FitResult r = fit(then, now, matched, curve);
      EXPECT_TRUE(std::isfinite(r.max_px) && std::isfinite(r.rms_px)) << "layer " << i;
      if (r.usable() && !matched.then_px.empty()) {
        EXPECT_TRUE(acceptable(r.warp, matched.then_px)) << "layer " << i;
      }
    }
}

TEST(FitLayers, OtherCurvesIgnoreTheLayerInSpace) {
  const auto points = box({0, 0, -10}, {1, 0.7, 0.5});
  const LayerState then = state_of(points), now = state_of(moved(points, small_motion(0.1)));
  const auto matched = match(then, now);
  for (Curve curve : {Curve::trn, Curve::so, Curve::aff, Curve::per, Curve::per2})
    EXPECT_EQ(fit(then, now, matched, curve).warp, fit(matched.then_px, matched.now_px, curve).warp)
        << name(curve);
}

}  // namespace
}  // namespace talisman::warp
