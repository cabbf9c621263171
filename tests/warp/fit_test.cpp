// SPDX-License-Identifier: Apache-2.0
#include "warp/fit.h"

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "tests/support/correspondences.h"
#include "warp/conditioning.h"

namespace talisman::warp {
namespace {

using namespace tests;

constexpr std::array kLeastSquares{Curve::trn, Curve::iso, Curve::so, Curve::aff, Curve::per2};
/// The curves that are quick enough for thousands of fits; the maximum norms have their own tests.
constexpr std::array kQuick{Curve::trn, Curve::iso, Curve::so, Curve::aff, Curve::per, Curve::per2};

FitResult fit(const Pairs& pairs, Curve curve) { return warp::fit(pairs.then_px, pairs.now_px, curve); }

bool all_finite(const FitResult& r) {
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row)
      if (!std::isfinite(r.warp.now_from_then[column][row])) return false;
  return std::isfinite(r.rms_px) && std::isfinite(r.max_px) && std::isfinite(r.max_lower_bound_px);
}

/// What every result must satisfy, whatever went in.
void expect_sound(const Pairs& pairs, const FitResult& r, const std::string& where) {
  EXPECT_TRUE(all_finite(r)) << where;
  EXPECT_GE(r.rms_px, 0) << where;
  EXPECT_LE(r.rms_px, r.max_px * (1 + 1e-12)) << where;
  EXPECT_LE(r.max_lower_bound_px, r.max_px) << where;
  if (pairs.size() == 0) {
    EXPECT_EQ(r.worst_point, -1) << where;
    return;
  }
  ASSERT_GE(r.worst_point, 0) << where;
  ASSERT_LT(r.worst_point, static_cast<int>(pairs.size())) << where;
  if (!r.usable()) return;
  EXPECT_TRUE(acceptable(r.warp, pairs.then_px)) << where;
  const dvec2 worst = r.warp(pairs.then_px[r.worst_point]) - pairs.now_px[r.worst_point];
  EXPECT_NEAR(glm::length(worst), r.max_px, 1e-9 * r.max_px) << where;
}

TEST(Fit, NoPointsGiveTheIdentityAndNoError) {
  for (Curve curve : kAllCurves) {
    const FitResult r = fit(Pairs{}, curve);
    EXPECT_EQ(r.status, FitStatus::TooFewPoints);
    EXPECT_TRUE(r.warp.is_identity());
    EXPECT_EQ(r.max_px, 0);
    EXPECT_EQ(r.worst_point, -1);
  }
}

TEST(Fit, OnePointIsTranslatedExactly) {
  const Pairs pairs{{{10, 20}}, {{13, 16}}};
  for (Curve curve : kAllCurves) {
    const FitResult r = fit(pairs, curve);
    EXPECT_EQ(r.warp.family, Family::Translation) << name(curve);
    EXPECT_EQ(r.status,
              family_of(curve) == Family::Translation ? FitStatus::Converged : FitStatus::TooFewPoints)
        << name(curve);
    EXPECT_LT(r.max_px, 1e-9) << name(curve);
  }
}

TEST(Fit, TwoPointsLeaveTheScalesAndThreeTheAffineMap) {
  const Pairs two{{{0, 0}, {10, 20}}, {{5, 5}, {25, 35}}};
  const Pairs three{{{0, 0}, {10, 0}, {0, 10}}, {{1, 1}, {12, 2}, {0, 11}}};
  for (Curve curve : {Curve::aff, Curve::per, Curve::per2, Curve::pers, Curve::pers2}) {
    const FitResult r = fit(two, curve);
    EXPECT_EQ(r.status, FitStatus::TooFewPoints) << name(curve);
    EXPECT_EQ(r.warp.family, Family::XyScale) << name(curve);
    EXPECT_LT(r.max_px, 1e-9) << name(curve);
  }
  EXPECT_EQ(fit(three, Curve::aff).status, FitStatus::Converged);
  EXPECT_LT(fit(three, Curve::aff).max_px, 1e-9);
  EXPECT_EQ(fit(three, Curve::per2).status, FitStatus::TooFewPoints);
  EXPECT_EQ(fit(three, Curve::per2).warp.family, Family::Affine);
}

// The scale of coincident points is 0/0.
TEST(Fit, CoincidentPointsAreTranslated) {
  const Pairs pairs{std::vector<dvec2>(8, {100, 200}), moving_box(1, 8).now_px};
  for (Curve curve : kAllCurves) {
    const FitResult r = fit(pairs, curve);
    EXPECT_EQ(r.warp.family, Family::Translation) << name(curve);
    EXPECT_EQ(r.status,
              family_of(curve) == Family::Translation ? FitStatus::Converged : FitStatus::Degenerate)
        << name(curve);
  }
}

TEST(FitAffine, CollinearPointsAreReportedDegenerate) {
  for (double angle : {0.0, 0.3, 0.785398163397448, 1.5707963267948966, 2.0}) {
    const FitResult r = fit(near_collinear(4, 9, 0, angle), Curve::aff);
    EXPECT_EQ(r.status, FitStatus::Degenerate) << angle;
    EXPECT_LT(static_cast<int>(r.warp.family), static_cast<int>(Family::Affine)) << angle;
  }
}

// On a vertical line x says nothing: the x/y scale would divide 0 by 0.
TEST(FitXyScale, LinesAlongAnAxisFallBackToOneScale) {
  const Pairs vertical{{{5, 0}, {5, 10}, {5, 30}}, {{6, 0}, {6, 20}, {6, 60}}};
  const FitResult r = fit(vertical, Curve::so);
  EXPECT_EQ(r.status, FitStatus::Degenerate);
  EXPECT_EQ(r.warp.family, Family::Isotropic);
  EXPECT_LT(r.max_px, 1e-9);
}

// As the points lose their thickness the warp passes from the affine answer to the simpler one: at no step
// may its error jump. The noise of the points decides the map across the line; only seeds where it does not
// mirror are of interest.
TEST(FitAffine, NearlyCollinearPointsHandOverWithoutAJump) {
  int followed = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    if (fit(near_collinear(seed, 14, 1e-3, 0.4), Curve::aff).status != FitStatus::Converged) continue;
    ++followed;
    double last_rms = -1;
    for (double thickness = 1e-6; thickness > 1e-10; thickness *= 0.97) {
      const FitResult r = fit(near_collinear(seed, 14, thickness, 0.4), Curve::aff);
      if (last_rms >= 0) {
        EXPECT_LT(std::fabs(r.rms_px - last_rms), 0.5) << "thickness " << thickness << " seed " << seed;
      }
      last_rms = r.rms_px;
    }
    EXPECT_EQ(fit(near_collinear(seed, 14, 1e-6, 0.4), Curve::aff).warp.family, Family::Affine);
    EXPECT_EQ(fit(near_collinear(seed, 14, 1e-12, 0.4), Curve::aff).status, FitStatus::Degenerate);
    EXPECT_EQ(fit(near_collinear(seed, 14, 1e-12, 0.4), Curve::aff).warp.family, Family::XyScale);
  }
  EXPECT_GE(followed, 3);
}

