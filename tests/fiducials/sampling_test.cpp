// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "fiducials/fiducials.h"
#include "tests/support/correspondences.h"

namespace talisman::fiducials {
namespace {

using layers::Affine2;
using layers::dmat3;
using layers::RectD;
using tests::Random;
using warp::Family;
using warp::kHugePx;
using warp::Warp;

struct Jacobian {
  double a, b, c, d;
};

/// One-sided Jacobi rotation of the two columns in long double until they are orthogonal: the lengths are the
/// singular values.
dvec2 slow_singular_values(const Jacobian& j) {
  using real = long double;
  real a = j.a, b = j.b, c = j.c, d = j.d;
  for (int sweep = 0; sweep < 60; ++sweep) {
    const real dot = a * b + c * d, difference = (b * b + d * d) - (a * a + c * c);
    if (dot == 0) break;
    const real zeta = difference / (2 * dot);
    const real t = (zeta >= 0 ? 1 : -1) / (std::fabs(zeta) + std::sqrt(1 + zeta * zeta));
    const real cosine = 1 / std::sqrt(1 + t * t), sine = cosine * t;
    const real a2 = cosine * a - sine * b, c2 = cosine * c - sine * d;
    b = sine * a + cosine * b, d = sine * c + cosine * d;
    a = a2, c = c2;
  }
  const real first = std::sqrt(a * a + c * c), second = std::sqrt(b * b + d * d);
  return {static_cast<double>(std::fmax(first, second)), static_cast<double>(std::fmin(first, second))};
}

/// The Jacobian of the map at p, from its definition.
Jacobian jacobian(const Warp& warp, dvec2 p) {
  const dmat3& m = warp.now_from_then;
  const double w = warp.denominator(p);
  const dvec2 x = warp(p);
  return {(m[0].x - x.x * m[0].z) / w, (m[1].x - x.x * m[1].z) / w, (m[0].y - x.y * m[0].z) / w,
          (m[1].y - x.y * m[1].z) / w};
}

TEST(SingularValues, MatchJacobiRotationsInLongDouble) {
  Random random(1);
  for (int trial = 0; trial < 20000; ++trial) {
    const double scale = random.log_uniform(1e-6, 1e6);
    const Jacobian j{scale * random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1),
                     scale * random.uniform(-1, 1)};
    const dvec2 ours = singular_values(j.a, j.b, j.c, j.d), slow = slow_singular_values(j);
    EXPECT_NEAR(ours.x, slow.x, 1e-14 * slow.x) << "trial " << trial;
    EXPECT_NEAR(ours.y, slow.y, 1e-12 * slow.y) << "trial " << trial;
  }
}

TEST(SingularValues, OfTheSimplestMaps) {
  EXPECT_EQ(singular_values(1, 0, 0, 1), dvec2(1, 1));
  EXPECT_EQ(singular_values(2, 0, 0, 3), dvec2(3, 2));
  EXPECT_EQ(singular_values(0, -2, 2, 0), dvec2(2, 2));  // a turn with scale
  EXPECT_EQ(singular_values(-1, 0, 0, 1), dvec2(1, 1));  // a mirror
  EXPECT_EQ(singular_values(0, 0, 0, 0), dvec2(0, 0));
  EXPECT_EQ(singular_values(0, 5, 0, 0), dvec2(5, 0));
}

TEST(SingularValues, TurnsDoNotChangeThem) {
  Random random(2);
  for (int trial = 0; trial < 1000; ++trial) {
    const double s1 = random.uniform(1, 2), s2 = random.uniform(0, 1), u = random.uniform(-4, 4),
                 v = random.uniform(-4, 4);
    const double cu = std::cos(u), su = std::sin(u), cv = std::cos(v), sv = std::sin(v);
    const dvec2 sigma = singular_values(s1 * cu * cv - s2 * su * sv, -s1 * cu * sv - s2 * su * cv,
                                        s1 * su * cv + s2 * cu * sv, -s1 * su * sv + s2 * cu * cv);
    EXPECT_NEAR(sigma.x, s1, 1e-14);
    EXPECT_NEAR(sigma.y, s2, 1e-14);
  }
}

// The textbook (√… - √…) / 2 gives 0 or noise here; the entries are exact, so the determinant is known: 2⁻⁵⁰.
TEST(SingularValues, NearlyFlatMapsKeepTheirSmallOne) {
  const double tiny = std::ldexp(1.0, -50);
  const dvec2 sigma = singular_values(1, 1, 1, 1 + tiny);
  EXPECT_NEAR(sigma.y, tiny / 2, 1e-14 * tiny);
}

TEST(SingularValues, LargestAndSmallestNumbersStayInRange) {
  for (double unit : {1e-300, 1e-160, 1e160, 1e300}) {
    const dvec2 sigma = singular_values(3 * unit, 0, 0, 4 * unit);
    EXPECT_NEAR(sigma.x / unit, 4, 1e-14);
    EXPECT_NEAR(sigma.y / unit, 3, 1e-14);
  }
}

TEST(SingularValues, NotFiniteEntriesGiveTheWorst) {
  for (double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(singular_values(bad, 0, 0, 1), dvec2(kHugePx, 0));
    EXPECT_EQ(singular_values(1, 0, -bad, 1), dvec2(kHugePx, 0));
  }
}

TEST(SamplingOver, AtRestIsExactlyOneForEveryFamily) {
  const RectD rect{{100, 50}, {740, 333}};
  for (Family family :
       {Family::Translation, Family::Isotropic, Family::XyScale, Family::Affine, Family::Perspective}) {
    const Sampling s = sampling_over(Warp{family}, rect);
    EXPECT_EQ(s.magnification, 1);
    EXPECT_EQ(s.minification, 1);
    EXPECT_EQ(s.anisotropy, 1);
  }
}

TEST(SamplingOver, AffineMapsAreTheSameEverywhere) {
  const Sampling s =
      sampling_over(warp::from_affine(Family::Affine, {2, 0, 5, 0, 0.5, 7}), {{0, 0}, {10, 20}});
  EXPECT_EQ(s.magnification, 2);
  EXPECT_EQ(s.minification, 0.5);
  EXPECT_EQ(s.anisotropy, 4);
  EXPECT_EQ(s.where_px, dvec2(15, 12));  // the image of the centre
}

// The bounds must enclose what any sample of the rectangle shows, and must not be far above the worst of
// them.
TEST(SamplingOver, PerspectiveBoundsEncloseADenseGrid) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed);
    const Warp warp{Family::Perspective, tests::gentle_perspective(seed)};
    const dvec2 lo = dvec2{512, 512} + random.in_square(400),
                size{random.log_uniform(1, 500), random.log_uniform(1, 500)};
    const RectD rect{lo, lo + size};
    const Sampling s = sampling_over(warp, rect);
    double most = 0, least = kHugePx, ratio = 0, least_w = kHugePx, most_w = 0;
    for (int i = 0; i <= 40; ++i)
      for (int k = 0; k <= 40; ++k) {
        const dvec2 p = lo + size * dvec2{i / 40.0, k / 40.0};
        const Jacobian j = jacobian(warp, p);
        const dvec2 sigma = slow_singular_values(j);
        most = std::fmax(most, sigma.x);
        least = std::fmin(least, sigma.y);
        ratio = std::fmax(ratio, sigma.x / sigma.y);
        least_w = std::fmin(least_w, warp.denominator(p));
        most_w = std::fmax(most_w, warp.denominator(p));
      }
    if (least_w <= 0) continue;  // the horizon crosses this rectangle: the case below
    const double slack = std::pow(most_w / least_w, 0.5);
    EXPECT_GE(s.magnification, most * (1 - 1e-12)) << "seed " << seed;
    EXPECT_LE(s.magnification, most * slack * (1 + 1e-9)) << "seed " << seed;
    EXPECT_LE(s.minification, least * (1 + 1e-12)) << "seed " << seed;
    EXPECT_GE(s.minification, least / slack * (1 - 1e-9)) << "seed " << seed;
    EXPECT_NEAR(s.anisotropy, ratio, 1e-9 * ratio) << "seed " << seed;
  }
}

