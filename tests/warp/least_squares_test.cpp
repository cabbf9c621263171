// SPDX-License-Identifier: Apache-2.0
#include "warp/least_squares.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "tests/support/correspondences.h"

namespace talisman::warp {
namespace {

using namespace tests;

constexpr std::array kLinear{Family::Translation, Family::Isotropic, Family::XyScale, Family::Affine};

Affine2 solve(const Pairs& pairs, Family family) {
  return fit_least_squares(pairs.then_px, pairs.now_px, family, spread_of(pairs.then_px)).affine();
}

/// The normal equations A = P P̂ᵀ(P̂P̂ᵀ)⁻¹ as they stand in the paper, in long double, about the first point:
/// slow and obvious.
Affine2 normal_equations(const Pairs& pairs) {
  using real = long double;
  const dvec2 o = pairs.then_px[0];
  real s[3][3] = {}, bx[3] = {}, by[3] = {};
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const real q[3] = {static_cast<real>(pairs.then_px[i].x) - o.x,
                       static_cast<real>(pairs.then_px[i].y) - o.y, 1};
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) s[r][c] += q[r] * q[c];
      bx[r] += q[r] * pairs.now_px[i].x;
      by[r] += q[r] * pairs.now_px[i].y;
    }
  }
  const auto det = [](const real m[3][3]) {
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  };
  const auto cramer = [&](const real b[3], int column) {
    real m[3][3];
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) m[r][c] = c == column ? b[r] : s[r][c];
    return det(m) / det(s);
  };
  const real a = cramer(bx, 0), b = cramer(bx, 1), c = cramer(by, 0), d = cramer(by, 1);
  return {
      static_cast<double>(a), static_cast<double>(b), static_cast<double>(cramer(bx, 2) - a * o.x - b * o.y),
      static_cast<double>(c), static_cast<double>(d), static_cast<double>(cramer(by, 2) - c * o.x - d * o.y)};
}

TEST(FitLeastSquares, AffineEqualsTheNormalEquationsOfThePaper) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const Pairs pairs = moving_box(seed, 8 + static_cast<int>(seed % 20));
    const Affine2 ours = solve(pairs, Family::Affine), theirs = normal_equations(pairs);
    for (const dvec2& p : pairs.then_px) EXPECT_LT(glm::length(ours(p) - theirs(p)), 1e-9) << "seed " << seed;
  }
}

// At the minimum the residuals are orthogonal to every direction in which the family can move: a necessary
// and sufficient condition, because the problem is convex.
TEST(FitLeastSquares, ResidualsAreOrthogonalToTheFamily) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const Pairs pairs = moving_box(seed, 14);
    const dvec2 c = spread_of(pairs.then_px).centroid;
    for (Family family : kLinear) {
      const Affine2 map = solve(pairs, family);
      dvec2 sum{0, 0}, x{0, 0}, y{0, 0};
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        const dvec2 r = map(pairs.then_px[i]) - pairs.now_px[i], q = pairs.then_px[i] - c;
        sum += r, x += r * q.x, y += r * q.y;
      }
      const double tolerance = 1e-7;
      EXPECT_LT(glm::length(sum), tolerance) << name(family) << " seed " << seed;
      const double along = family == Family::Isotropic ? std::fabs(x.x + y.y)
                           : family == Family::XyScale ? std::hypot(x.x, y.y)
                           : family == Family::Affine  ? glm::length(x) + glm::length(y)
                                                       : 0;
      EXPECT_LT(along, tolerance) << name(family) << " seed " << seed;
    }
  }
}

TEST(FitLeastSquares, RecoversExactMapsOfEachFamily) {
  const std::array<Affine2, 4> maps{
      {{1, 0, 5, 0, 1, -7}, {1.5, 0, 3, 0, 1.5, 9}, {0.5, 0, 1, 0, 2, 4}, {1, 0.3, 2, -0.4, 1.2, 8}}};
  for (int k = 0; k < 4; ++k) {
    const Pairs pairs = exact_affine(7, 9, maps[k]);
    EXPECT_LT(tests::largest_error(pairs, solve(pairs, kLinear[k])), 1e-10) << name(kLinear[k]);
  }
}

// The raw normal equations lose 0.3 px in double on a sprite of 2 px at (700, 700), and everything far away
// [A §5].
TEST(FitLeastSquares, SpritesOfAllSizesStayAccurateFarFromTheOrigin) {
  for (double size : {1e-3, 1.0, 2.0, 1e3, 1e5})
    for (double offset : {0.0, 700.0, 1e5, 1e8}) {
      const Pairs pairs = exact_affine(5, 12, {1.02, 0.03, 40, -0.01, 0.97, 80}, size / 2, {offset, -offset});
      const double rounding = 1e-12 * size + 1e-15 * offset;  // of the coordinates now themselves
      EXPECT_LT(tests::largest_error(pairs, solve(pairs, Family::Affine)), 100 * rounding)
          << size << " px at " << offset;
      EXPECT_LT(tests::largest_error(pairs, solve(pairs, Family::Affine)), 1e-3)
          << size << " px at " << offset;
    }
}