TEST(FitAffine, MirroredPointsNeverMirrorTheSprite) {
  for (const Affine2& mirror :
       {Affine2{-1, 0, 1024, 0, 1, 0}, Affine2{0, 1, 0, 1, 0, 0}, Affine2{1, 0, 0, 0, -1, 1024}})
    for (Curve curve : kAllCurves) {
      const FitResult r = fit(with_noise(exact_affine(3, 10, mirror), 4, 1), curve);
      if (family_of(curve) >= Family::Affine) {
        EXPECT_EQ(r.status, FitStatus::Degenerate) << name(curve);
      }
      const dvec2 o = r.warp({512, 512}), x = r.warp({513, 512}) - o, y = r.warp({512, 513}) - o;
      EXPECT_GT(x.x * y.y - x.y * y.x, 0) << name(curve);
    }
}

TEST(FitAffine, PointsThatCollapseToALineOrAPointAreDegenerate) {
  const Pairs line = exact_affine(23, 8, {1, 0.5, 0, 2, 1, 0}),
              point = exact_affine(23, 8, {0, 0, 7, 0, 0, 8});
  EXPECT_EQ(fit(line, Curve::aff).status, FitStatus::Degenerate);
  const FitResult r = fit(point, Curve::aff);
  EXPECT_EQ(r.status, FitStatus::Degenerate);
  EXPECT_EQ(r.warp.family, Family::Translation);
}

