// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "fiducials/fiducials.h"
#include "tests/support/correspondences.h"

namespace talisman::fiducials {
namespace {

using layers::Affine2;
using layers::Correspondences;
using layers::LayerState;
using layers::RectD;
using layers::SpritePlacement;
using tests::Pairs;
using tests::Random;
using warp::Curve;
using warp::Family;
using warp::from_affine;
using warp::kHugePx;
using warp::Warp;

LayerState state_with(const RectD& bounds) {
  LayerState state;
  state.screen_bounds_px = bounds;
  state.screen_points = {bounds.lo, {bounds.hi.x, bounds.lo.y}, bounds.hi, {bounds.lo.x, bounds.hi.y}};
  state.touches_display = !intersection(bounds, RectD{{0, 0}, {1024, 1024}}).empty();
  return state;
}

/// An axis-aligned sprite over this rectangle of the display.
SpritePlacement placed_over(const RectD& rect, layers::ClippedSides clipped = {}) {
  SpritePlacement placement;
  placement.screen_from_sprite = {1, 0, rect.lo.x, 0, 1, rect.lo.y};
  placement.size_px = {static_cast<int>(rect.width()), static_cast<int>(rect.height())};
  placement.clipped = clipped;
  return placement;
}

Correspondences matched(const Pairs& pairs) {
  Correspondences matched;
  matched.then_px.append(pairs.then_px);
  matched.now_px.append(pairs.now_px);
  for (std::size_t i = 0; i < pairs.size(); ++i) matched.point.push_back(0);
  return matched;
}

/// The visibility of a sprite cut at some sides that is carried by `warp`; the layer fills the display and
/// more.
Visibility visibility(const SpritePlacement& placement, const Warp& warp,
                      const RectD& bounds = {{-500, -500}, {1500, 1500}}) {
  warp::FitResult fitted;
  fitted.warp = warp;
  const Pairs pairs = tests::moving_box(1, 8);
  return assess(state_with(bounds), state_with(bounds), placement, matched(pairs), fitted).visibility;
}

Warp shift(double x, double y) { return from_affine(Family::Translation, {1, 0, x, 0, 1, y}); }

TEST(Geometric, IsTheLargestErrorAndItsPlace) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const Pairs pairs = tests::moving_box(seed, 14);
    const auto fitted = warp::fit(pairs.then_px, pairs.now_px, Curve::aff);
    const RectD bounds{{0, 0}, {1024, 1024}};
    const Geometric g =
        assess(state_with(bounds), state_with(bounds), placed_over(bounds), matched(pairs), fitted).geometric;
    EXPECT_NEAR(g.px, tests::largest_error(pairs, fitted.warp), 1e-9) << "seed " << seed;
    EXPECT_EQ(g.where_px, pairs.now_px[g.point]);
    EXPECT_NEAR(glm::length(fitted.warp(pairs.then_px[g.point]) - g.where_px), g.px, 1e-9);
  }
}

// The caller may assess a warp that was never measured, such as the identity of a policy that holds sprites.
TEST(Geometric, IsMeasuredAnewForTheWarpThatIsShown) {
  const Pairs pairs{{{10, 10}, {20, 10}, {10, 20}}, {{13, 14}, {20, 10}, {10, 20}}};
  const RectD bounds{{0, 0}, {100, 100}};
  const Geometric g =
      assess(state_with(bounds), state_with(bounds), placed_over(bounds), matched(pairs), {}).geometric;
  EXPECT_DOUBLE_EQ(g.px, 5);
  EXPECT_EQ(g.point, 0);
}

TEST(Geometric, UnusableFitsAndUnmatchedLayersInViewAreUnknown) {
  Pairs pairs = tests::moving_box(1, 8);
  pairs.now_px[4].x = std::nan("");
  const RectD bounds{{0, 0}, {100, 60}}, away{{2000, 0}, {2100, 60}};
  const auto bad = warp::fit(pairs.then_px, pairs.now_px, Curve::aff);
  EXPECT_EQ(
      assess(state_with(bounds), state_with(bounds), placed_over(bounds), matched(pairs), bad).geometric.px,
      kHugePx);
  const auto none = warp::fit({}, {}, Curve::aff);
  const Geometric unmatched =
      assess(state_with(bounds), state_with(bounds), placed_over(bounds), {}, none).geometric;
  EXPECT_EQ(unmatched.px, kHugePx);
  EXPECT_EQ(unmatched.where_px, dvec2(50, 30));
  EXPECT_EQ(unmatched.point, -1);
  EXPECT_EQ(assess(state_with(away), state_with(away), placed_over(bounds), {}, none).geometric.px, 0);
}

