// SPDX-License-Identifier: Apache-2.0
#include "warp/homography.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "tests/support/correspondences.h"
#include "warp/ceres_reference.h"

namespace talisman::warp {
namespace {

using namespace tests;

FitResult fit_homography(const Pairs& pairs, Curve curve) {
  return warp::fit(pairs.then_px, pairs.now_px, curve);
}

/// The homogeneous sum of squares in normalised coordinates, H scaled to denominator 1 at the centroid: what
/// `per` minimises.
double homogeneous_cost(const Pairs& pairs, const Warp& warp) {
  const PerspectiveFrame frame = perspective_frame(pairs.now_px, spread_of(pairs.then_px));
  const double unit = warp.denominator(frame.then.centroid);
  double sum = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const double w = warp.denominator(pairs.then_px[i]) / unit;
    const dvec2 r =
        (frame.normalised_now(warp(pairs.then_px[i])) - frame.normalised_now(pairs.now_px[i])) * w;
    sum += r.x * r.x + r.y * r.y;
  }
  return sum;
}

TEST(PerspectiveFrame, NormalisesBothSidesAndComesBack) {
  const Pairs pairs = moving_box(4, 14);
  const PerspectiveFrame frame = perspective_frame(pairs.now_px, spread_of(pairs.then_px));
  double then_square = 0, now_square = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const dvec2 q = frame.normalised_then(pairs.then_px[i]), p = frame.normalised_now(pairs.now_px[i]);
    then_square += glm::dot(q, q) / 14;
    now_square += glm::dot(p, p) / 14;
    const dvec2 there = frame.to_pixels(dmat3(1.0))(pairs.then_px[i]);
    EXPECT_LT(glm::length(frame.normalised_now(there) - q), 1e-12);
  }
  EXPECT_NEAR(then_square, 2, 1e-12);
  EXPECT_NEAR(now_square, 2, 1e-12);
}

TEST(FitPerspective, ExactHomographiesAreRecovered) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const int n = 4 + static_cast<int>(seed % 12);
    const Pairs pairs = exact_perspective(seed, n, gentle_perspective(seed), 200);
    for (Curve curve : {Curve::per, Curve::per2, Curve::pers2}) {
      const FitResult r = fit_homography(pairs, curve);
      // Four random points may lie nearly on a line with a third: there the answer may be a simpler family.
      if (n == 4 && r.status == FitStatus::Degenerate) continue;
      EXPECT_EQ(r.status, FitStatus::Converged) << name(curve) << " seed " << seed;
      EXPECT_LT(r.max_px, 1e-8) << name(curve) << " seed " << seed << " n " << n;
    }
  }
}

// Four points in general position always have one exact homography.
TEST(FitPerspective, FourCornersOfAQuadrilateralAreExact) {
  const Pairs pairs{{{0, 0}, {100, 0}, {100, 100}, {0, 100}}, {{10, 5}, {90, 20}, {80, 80}, {5, 95}}};
  for (Curve curve : {Curve::per, Curve::per2, Curve::peri, Curve::per2i, Curve::pers2}) {
    const FitResult r = fit_homography(pairs, curve);
    EXPECT_EQ(r.status, FitStatus::Converged) << name(curve);
    EXPECT_EQ(r.warp.family, Family::Perspective) << name(curve);
    EXPECT_LT(r.max_px, 1e-6) << name(curve);
  }
}

// Only three of the four are different: g and h are anything.
TEST(FitPerspective, FourPointsWithADuplicateFallBackToAffine) {
  const Pairs pairs{{{0, 0}, {100, 0}, {100, 100}, {0, 0}}, {{1, 2}, {103, 0}, {99, 104}, {1, 2}}};
  for (Curve curve : {Curve::per, Curve::per2}) {
    const FitResult r = fit_homography(pairs, curve);
    EXPECT_EQ(r.status, FitStatus::Degenerate) << name(curve);
    EXPECT_EQ(r.warp.family, Family::Affine) << name(curve);
    EXPECT_LT(r.max_px, 1e-9) << name(curve);
  }
}

// A quadrilateral that becomes non-convex needs a horizon between its corners: no sprite can be shown through
// that.
TEST(FitPerspective, AHorizonAmongThePointsFallsBackToAffine) {
  const Pairs dart{{{0, 0}, {100, 0}, {100, 100}, {0, 100}}, {{0, 0}, {100, 0}, {20, 20}, {0, 100}}};
  const Pairs split = exact_perspective(24, 12, {1, 0, 0.01, 0, 1, 0, 0, 0, -5.12});
  for (Curve curve : {Curve::per, Curve::per2}) {
    EXPECT_EQ(fit_homography(dart, curve).status, FitStatus::Degenerate) << name(curve);
    EXPECT_NE(fit_homography(dart, curve).warp.family, Family::Perspective) << name(curve);
    EXPECT_EQ(fit_homography(split, curve).status, FitStatus::Degenerate) << name(curve);
    EXPECT_NE(fit_homography(split, curve).warp.family, Family::Perspective) << name(curve);
  }
}