// A turn by 180° has a positive determinant: it is an honest answer, also for one negative scale.
TEST(FitIsotropic, ATurnByHalfACircleIsKept) {
  const FitResult r = fit(exact_affine(3, 9, {-1, 0, 1024, 0, -1, 1024}), Curve::iso);
  EXPECT_EQ(r.status, FitStatus::Converged);
  EXPECT_LT(r.max_px, 1e-9);
}

TEST(Fit, OneBadCoordinateIsReportedWithItsPoint) {
  const double inf = std::numeric_limits<double>::infinity();
  for (double bad : {std::nan(""), inf, -inf, 1e26})
    for (int side = 0; side < 2; ++side)
      for (Curve curve : kAllCurves) {
        Pairs pairs = moving_box(7, 8);
        (side == 0 ? pairs.then_px : pairs.now_px)[5].y = bad;
        const FitResult r = fit(pairs, curve);
        EXPECT_EQ(r.status, FitStatus::NotFinite) << name(curve);
        EXPECT_FALSE(r.usable());
        EXPECT_TRUE(r.warp.is_identity());
        EXPECT_EQ(r.max_px, kHugePx);
        EXPECT_EQ(r.worst_point, 5);
      }
}

TEST(Fit, PointsAtRestHaveTheIdentityExactly) {
  for (int n : {4, 8, 14}) {
    const Pairs pairs{moving_box(5, n).then_px, moving_box(5, n).then_px};
    for (Curve curve : kAllCurves) {
      const FitResult r = fit(pairs, curve);
      EXPECT_EQ(r.status, FitStatus::Converged) << name(curve);
      EXPECT_EQ(r.warp.family, family_of(curve)) << name(curve);
      EXPECT_TRUE(r.warp.is_identity()) << name(curve);
      EXPECT_EQ(r.max_px, 0) << name(curve);
    }
  }
}

TEST(Fit, HardCasesGiveSoundResultsOnEveryCurve) {
  for (const auto& hard : tests::hard_cases())
    for (Curve curve : kAllCurves) {
      const FitResult r = fit(hard.pairs, curve);
      expect_sound(hard.pairs, r, hard.name + ", " + std::string(name(curve)));
      EXPECT_EQ(r.usable(), hard.finite) << hard.name << ", " << name(curve);
    }
}

TEST(Fit, TinySpritesFarAwayKeepTheirAccuracy) {
  for (double size : {1e-3, 1.0, 1e5})
    for (double offset : {0.0, 1e4, 1e8})
      for (Curve curve : {Curve::aff, Curve::per, Curve::per2}) {
        const FitResult r =
            fit(exact_affine(11, 10, {1.01, 0.02, 1, -0.01, 0.99, 2}, size / 2, {offset, -offset}), curve);
        EXPECT_LT(r.max_px, 1e-3) << name(curve) << ", " << size << " px at " << offset;
      }
}

// Repeating every point changes neither the sums' minimum nor, of course, the largest error.
TEST(Fit, DuplicatedPointsChangeNothing) {
  const Pairs once = moving_box(8, 14);
  Pairs twice = once;
  twice.then_px.insert(twice.then_px.end(), once.then_px.begin(), once.then_px.end());
  twice.now_px.insert(twice.now_px.end(), once.now_px.begin(), once.now_px.end());
  for (Curve curve : kQuick)
    EXPECT_NEAR(fit(once, curve).rms_px, fit(twice, curve).rms_px, 1e-9) << name(curve);
}

TEST(Fit, TheOrderOfThePointsDoesNotMatter) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Pairs pairs = moving_box(seed, 14), reversed = pairs;
    std::reverse(reversed.then_px.begin(), reversed.then_px.end());
    std::reverse(reversed.now_px.begin(), reversed.now_px.end());
    for (Curve curve : kQuick)
      EXPECT_NEAR(fit(pairs, curve).rms_px, fit(reversed, curve).rms_px, 1e-9)
          << name(curve) << " seed " << seed;
  }
}