TEST(Assess, AtRestEveryFiducialIsExactlyAtItsBest) {
  Random random(3);
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Pairs box = tests::moving_box(seed, 8 + static_cast<int>(seed % 7)), rest{box.then_px, box.then_px};
    const RectD bounds{{random.uniform(-300, 300), random.uniform(-300, 300)},
                       {random.uniform(400, 1500), random.uniform(400, 1500)}};
    SpritePlacement placement = placed_over(bounds, {true, true, true, true});
    if (seed % 2 == 1) {  // a turned sprite, beside which the bounding box has corners without content
      const double angle = random.uniform(-1, 1);
      placement.screen_from_sprite = {std::cos(angle), -std::sin(angle), 300,
                                      std::sin(angle), std::cos(angle),  200};
    }
    for (Curve curve : {Curve::trn, Curve::so, Curve::aff, Curve::per, Curve::per2}) {
      const auto fitted = warp::fit(rest.then_px, rest.now_px, curve);
      const Report r = assess(state_with(bounds), state_with(bounds), placement, matched(rest), fitted);
      EXPECT_EQ(r.geometric.px, 0) << "seed " << seed;
      EXPECT_EQ(r.sampling.magnification, 1) << "seed " << seed;
      EXPECT_EQ(r.sampling.minification, 1) << "seed " << seed;
      EXPECT_EQ(r.sampling.anisotropy, 1) << "seed " << seed;
      EXPECT_TRUE(r.visibility.computed) << "seed " << seed;
      EXPECT_EQ(r.visibility.uncovered_px, 0) << "seed " << seed;
    }
  }
}

TEST(Assess, SamplingIsTakenOverTheSpriteWhereItWas) {
  const RectD rect{{100, 100}, {200, 150}};
  warp::FitResult fitted;
  fitted.warp = Warp{Family::Perspective, {1, 0, 1e-3, 0, 1, 0, 0, 0, 1}};
  const Pairs pairs = tests::moving_box(1, 8);
  const Sampling s =
      assess(state_with(rect), state_with(rect), placed_over(rect), matched(pairs), fitted).sampling;
  EXPECT_EQ(s.magnification, sampling_over(fitted.warp, rect).magnification);
  EXPECT_EQ(s.anisotropy, sampling_over(fitted.warp, rect).anisotropy);
}

TEST(Visibility, IsNotComputedWithoutACutSide) {
  const Visibility v = visibility(placed_over({{0, 0}, {100, 100}}), shift(5, 5));
  EXPECT_FALSE(v.computed);
  EXPECT_EQ(v.why_not, "no side of the sprite was cut off");
  EXPECT_EQ(v.uncovered_px, 0);
}

TEST(Visibility, IsNotComputedForNothing) {
  EXPECT_EQ(visibility(SpritePlacement{}, shift(5, 5)).why_not, "nothing was drawn");
  const auto out_of_view =
      visibility(placed_over({{0, 0}, {9, 9}}, {.left = true}), shift(5, 5), {{2000, 0}, {3000, 10}});
  EXPECT_EQ(out_of_view.why_not, "the layer is out of view");
  EXPECT_FALSE(out_of_view.computed);
}

TEST(Visibility, EachSideThatMovesInIsAsDeepAsItsMove) {
  const RectD display{{0, 0}, {1024, 1024}};
  EXPECT_DOUBLE_EQ(visibility(placed_over(display, {.left = true}), shift(7, 0)).uncovered_px, 7);
  EXPECT_DOUBLE_EQ(visibility(placed_over(display, {.right = true}), shift(-8, 3)).uncovered_px, 8);
  EXPECT_DOUBLE_EQ(visibility(placed_over(display, {.top = true}), shift(2, 9)).uncovered_px, 9);
  EXPECT_DOUBLE_EQ(visibility(placed_over(display, {.bottom = true}), shift(0, -10)).uncovered_px, 10);
}

TEST(Visibility, SidesThatMoveOutOrWereNotCutDoNotCount) {
  const RectD display{{0, 0}, {1024, 1024}};
  const Visibility out = visibility(placed_over(display, {.left = true}), shift(-7, 0));
  EXPECT_TRUE(out.computed);
  EXPECT_EQ(out.uncovered_px, 0);
  EXPECT_EQ(visibility(placed_over(display, {.left = true}), shift(0, 7)).uncovered_px, 0);
}

// Extents that were grown in advance hide the same motion.
TEST(Visibility, GrownExtentsAbsorbTheMotion) {
  const RectD grown{{-20, 0}, {1024, 1024}};
  EXPECT_EQ(visibility(placed_over(grown, {.left = true}), shift(19, 0)).uncovered_px, 0);
  EXPECT_DOUBLE_EQ(visibility(placed_over(grown, {.left = true}), shift(23, 0)).uncovered_px, 3);
}