TEST(SamplingOver, AHorizonThroughTheSpriteIsTheWorst) {
  const Warp warp{Family::Perspective, {1, 0, -0.01, 0, 1, 0, 0, 0, 1}};  // horizon at x = 100
  for (const RectD& rect : {RectD{{0, 0}, {200, 10}}, RectD{{0, 0}, {100, 10}}, RectD{{150, 0}, {200, 10}}}) {
    const Sampling s = sampling_over(warp, rect);
    EXPECT_EQ(s.magnification, kHugePx);
    EXPECT_EQ(s.minification, 0);
    EXPECT_EQ(s.anisotropy, kHugePx);
    EXPECT_TRUE(std::isfinite(s.where_px.x) && std::isfinite(s.where_px.y));
  }
}

TEST(SamplingOver, AnEmptyRectangleIsAtItsBest) {
  const Sampling s = sampling_over(warp::from_affine(Family::Affine, {2, 0, 5, 0, 0.5, 7}), RectD{});
  EXPECT_EQ(s.magnification, 1);
  EXPECT_EQ(s.minification, 1);
}

TEST(SamplingOver, ACollapsedMapIsFinite) {
  const Sampling s = sampling_over(warp::from_affine(Family::Affine, {1, 2, 0, 2, 4, 0}), {{0, 0}, {1, 1}});
  EXPECT_EQ(s.minification, 0);
  EXPECT_EQ(s.anisotropy, kHugePx);
}

}  // namespace
}  // namespace talisman::fiducials