// If both pictures are turned, scaled and moved, the warp is turned, scaled and moved: errors scale with the
// picture now. (The family of x/y scales singles out the axes, and that of isotropic scales a joint turn;
// they are equivariant under S⁻¹ W S with one and the same S only.)
TEST(Fit, EquivariantUnderSimilarities) {
  Random random(10);
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const Pairs pairs = moving_box(seed, 14);
    const double scale = random.log_uniform(0.01, 100), angle = random.uniform(-3, 3);
    const Affine2 turn{scale * std::cos(angle), -scale * std::sin(angle), 37,
                       scale * std::sin(angle), scale * std::cos(angle),  -11};
    const Affine2 stretch{scale, 0, 37, 0, scale, -11};
    for (Curve curve : kQuick) {
      const Affine2& s = family_of(curve) == Family::XyScale ? stretch : turn;
      Pairs moved = pairs;
      for (auto& p : moved.then_px) p = s(p);
      for (auto& p : moved.now_px) p = s(p);
      const FitResult before = fit(pairs, curve), after = fit(moved, curve);
      EXPECT_NEAR(after.rms_px, scale * before.rms_px, 1e-9 * scale * before.rms_px)
          << name(curve) << " seed " << seed;
      const dvec2 p = pairs.then_px[seed % 14];
      EXPECT_LT(glm::length(after.warp(s(p)) - s(before.warp(p))), 1e-7 * scale)
          << name(curve) << " seed " << seed;
    }
  }
}

// The sum of squares of a family is the least of all its members, and families are nested.
TEST(Fit, LeastSquaresIsNeverWorseInRmsThanAnyOtherResultOfItsFamilyOrASimplerOne) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const Pairs pairs = with_noise(moving_box(seed, 14), seed, 2);
    for (Curve best : kLeastSquares)
      for (Curve other : kAllCurves) {
        if (family_of(other) > family_of(best)) continue;
        EXPECT_LE(fit(pairs, best).rms_px, fit(pairs, other).rms_px * (1 + 1e-9))
            << name(best) << " against " << name(other) << " seed " << seed;
      }
  }
}

TEST(Fit, GarbageNeverGivesGarbage) {
  for (std::uint64_t seed = 0; seed < 10000; ++seed) {
    const Pairs pairs = tests::garbage(seed);
    for (Curve curve : kQuick) {
      const FitResult r = fit(pairs, curve);
      expect_sound(pairs, r, "seed " + std::to_string(seed) + ", " + std::string(name(curve)));
      if (::testing::Test::HasFailure()) return;
    }
  }
}

TEST(Fit, SimplerFamilyIsUsedOnlyWhenTheStatusSaysSo) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    const Pairs pairs = tests::garbage(seed);
    for (Curve curve : kQuick) {
      const FitResult r = fit(pairs, curve);
      if (r.status == FitStatus::Converged) {
        EXPECT_EQ(r.warp.family, family_of(curve)) << "seed " << seed;
      }
      if (r.status == FitStatus::TooFewPoints && !pairs.then_px.empty()) {
        EXPECT_LT(static_cast<int>(pairs.size()), points_needed(family_of(curve))) << "seed " << seed;
      }
    }
  }
}

TEST(Measure, EqualsThePlainSums) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const Pairs pairs = moving_box(seed, 14);
    FitResult r{FitStatus::Converged, Warp{Family::Perspective, tests::gentle_perspective(seed)}};
    measure(pairs.then_px, pairs.now_px, r);
    EXPECT_NEAR(r.rms_px, tests::rms_error(pairs, r.warp), 1e-9);
    EXPECT_NEAR(r.max_px, tests::largest_error(pairs, r.warp), 1e-9);
  }
}

// Beyond its horizon a perspective warp shows a mirrored ghost; such a point has no image and the largest
// error there is.
TEST(Measure, APointBeyondTheHorizonHasTheLargestError) {
  FitResult r{FitStatus::Converged, Warp{Family::Perspective, {1, 0, -0.01, 0, 1, 0, 0, 0, 1}}};
  const Pairs pairs{{{0, 0}, {200, 0}}, {{0, 0}, {-200, 0}}};
  measure(pairs.then_px, pairs.now_px, r);
  EXPECT_EQ(r.max_px, kHugePx);
  EXPECT_EQ(r.worst_point, 1);
}

TEST(FitDeathTest, DifferentCountsAreAProgrammersMistake) {
  const Pairs pairs = moving_box(1, 8);
  EXPECT_DEATH((void)warp::fit(pairs.then_px, std::span(pairs.now_px).first(7), Curve::aff), "8 against 7");
}

TEST(FitStatus, NamesAreWords) {
  EXPECT_EQ(name(FitStatus::Converged), "converged");
  EXPECT_EQ(name(FitStatus::NotFinite), "not finite");
}

}  // namespace
}  // namespace talisman::warp