// Where the layer ends before the display does, there is nothing to be uncovered.
TEST(Visibility, OnlyWhereTheLayerHasContentNow) {
  const RectD display{{0, 0}, {1024, 1024}}, low{{-100, 600}, {900, 800}}, right{{4, 0}, {900, 800}};
  const Visibility v = visibility(placed_over(display, {.left = true}), shift(7, 0), low);
  EXPECT_DOUBLE_EQ(v.uncovered_px, 7);
  EXPECT_GE(v.where_px.y, 600);
  EXPECT_LE(v.where_px.y, 800);
  EXPECT_EQ(v.where_px.x, 0);
  EXPECT_DOUBLE_EQ(visibility(placed_over(display, {.left = true}), shift(7, 0), right).uncovered_px, 3);
}

// A turn uncovers a wedge: as deep as the end of the side has come in.
TEST(Visibility, ATurnUncoversAWedge) {
  const double angle = 0.01;
  const Affine2 turn{std::cos(angle),  std::sin(angle), 0,
                     -std::sin(angle), std::cos(angle), 0};  // about the corner (0, 0)
  const Visibility v =
      visibility(placed_over({{0, 0}, {1024, 1024}}, {.left = true}), from_affine(Family::Affine, turn));
  EXPECT_NEAR(v.uncovered_px, 1024 * std::sin(angle), 0.2);
  EXPECT_NEAR(v.where_px.x, 0, 1e-9);
  EXPECT_NEAR(v.where_px.y, 1024, 1);
}

// Beyond the ends of a short side there is no content of this sprite's to miss.
TEST(Visibility, AShortSideLooksOnlyStraightAcross) {
  const double angle = 0.1;
  const Affine2 turn{std::cos(angle), std::sin(angle), 0, -std::sin(angle), std::cos(angle), 0};
  const Visibility v =
      visibility(placed_over({{0, 0}, {300, 50}}, {.left = true}), from_affine(Family::Affine, turn));
  EXPECT_LT(v.uncovered_px, 50 * std::tan(angle) + 1);
}

// A floor that rises to the left beyond the display: its bounding box has a corner without content on it.
TEST(Visibility, OnlyTheOutlineIsContent) {
  LayerState state = state_with({{-1000, 200}, {1024, 1024}});
  state.screen_points = {{-1000, 200}, {1024, 604.8}, {1024, 1024}, {-1000, 1024}};  // at x = 0: 400
  const SpritePlacement placement = placed_over({{0, 400}, {1024, 1024}}, {.top = true});
  warp::FitResult fitted;
  fitted.warp = shift(0, 10);
  const Pairs pairs = tests::moving_box(1, 8);
  const Visibility v = assess(state, state, placement, matched(pairs), fitted).visibility;
  EXPECT_DOUBLE_EQ(v.uncovered_px, 10);  // 0 … 400 was above the side then, and 10 more now
  EXPECT_DOUBLE_EQ(v.where_px.x, 0);
}

TEST(Visibility, AHorizonThroughTheSpriteUncoversEverything) {
  const Warp beyond{Family::Perspective, {1, 0, -0.01, 0, 1, 0, 0, 0, 1}};
  const Visibility v = visibility(placed_over({{0, 0}, {1024, 1024}}, {.left = true}), beyond);
  EXPECT_NEAR(v.uncovered_px, 1024 * std::sqrt(2.0), 1e-9);
}

TEST(Assess, HardCasesNeverGiveANonFiniteFigure) {
  const RectD bounds{{-50, -50}, {1100, 1100}};
  for (const auto& hard : tests::hard_cases())
    for (Curve curve : {Curve::trn, Curve::iso, Curve::so, Curve::aff, Curve::per, Curve::per2}) {
      const auto fitted = warp::fit(hard.pairs.then_px, hard.pairs.now_px, curve);
      const Report r = assess(state_with(bounds), state_with(bounds),
                              placed_over(bounds, {true, true, true, true}), matched(hard.pairs), fitted);
      EXPECT_TRUE(std::isfinite(r.geometric.px)) << hard.name;
      EXPECT_TRUE(std::isfinite(r.sampling.magnification) && std::isfinite(r.sampling.anisotropy))
          << hard.name;
      EXPECT_TRUE(std::isfinite(r.sampling.minification)) << hard.name;
      EXPECT_TRUE(std::isfinite(r.visibility.uncovered_px)) << hard.name;
      EXPECT_TRUE(std::isfinite(r.visibility.where_px.x) && std::isfinite(r.visibility.where_px.y))
          << hard.name;
    }
}

}  // namespace
}  // namespace talisman::fiducials