// The minimum of a quadratic form: no step in any of the eight directions lowers it.
TEST(FitHomogeneous, NoNearbyHomographyHasASmallerHomogeneousSum) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const Pairs pairs = with_noise(moving_box(seed, 14), seed, 1);
    const Spread spread = spread_of(pairs.then_px);
    const FitResult best = fit_homogeneous(pairs.then_px, pairs.now_px, spread);
    ASSERT_EQ(best.status, FitStatus::Converged);
    const double cost = homogeneous_cost(pairs, best.warp);
    Random random(seed);
    for (int trial = 0; trial < 50; ++trial) {
      Warp other = best.warp;
      const PerspectiveFrame frame = perspective_frame(pairs.now_px, spread);
      dmat3 nudge(1.0);
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r)
          if (c < 2 || r < 2) nudge[c][r] += random.uniform(-1e-3, 1e-3);
      const Warp to_px = frame.to_pixels(nudge), identity = frame.to_pixels(dmat3(1.0));
      other.now_from_then =
          best.warp.now_from_then * (inverse(identity)->now_from_then * to_px.now_from_then);
      EXPECT_GE(homogeneous_cost(pairs, other), cost * (1 - 1e-9)) << "seed " << seed;
    }
  }
}

TEST(FitPostDivide, EqualsCeresOnTheWorkload) {
  double worst = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    const Pairs pairs = with_noise(moving_box(seed, 8 + static_cast<int>(seed % 19)), seed, 1);
    const FitResult ours = fit_homography(pairs, Curve::per2);
    FitResult theirs = ceres_post_divide(pairs.then_px, pairs.now_px, fit_homography(pairs, Curve::aff).warp);
    measure(pairs.then_px, pairs.now_px, theirs);
    ASSERT_EQ(ours.status, FitStatus::Converged) << "seed " << seed;
    EXPECT_LE(ours.rms_px, theirs.rms_px * (1 + 1e-9)) << "seed " << seed;
    worst = std::fmax(worst, std::fabs(ours.rms_px / theirs.rms_px - 1));
  }
  EXPECT_LT(worst, 1e-6);
}

TEST(FitPostDivide, IsNeverWorseThanAffineOrTheHomogeneousFit) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    const Pairs pairs = with_noise(moving_box(seed, 4 + static_cast<int>(seed % 23)), seed, 5);
    const double ours = fit_homography(pairs, Curve::per2).rms_px;
    EXPECT_LE(ours, fit_homography(pairs, Curve::aff).rms_px * (1 + 1e-9) + 1e-9) << "seed " << seed;
    if (fit_homography(pairs, Curve::per).warp.family == Family::Perspective) {
      EXPECT_LE(ours, fit_homography(pairs, Curve::per).rms_px * (1 + 1e-9) + 1e-9) << "seed " << seed;
    }
  }
}

TEST(FitPostDivide, OneIterationTooFewIsReported) {
  const Pairs pairs = with_noise(moving_box(5, 14), 5, 30);
  const FitResult r = warp::fit(pairs.then_px, pairs.now_px, Curve::per2, {.max_iterations = 1});
  EXPECT_EQ(r.status, FitStatus::NotConverged);
  EXPECT_LE(r.rms_px, fit_homography(pairs, Curve::aff).rms_px);
}

TEST(CeresMaxNorm, EnclosesTheSmallestDisc) {
  // The largest displacement error of a translation is the radius of the smallest disc around the
  // displacements: 5 here.
  const Pairs pairs{{{0, 0}, {10, 0}, {0, 10}, {7, 7}}, {{5, 0}, {5, 0}, {3, 14}, {3, 4}}};
  const FitResult r = ceres_max_norm(pairs.then_px, pairs.now_px, Family::Translation);
  EXPECT_NEAR(r.max_px, 5, 0.05);
  EXPECT_GE(r.max_px, 5 - 1e-9);
}

TEST(CeresMaxNorm, LowersTheLargestErrorOfEveryFamily) {
  for (Family family :
       {Family::Translation, Family::Isotropic, Family::XyScale, Family::Affine, Family::Perspective}) {
    const Pairs pairs = moving_box(6, 14);
    const FitResult squares = ceres_max_norm(pairs.then_px, pairs.now_px, family, 1);
    const FitResult largest = ceres_max_norm(pairs.then_px, pairs.now_px, family);
    EXPECT_EQ(largest.warp.family, family);
    EXPECT_LT(largest.max_px, squares.max_px) << name(family);
    EXPECT_GE(largest.rms_px, squares.rms_px * (1 - 1e-9)) << name(family);
  }
}

// log2_p = 1 is the sum of squares: the oracle of the closed forms.
TEST(CeresMaxNorm, SumOfSquaresEqualsTheClosedForms) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Pairs pairs = moving_box(seed, 14);
    for (Curve curve : {Curve::trn, Curve::iso, Curve::so, Curve::aff}) {
      const double theirs = ceres_max_norm(pairs.then_px, pairs.now_px, family_of(curve), 1).rms_px;
      EXPECT_NEAR(fit_homography(pairs, curve).rms_px, theirs, 1e-7 * theirs)
          << name(curve) << " seed " << seed;
    }
  }
}

}  // namespace
}  // namespace talisman::warp
