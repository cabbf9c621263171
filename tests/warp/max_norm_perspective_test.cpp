// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "tests/support/correspondences.h"
#include "tests/support/planted.h"
#include "warp/ceres_reference.h"
#include "warp/conditioning.h"
#include "warp/max_norm.h"

namespace talisman::warp {
namespace {

using namespace tests;

FitResult fit_post_divide(const Pairs& pairs, const FitOptions& options = {}) {
  return fit_max_norm(pairs.then_px, pairs.now_px, Family::Perspective, options);
}

double gap(const FitResult& r) { return (r.max_px - r.max_lower_bound_px) / r.max_px; }

Pairs noisy_homography(std::uint64_t seed) {
  Random random(seed);
  const int n = random.integer(5, 30);
  return with_noise(exact_perspective(seed, n, gentle_perspective(seed), random.log_uniform(10, 400)),
                    seed + 100000, random.log_uniform(1e-3, 20));
}

/// Smallest ratio of two denominators over the points: 0 on the horizon.
double horizon_ratio(const Pairs& pairs, const Warp& warp) {
  double least = HUGE_VAL, most = 0;
  for (const dvec2& p : pairs.then_px) {
    least = std::fmin(least, warp.denominator(p));
    most = std::fmax(most, warp.denominator(p));
  }
  return least / most;
}

TEST(FitMaxNormPerspective, CertifiesTheWorkload) {
  for (int n : {8, 14, 26})
    for (int seed = 0; seed < 1500; ++seed) {
      const FitResult r = fit_post_divide(moving_box(seed, n));
      ASSERT_EQ(r.status, FitStatus::Converged) << seed << " n " << n << " gap " << gap(r);
      ASSERT_LE(gap(r), 1e-6) << seed;
      ASSERT_LE(r.max_lower_bound_px, r.max_px) << seed;
    }
}

TEST(FitMaxNormPerspective, CertifiesNoiseAboutAHomography) {
  int uncertified = 0;
  for (int seed = 0; seed < 3000; ++seed) {
    const Pairs pairs = noisy_homography(seed);
    const FitResult r = fit_post_divide(pairs);
    ASSERT_LE(r.max_lower_bound_px, r.max_px) << seed;
    if (gap(r) <= 1e-6) continue;
    // Few points and much noise: the best map sends a point to the horizon, and none is best.
    ASSERT_LE(horizon_ratio(pairs, r.warp), 1e-2) << seed;
    ++uncertified;
  }
  EXPECT_LE(uncertified, 5);
}

// The optimum is known without any solver.
TEST(FitMaxNormPerspective, BoundsEncloseAPlantedOptimum) {
  for (int seed = 0; seed < 2000; ++seed) {
    const auto planted = tests::planted_perspective(seed, 6 + seed % 20);
    const FitResult r = fit_post_divide(planted.pairs);
    ASSERT_LE(r.max_lower_bound_px, planted.optimum_px * (1 + 1e-9)) << seed;
    ASSERT_GE(r.max_px, planted.optimum_px * (1 - 1e-9)) << seed;
    ASSERT_LE(r.max_px, planted.optimum_px * (1 + 2e-6)) << seed << " " << name(r.status);
  }
}

TEST(FitMaxNormPerspective, BoundsEncloseWhatCeresFinds) {
  for (int seed = 0; seed < 40; ++seed) {
    const Pairs pairs = moving_box(seed, 8 + seed % 10);
    const FitResult r = fit_post_divide(pairs);
    const FitResult ceres = ceres_max_norm(pairs.then_px, pairs.now_px, Family::Perspective);
    EXPECT_LE(r.max_lower_bound_px, ceres.max_px * (1 + 1e-12)) << seed;
    EXPECT_LE(r.max_px, ceres.max_px * (1 + 1e-6)) << seed;
  }
}

TEST(FitMaxNormPerspective, NoMapNearTheAnswerIsBelowTheLowerBound) {
  for (int seed = 0; seed < 100; ++seed) {
    const Pairs pairs = moving_box(seed, 14);
    const FitResult r = fit_post_divide(pairs);
    Random random(seed);
    for (int trial = 0; trial < 200; ++trial) {
      // Perturb where the sprite is: conjugated with its centre, so that no entry dominates.
      const dvec2 c = pairs.then_px[0];
      const layers::dmat3 to{1, 0, 0, 0, 1, 0, c.x, c.y, 1}, from{1, 0, 0, 0, 1, 0, -c.x, -c.y, 1};
      layers::dmat3 change(1.0);
      const double amount = random.log_uniform(1e-9, 1);
      for (int k = 0; k < 2; ++k) {
        change[k] += amount * layers::dvec3{random.uniform(-1, 1) / 100, random.uniform(-1, 1) / 100,
                                            random.uniform(-1, 1) / 30000};
        change[2][k] += amount * random.uniform(-1, 1);
      }
      const layers::dmat3 map = r.warp.now_from_then * to * change * from;
      ASSERT_GE(tests::largest_error(pairs, [&](dvec2 p) { return tests::through(map, p); }),
                r.max_lower_bound_px)
          << seed << " " << amount;
    }
  }
}

TEST(FitMaxNormPerspective, NeverWorseThanTheAffineOptimumOrLeastSquares) {
  for (int seed = 0; seed < 1000; ++seed) {
    const Pairs pairs = moving_box(seed, 14);
    const double perspective = fit_post_divide(pairs).max_px;
    const FitOptions options;
    ASSERT_LE(perspective,
              fit_max_norm(pairs.then_px, pairs.now_px, Family::Affine, options).max_px * (1 + 1e-6))
        << seed;
    ASSERT_LE(perspective, fit(pairs.then_px, pairs.now_px, Curve::per2).max_px * (1 + 1e-6)) << seed;
  }
}

TEST(FitMaxNormPerspective, RecoversExactHomographies) {
  for (int seed = 0; seed < 300; ++seed) {
    const FitResult r = fit_post_divide(exact_perspective(seed, 4 + seed % 20, gentle_perspective(seed)));
    if (r.status == FitStatus::Degenerate) continue;  // four points may be in no convex position
    ASSERT_LE(r.max_px, 1e-7) << seed << " " << name(r.status);
  }
}

TEST(FitMaxNormPerspective, DecisionAgreesWithValueOnBothSidesOfTheThreshold) {
  for (int seed = 0; seed < 500; ++seed) {
    const Pairs pairs = moving_box(seed, 8 + seed % 20);
    const FitResult value = fit_post_divide(pairs);
    for (double factor : {0.2, 0.8, 0.97, 0.9999, 1.0001, 1.03, 1.2, 4.0}) {
      FitOptions options;
      options.decide_px = factor * value.max_px;
      const FitResult r = fit_post_divide(pairs, options);
      ASSERT_EQ(r.status, FitStatus::Converged) << seed << " " << factor;
      if (factor < 1) {
        ASSERT_GT(r.max_lower_bound_px, options.decide_px) << seed << " " << factor;
      } else {
        ASSERT_LE(r.max_px, options.decide_px) << seed << " " << factor;
      }
    }
  }
}

TEST(FitMaxNormPerspective, IsEquivariantUnderSimilarity) {
  FitOptions tight;
  tight.relative_gap = 1e-9;
  for (int seed = 0; seed < 200; ++seed) {
    const Pairs pairs = moving_box(seed, 14);
    const double scale = Random(seed + 77).log_uniform(0.1, 10);
    const Pairs moved = in_similar_display(pairs, seed, scale);
    const double a = fit_post_divide(pairs, tight).max_px, b = fit_post_divide(moved, tight).max_px;
    ASSERT_NEAR(b, scale * a, 2e-9 * scale * a) << seed;
  }
}

// The best map has its horizon between the points: outside the domain, where nothing is certified.
TEST(FitMaxNormPerspective, AHorizonAmongThePointsIsNeverAcceptedSilently) {
  const Pairs pairs = exact_perspective(24, 12, {1, 0, 0.01, 0, 1, 0, 0, 0, -5.12});
  const FitResult r = fit_post_divide(pairs);
  if (r.status == FitStatus::Converged || r.status == FitStatus::NotConverged) {
    for (const dvec2& p : pairs.then_px) EXPECT_GT(r.warp.denominator(p), 0);
    EXPECT_LE(r.max_lower_bound_px, r.max_px);
  } else {
    EXPECT_EQ(r.status, FitStatus::Degenerate);
  }
}

TEST(FitMaxNormPerspective, PairsWithoutAnyRelationStayHonest) {
  int stuck = 0;  // not at the horizon either
  for (int seed = 0; seed < 1000; ++seed) {
    Random random(seed);
    Pairs pairs;
    for (int i = 0; i < 12; ++i) {
      pairs.then_px.push_back(random.in_square(300));
      pairs.now_px.push_back(random.in_square(300));
    }
    const FitResult r = fit_post_divide(pairs);
    ASSERT_LE(r.max_lower_bound_px, r.max_px) << seed;
    if (gap(r) > 1e-6) {
      ASSERT_NE(r.status, FitStatus::Converged) << seed;
      stuck += horizon_ratio(pairs, r.warp) > 1e-2;
    }
  }
  EXPECT_LE(stuck, 60);  // errors of hundreds of pixels: no sprite is shown with such a map
}

/// maxᵢ denᵢ ‖rᵢ‖ with the denominator 1 at the centroid of the points then.
double homogeneous_error(const Pairs& pairs, const Warp& warp) {
  dvec2 centroid{0, 0};
  for (const dvec2& p : pairs.then_px) centroid += p / static_cast<double>(pairs.size());
  double largest = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const double den = warp.denominator(pairs.then_px[i]) / warp.denominator(centroid);
    largest = std::fmax(largest, den * glm::length(warp(pairs.then_px[i]) - pairs.now_px[i]));
  }
  return largest;
}

TEST(FitMaxNormHomogeneous, BoundsAreCertifiedInTheirOwnNorm) {
  for (int seed = 0; seed < 1000; ++seed) {
    const Pairs pairs = moving_box(seed, 8 + seed % 20);
    HomogeneousBounds bounds;
    const FitResult r = fit_max_norm_homogeneous(pairs.then_px, pairs.now_px, {}, &bounds);
    ASSERT_EQ(r.status, FitStatus::Converged) << seed;
    ASSERT_EQ(r.max_lower_bound_px, 0) << "no bound in pixels is claimed";
    ASSERT_LE(bounds.upper - bounds.lower, 1e-6 * bounds.upper) << seed;
    ASSERT_NEAR(homogeneous_error(pairs, r.warp), bounds.upper, 1e-8 * bounds.upper) << seed;
  }
}

TEST(FitMaxNormHomogeneous, IsNeverWorseInItsNormThanOtherFits) {
  for (int seed = 0; seed < 500; ++seed) {
    const Pairs pairs = moving_box(seed, 14);
    HomogeneousBounds bounds;
    fit_max_norm_homogeneous(pairs.then_px, pairs.now_px, {}, &bounds);
    for (Curve curve : {Curve::per, Curve::per2, Curve::per2i, Curve::affi})
      ASSERT_LE(bounds.lower, homogeneous_error(pairs, fit(pairs.then_px, pairs.now_px, curve).warp))
          << seed << " " << name(curve);
  }
}

TEST(FitMaxNormHomogeneous, RecoversExactHomographies) {
  for (int seed = 0; seed < 300; ++seed) {
    const Pairs pairs = exact_perspective(seed, 5 + seed % 20, gentle_perspective(seed));
    const FitResult r = fit_max_norm_homogeneous(pairs.then_px, pairs.now_px, {});
    ASSERT_LE(r.max_px, 1e-6) << seed << " " << name(r.status);
  }
}

TEST(FitMaxNormHomogeneous, HardCasesAreFinite) {
  for (const tests::HardCase& hard : tests::hard_cases()) {
    const FitResult r = fit_max_norm_homogeneous(hard.pairs.then_px, hard.pairs.now_px, {});
    EXPECT_TRUE(std::isfinite(r.max_px) && std::isfinite(r.rms_px)) << hard.name;
    EXPECT_EQ(r.status == FitStatus::NotFinite, !hard.finite) << hard.name;
  }
}

}  // namespace
}  // namespace talisman::warp
