// SPDX-License-Identifier: Apache-2.0
#include "warp/max_norm.h"

#include <array>
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "tests/support/correspondences.h"
#include "tests/support/planted.h"
#include "warp/ceres_reference.h"
#include "warp/conditioning.h"

namespace talisman::warp {
namespace {

using namespace tests;

constexpr std::array kLinearPairs{Family::Translation, Family::Isotropic, Family::XyScale, Family::Affine};
constexpr std::array kAll{Family::Translation, Family::Isotropic, Family::XyScale, Family::Affine,
                          Family::Perspective};

FitResult fit_max_norm(const Pairs& pairs, Family family, const FitOptions& options = {}) {
  return warp::fit_max_norm(pairs.then_px, pairs.now_px, family, options);
}

double gap_of(const FitResult& r) { return r.max_px > 0 ? (r.max_px - r.max_lower_bound_px) / r.max_px : 0; }

bool is_all_finite(const FitResult& r) {
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row)
      if (!std::isfinite(r.warp.now_from_then[column][row])) return false;
  return std::isfinite(r.rms_px) && std::isfinite(r.max_px) && std::isfinite(r.max_lower_bound_px);
}

/// Matched points of every kind that a fit meets: the workload, noise about a map, unrelated points.
Pairs any_pairs(std::uint64_t seed) {
  Random random(seed * 31 + 1);
  const int n = random.integer(4, 30);
  const int kind = random.integer(0, 3);
  if (kind == 0) return moving_box(seed, n);
  const double noise = kind == 3 ? 300 : random.log_uniform(1e-3, 30);
  // Another seed for the noise: with the same numbers it would be an affine map of the points.
  return with_noise(exact_affine(seed, n, gentle_affine(seed), random.log_uniform(1, 500)), seed + 100000,
                    noise);
}

TEST(FitMaxNorm, CertifiesTenThousandSeedsInEveryLinearFamily) {
  for (int seed = 0; seed < 10000; ++seed) {
    const Pairs pairs = any_pairs(seed);
    for (Family family : kLinearPairs) {
      const FitResult r = fit_max_norm(pairs, family);
      ASSERT_TRUE(is_all_finite(r)) << seed;
      ASSERT_LE(r.max_lower_bound_px, r.max_px) << seed;
      ASSERT_LE(gap_of(r), 1e-6 * (1 + 1e-9)) << "seed " << seed << " " << name(family);
      ASSERT_TRUE(r.status == FitStatus::Converged || r.status == FitStatus::Degenerate) << seed;
      ASSERT_EQ(r.warp.family, family);
    }
  }
}

// The optimum is known without any solver, so that both bounds are tested against the truth.
TEST(FitMaxNorm, BoundsEncloseAPlantedAffineOptimum) {
  for (int seed = 0; seed < 3000; ++seed) {
    const auto planted = tests::planted_affine(seed, 4 + seed % 20);
    const FitResult r = fit_max_norm(planted.pairs, Family::Affine);
    ASSERT_LE(r.max_lower_bound_px, planted.optimum_px * (1 + 1e-10)) << seed;
    ASSERT_GE(r.max_px, planted.optimum_px * (1 - 1e-10)) << seed;
    ASSERT_LE(r.max_px, planted.optimum_px * (1 + 2e-6)) << seed;
  }
}

TEST(FitMaxNorm, BoundsEncloseWhatCeresFinds) {
  for (int seed = 0; seed < 40; ++seed) {
    const Pairs pairs = any_pairs(seed);
    for (Family family : {Family::Isotropic, Family::XyScale, Family::Affine}) {
      const FitResult r = fit_max_norm(pairs, family);
      const FitResult ceres = ceres_max_norm(pairs.then_px, pairs.now_px, family);
      EXPECT_LE(r.max_lower_bound_px, ceres.max_px * (1 + 1e-12)) << seed << " " << name(family);
      EXPECT_LE(r.max_px, ceres.max_px * (1 + 1e-6) + 1e-9) << seed << " " << name(family);
      if (ceres.max_px < 1e-6) continue;
      EXPECT_GE(r.max_px, ceres.max_px * 0.9) << "the reference is far above: which of the two is wrong?";
    }
  }
}

// The lower bound is a statement about *all* maps of the family: none that is tried may be below it.
TEST(FitMaxNorm, NoMapNearTheAnswerIsBelowTheLowerBound) {
  for (int seed = 0; seed < 200; ++seed) {
    const Pairs pairs = moving_box(seed, 14);
    const FitResult r = fit_max_norm(pairs, Family::Affine);
    Random random(seed);
    for (int trial = 0; trial < 200; ++trial) {
      Affine2 map = r.warp.affine();
      const double amount = random.log_uniform(1e-9, 1);
      for (double* entry : {&map.a, &map.b, &map.c, &map.d}) *entry += amount * random.uniform(-1, 1) / 100;
      const dvec2 centre = pairs.then_px[0], kept = r.warp.affine()(centre) - map.linear(centre);
      map.tx = kept.x + amount * random.uniform(-1, 1);
      map.ty = kept.y + amount * random.uniform(-1, 1);
      ASSERT_GE(tests::largest_error(pairs, map), r.max_lower_bound_px) << seed << " " << amount;
    }
  }
}

TEST(FitMaxNorm, NeverWorseThanLeastSquares) {
  constexpr std::array kCurves{Curve::trn, Curve::iso, Curve::so, Curve::aff};
  for (int seed = 0; seed < 2000; ++seed) {
    const Pairs pairs = any_pairs(seed);
    for (std::size_t k = 0; k < kLinearPairs.size(); ++k) {
      const FitResult plain = fit(pairs.then_px, pairs.now_px, kCurves[k]);
      if (plain.status != FitStatus::Converged) continue;
      ASSERT_LE(fit_max_norm(pairs, kLinearPairs[k]).max_px, plain.max_px * (1 + 1e-6)) << seed << " " << k;
    }
  }
}

TEST(FitMaxNorm, RicherFamiliesAreNeverWorse) {
  for (int seed = 0; seed < 500; ++seed) {
    const Pairs pairs = moving_box(seed, 14);
    double last = std::numeric_limits<double>::max();
    for (Family family : {Family::Translation, Family::Isotropic, Family::XyScale, Family::Affine}) {
      const FitResult r = fit_max_norm(pairs, family);
      ASSERT_LE(r.max_lower_bound_px, last) << seed << " " << name(family);
      last = r.max_px;
    }
  }
}

// The regulator asks only whether the threshold is met; the answer must be the one of the full solution.
TEST(FitMaxNorm, DecisionAgreesWithValueOnBothSidesOfTheThreshold) {
  for (int seed = 0; seed < 1000; ++seed) {
    const Pairs pairs = moving_box(seed, 8 + seed % 20);
    for (Family family : kLinearPairs) {
      const FitResult value = fit_max_norm(pairs, family);
      for (double factor : {0.2, 0.8, 0.97, 0.99999, 1.00001, 1.03, 1.2, 4.0}) {
        FitOptions options;
        options.decide_px = factor * value.max_px;
        const FitResult r = fit_max_norm(pairs, family, options);
        ASSERT_EQ(r.status, value.status) << seed << " " << factor;
        if (factor < 1) {
          ASSERT_GT(r.max_lower_bound_px, options.decide_px) << seed << " " << factor << " " << name(family);
        } else {
          ASSERT_LE(r.max_px, options.decide_px) << seed << " " << factor << " " << name(family);
        }
      }
    }
  }
}

// At the threshold itself no bound can decide: the full solution is the answer, and the run must end.
TEST(FitMaxNorm, DecisionExactlyAtTheOptimumEndsWithACertifiedValue) {
  for (int seed = 0; seed < 300; ++seed) {
    const auto planted = tests::planted_affine(seed, 14);
    FitOptions options;
    options.decide_px = planted.optimum_px;
    const FitResult r = fit_max_norm(planted.pairs, Family::Affine, options);
    ASSERT_EQ(r.status, FitStatus::Converged) << seed;
    ASSERT_LE(gap_of(r), 1e-6) << seed;
  }
}

TEST(FitMaxNorm, DecisionOfTheWorkloadTakesFewIterations) {
  double iterations = 0;
  for (int seed = 0; seed < 1000; ++seed) {
    FitOptions options;
    options.decide_px = 4;
    iterations += fit_max_norm(moving_box(seed, 14), Family::Affine, options).iterations;
  }
  EXPECT_LE(iterations / 1000, 2.0);
}

// Turning, scaling and moving the display turns, scales and moves the answer, and nothing else.
TEST(FitMaxNorm, IsEquivariantUnderSimilarity) {
  for (int seed = 0; seed < 300; ++seed) {
    const Pairs pairs = moving_box(seed, 14);
    const double scale = Random(seed + 77).log_uniform(0.01, 100);
    const Pairs moved = in_similar_display(pairs, seed, scale);
    FitOptions tight;
    tight.relative_gap = 1e-10;
    for (Family family : {Family::Translation, Family::Isotropic, Family::Affine}) {
      const FitResult a = fit_max_norm(pairs, family, tight), b = fit_max_norm(moved, family, tight);
      ASSERT_NEAR(b.max_px, scale * a.max_px, 1e-9 * scale * a.max_px) << seed << " " << name(family);
    }
  }
}

TEST(FitMaxNorm, RecoversExactMaps) {
  for (int seed = 0; seed < 500; ++seed) {
    const Affine2 map = gentle_affine(seed);
    const FitResult r = fit_max_norm(exact_affine(seed, 3 + seed % 30, map), Family::Affine);
    ASSERT_EQ(r.status, FitStatus::Converged) << seed;
    ASSERT_LE(r.max_px, 1e-9) << seed;
  }
}

// As many equations as unknowns: zero error is possible, and the gap_of is relative to rounding, not to zero.
TEST(FitMaxNorm, JustEnoughPointsAreFittedExactly) {
  for (int seed = 0; seed < 200; ++seed) {
    Pairs three = exact_affine(seed, 3, gentle_affine(seed));
    three = with_noise(three, seed, 5);
    const FitResult r = fit_max_norm(three, Family::Affine);
    ASSERT_LE(r.max_px, 1e-8) << seed;
    ASSERT_NE(r.status, FitStatus::NotConverged) << seed;
  }
}

TEST(FitMaxNorm, PointsThatDidNotMoveHaveNoError) {
  for (Family family : kAll) {
    const Pairs still{moving_box(5, 14).then_px, moving_box(5, 14).then_px};
    const FitResult r = fit_max_norm(still, family);
    EXPECT_EQ(r.status, FitStatus::Converged) << name(family);
    EXPECT_LE(r.max_px, 1e-10) << name(family);
  }
}

TEST(FitMaxNorm, SpritesOfAllSizesAtAllOffsets) {
  for (double size : {1e-3, 1.0, 1e5})
    for (double offset : {0.0, 1e4, 1e8}) {
      // The coordinates at 1e8 are multiples of 1.5e-8; a sprite of 1e-3 px still has five digits.
      const Pairs pairs = with_noise(
          exact_affine(11, 12, {1.01, 0.02, 1, -0.01, 0.99, 2}, size / 2, {offset, -offset}), 3, size / 50);
      for (Family family : kLinearPairs) {
        const FitResult r = fit_max_norm(pairs, family);
        EXPECT_EQ(r.status, FitStatus::Converged) << size << " at " << offset << " " << name(family);
        EXPECT_LE(r.max_px - r.max_lower_bound_px, 1e-6 * r.max_px + 1e-14 * offset * 100)
            << size << " at " << offset << " " << name(family);
      }
    }
}

// Nearly collinear points keep a certificate as long as they have a width at all.
TEST(FitMaxNorm, NearlyCollinearPointsStayCertified) {
  for (int e = 3; e <= 12; ++e)
    for (int seed = 0; seed < 20; ++seed) {
      const Pairs pairs = tests::near_collinear(seed, 14, std::pow(10, -e), 0.1 * seed);
      const FitResult r = fit_max_norm(pairs, Family::Affine);
      EXPECT_TRUE(is_all_finite(r));
      EXPECT_LE(r.max_lower_bound_px, r.max_px);
      EXPECT_NE(r.status, FitStatus::NotConverged) << "1e-" << e << " seed " << seed;
      if (e <= 8) {
        // What is lost beside the gap_of is rounding over width.
        EXPECT_LE(r.max_px - r.max_lower_bound_px, 1e-6 * r.max_px + 2 * std::pow(10, e - 12))
            << "1e-" << e << " seed " << seed;
      }
    }
}

TEST(FitMaxNorm, RepeatedPointsDoNotChangeTheAnswer) {
  for (int seed = 0; seed < 200; ++seed) {
    const Pairs once = moving_box(seed, 9);
    Pairs often = once;
    for (int copy = 0; copy < 30; ++copy)  // also past the points that fit into the solver's own storage
      for (int i = 0; i < 9; ++i) {
        often.then_px.push_back(once.then_px[i]);
        often.now_px.push_back(once.now_px[i]);
      }
    const double a = fit_max_norm(once, Family::Affine).max_px,
                 b = fit_max_norm(often, Family::Affine).max_px;
    ASSERT_NEAR(a, b, 2e-6 * a) << seed;
  }
}

TEST(FitMaxNorm, TheOrderOfThePointsDoesNotMatter) {
  for (int seed = 0; seed < 200; ++seed) {
    const Pairs pairs = moving_box(seed, 14);
    const Pairs reversed{{pairs.then_px.rbegin(), pairs.then_px.rend()},
                         {pairs.now_px.rbegin(), pairs.now_px.rend()}};
    const double a = fit_max_norm(pairs, Family::Affine).max_px;
    ASSERT_NEAR(fit_max_norm(reversed, Family::Affine).max_px, a, 2e-6 * a) << seed;
  }
}

TEST(FitMaxNorm, SameInputGivesTheSameBytes) {
  for (Family family : kAll) {
    const Pairs pairs = moving_box(3, 26);
    const FitResult a = fit_max_norm(pairs, family), b = fit_max_norm(pairs, family);
    EXPECT_EQ(a.warp, b.warp);
    EXPECT_EQ(a.max_lower_bound_px, b.max_lower_bound_px);
  }
}

TEST(FitMaxNorm, AMirroredOptimumIsReportedDegenerate) {
  const Pairs mirrored = with_noise(exact_affine(21, 8, {-1, 0, 1024, 0, 1, 0}), 22, 0.5);
  for (Family family : {Family::XyScale, Family::Affine})
    EXPECT_EQ(fit_max_norm(mirrored, family).status, FitStatus::Degenerate) << name(family);
}

TEST(FitMaxNorm, CoincidentAndCollinearPointsAreReportedDegenerate) {
  const Pairs coincident{std::vector<dvec2>(8, {100, 200}), with_noise(moving_box(1, 8), 1, 1).now_px};
  for (Family family : {Family::Isotropic, Family::XyScale, Family::Affine, Family::Perspective}) {
    const FitResult r = fit_max_norm(coincident, family);
    EXPECT_EQ(r.status, FitStatus::Degenerate) << name(family);
    EXPECT_EQ(r.warp.family, Family::Translation) << "and the family that was used is named";
    EXPECT_LE(gap_of(r), 1e-6) << "with its own certificate";
  }
  for (double angle : {0.0, 0.4, 1.5707963267948966})
    EXPECT_EQ(fit_max_norm(tests::near_collinear(4, 8, 0, angle), Family::Affine).status,
              FitStatus::Degenerate)
        << angle;
}

TEST(FitMaxNorm, TooFewPointsAreReported) {
  for (Family family : kAll)
    for (int n = 0; n < points_needed(family); ++n) {
      const FitResult r = fit_max_norm(with_noise(exact_affine(n + 1, n, gentle_affine(1)), 3, 5), family);
      EXPECT_EQ(r.status, FitStatus::TooFewPoints) << name(family) << " " << n;
      EXPECT_TRUE(is_all_finite(r)) << name(family) << " " << n;
    }
}

TEST(FitMaxNorm, OneBadCoordinateIsReportedWithItsIndex) {
  for (double bad : {std::numeric_limits<double>::quiet_NaN(), HUGE_VAL, -HUGE_VAL, 1e101})
    for (Family family : kAll) {
      Pairs pairs = moving_box(7, 8);
      pairs.now_px[5].y = bad;
      const FitResult r = fit_max_norm(pairs, family);
      EXPECT_EQ(r.status, FitStatus::NotFinite);
      EXPECT_EQ(r.worst_point, 5);
      EXPECT_TRUE(r.warp.is_identity());
    }
}

TEST(FitMaxNorm, HardCasesAreFiniteAndHonest) {
  for (const tests::HardCase& hard : tests::hard_cases())
    for (Family family : kAll) {
      const FitResult r = fit_max_norm(hard.pairs, family);
      const std::string where = hard.name + ", " + std::string(name(family));
      EXPECT_TRUE(is_all_finite(r)) << where;
      EXPECT_LE(r.max_lower_bound_px, r.max_px) << where;
      EXPECT_EQ(r.status == FitStatus::NotFinite, !hard.finite) << where;
      if (r.status != FitStatus::Converged) continue;
      EXPECT_TRUE(acceptable(r.warp, hard.pairs.then_px)) << where;
      EXPECT_NEAR(tests::largest_error(hard.pairs, [&](dvec2 p) { return r.warp(p); }), r.max_px,
                  1e-12 * r.max_px)
          << where;
    }
}

TEST(FitMaxNorm, GarbageIsSurvived) {
  for (int seed = 0; seed < 10000; ++seed) {
    const Pairs pairs = tests::garbage(seed);
    for (Family family : kAll) {
      const FitResult r = fit_max_norm(pairs, family);
      ASSERT_TRUE(is_all_finite(r)) << seed << " " << name(family);
      ASSERT_LE(r.max_lower_bound_px, r.max_px) << seed << " " << name(family);
    }
  }
}

// Out of iterations the answer is the best so far, and both bounds are still true.
TEST(FitMaxNorm, OutOfIterationsTheBoundsAreStillTrue) {
  int unfinished = 0;
  for (int seed = 0; seed < 300; ++seed) {
    const auto planted = tests::planted_affine(seed, 14);
    for (int iterations : {1, 2, 3, 4, 5}) {
      FitOptions options;
      options.max_iterations = iterations;
      const FitResult r = fit_max_norm(planted.pairs, Family::Affine, options);
      ASSERT_LE(r.iterations, iterations);
      ASSERT_LE(r.max_lower_bound_px, planted.optimum_px * (1 + 1e-10)) << seed;
      ASSERT_GE(r.max_px, planted.optimum_px * (1 - 1e-10)) << seed;
      unfinished += r.status == FitStatus::NotConverged;
    }
  }
  EXPECT_GT(unfinished, 1000);
}

// Curve affi through the dispatcher is this solver.
TEST(FitMaxNorm, IsWhatTheCurvesOfTheDispatcherReturn) {
  const Pairs pairs = moving_box(4, 14);
  EXPECT_EQ(fit(pairs.then_px, pairs.now_px, Curve::affi).warp, fit_max_norm(pairs, Family::Affine).warp);
  EXPECT_EQ(fit(pairs.then_px, pairs.now_px, Curve::trni).max_px,
            fit_max_norm(pairs, Family::Translation).max_px);
}

}  // namespace
}  // namespace talisman::warp