TEST(FitLeastSquares, NearlyCollinearPointsAreStillFittedToRounding) {
  for (int e = 1; e <= 7; ++e) {
    Pairs pairs = near_collinear(31, 14, std::pow(10, -e), 0.7);
    const Affine2 map{1.1, -0.2, 3, 0.3, 0.9, -5};
    for (std::size_t i = 0; i < pairs.size(); ++i) pairs.now_px[i] = map(pairs.then_px[i]);
    EXPECT_LT(tests::largest_error(pairs, solve(pairs, Family::Affine)), 1e-6) << "thickness 1e-" << e;
  }
}

TEST(AffineLeastSquares, EqualsTheUncachedFit) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const Pairs pairs = moving_box(seed, 3 + static_cast<int>(seed % 62));
    const FitResult cached = AffineLeastSquares(pairs.then_px).fit(pairs.now_px);
    const FitResult plain = fit(pairs.then_px, pairs.now_px, Curve::aff);
    EXPECT_EQ(cached.status, plain.status);
    EXPECT_NEAR(cached.rms_px, plain.rms_px, 1e-9) << "seed " << seed;
    EXPECT_NEAR(cached.max_px, plain.max_px, 1e-9) << "seed " << seed;
    for (const dvec2& p : pairs.then_px)
      EXPECT_LT(glm::length(cached.warp(p) - plain.warp(p)), 1e-9) << "seed " << seed;
  }
}

// One solver serves many frames: the second answer must not depend on the first.
TEST(AffineLeastSquares, KeepsNothingFromFrameToFrame) {
  const Pairs a = moving_box(1, 14), b = moving_box(2, 14);
  const AffineLeastSquares solver(a.then_px);
  const FitResult first = solver.fit(a.now_px);
  (void)solver.fit(b.now_px);
  EXPECT_EQ(solver.fit(a.now_px).warp, first.warp);
}

// At rest the fiducials must be exactly zero, not merely small.
TEST(AffineLeastSquares, AtRestIsExactlyTheIdentity) {
  const Pairs pairs = moving_box(3, 14);
  const FitResult result = AffineLeastSquares(pairs.then_px).fit(pairs.then_px);
  EXPECT_EQ(result.status, FitStatus::Converged);
  EXPECT_TRUE(result.warp.is_identity());
  EXPECT_EQ(result.max_px, 0);
}

TEST(AffineLeastSquares, HardCasesAreThoseOfThePlainFit) {
  for (const auto& hard : tests::hard_cases()) {
    const FitResult cached = AffineLeastSquares(hard.pairs.then_px).fit(hard.pairs.now_px);
    const FitResult plain = fit(hard.pairs.then_px, hard.pairs.now_px, Curve::aff);
    EXPECT_EQ(cached.status, plain.status) << hard.name;
    EXPECT_EQ(cached.warp.family, plain.warp.family) << hard.name;
    EXPECT_NEAR(cached.max_px, plain.max_px, 1e-6 * (1 + plain.max_px)) << hard.name;
  }
}

TEST(AffineLeastSquaresDeathTest, AnotherNumberOfPointsIsAProgrammersMistake) {
  const Pairs pairs = moving_box(4, 8);
  const AffineLeastSquares solver(pairs.then_px);
  EXPECT_DEATH((void)solver.fit(std::span(pairs.now_px).first(7)), "8 against 7");
}

TEST(SpreadOf, MatchesLongDoubleBruteForce) {
  Random random(8);
  for (int trial = 0; trial < 200; ++trial) {
    const Pairs pairs =
        near_collinear(random.bits(), 14, std::pow(10, -random.uniform(0, 6)), random.uniform(0, 3.1));
    long double mx = 0, my = 0, xx = 0, xy = 0, yy = 0;
    for (const dvec2& p : pairs.then_px) mx += p.x / 14.0L, my += p.y / 14.0L;
    for (const dvec2& p : pairs.then_px)
      xx += (p.x - mx) * (p.x - mx), xy += (p.x - mx) * (p.y - my), yy += (p.y - my) * (p.y - my);
    const long double half = (xx + yy) / 2, spread = std::sqrt((xx - yy) * (xx - yy) / 4 + xy * xy);
    const double s1 = static_cast<double>(std::sqrt((half + spread) / 14)),
                 s2 = static_cast<double>(std::sqrt((half - spread) / 14));
    const Spread ours = spread_of(pairs.then_px);
    EXPECT_NEAR(ours.sigma_1, s1, 1e-11 * s1);
    EXPECT_NEAR(ours.sigma_2, s2, 1e-5 * s2 + 1e-12 * s1) << "trial " << trial;
  }
}

TEST(Strength, FallsSmoothlyAsPointsBecomeCollinear) {
  double last = 1;
  for (double thickness = 1e-3; thickness > 1e-12; thickness *= 0.9) {
    const double now = strength(Family::Affine, spread_of(near_collinear(3, 14, thickness, 0.4).then_px));
    EXPECT_LE(now, last + 1e-9);
    EXPECT_LT(last - now, 0.05) << "a jump at thickness " << thickness;
    last = now;
  }
  EXPECT_EQ(last, 0);
}

}  // namespace
}  // namespace talisman::warp
