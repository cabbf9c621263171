// SPDX-License-Identifier: Apache-2.0
// An outside oracle: a library that shares no code and no method with ours must give the same maps on the
// same points.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

#include "tests/support/correspondences.h"
#include "warp/fit.h"

namespace talisman::warp {
namespace {

using tests::Pairs;

/// OpenCV computes on points rounded to float: 3e-5 px at 512 px.
constexpr double kFloatRoundingPx = 1e-3;

std::vector<cv::Point2d> to_cv(const std::vector<dvec2>& points) {
  std::vector<cv::Point2d> out;
  for (const dvec2& p : points) out.emplace_back(p.x, p.y);
  return out;
}

dmat3 from_cv(const cv::Mat& m) {
  dmat3 out(1.0);
  for (int r = 0; r < m.rows; ++r)
    for (int c = 0; c < m.cols; ++c) out[c][r] = m.at<double>(r, c);
  return out;
}

double largest_distance(const Pairs& pairs, const Warp& a, const dmat3& b) {
  double largest = 0;
  for (const dvec2& p : pairs.then_px) largest = std::fmax(largest, glm::length(a(p) - tests::through(b, p)));
  return largest;
}

TEST(OpenCvOracle, EstimateAffine2DOnExactData) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Pairs pairs = tests::exact_affine(seed, 12, tests::gentle_affine(seed));
    const cv::Mat theirs = cv::estimateAffine2D(to_cv(pairs.then_px), to_cv(pairs.now_px));
    ASSERT_FALSE(theirs.empty()) << "seed " << seed;
    const FitResult ours = fit(pairs.then_px, pairs.now_px, Curve::aff);
    EXPECT_LT(largest_distance(pairs, ours.warp, from_cv(theirs)), kFloatRoundingPx) << "seed " << seed;
  }
}

// findHomography without RANSAC minimises the error after the divide, by Levenberg-Marquardt from the
// homogeneous solution.
TEST(OpenCvOracle, FindHomographyOnTheNoisyWorkload) {
  int equal = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Pairs pairs = tests::with_noise(tests::moving_box(seed, 14), seed, 1);
    const Warp theirs{Family::Perspective,
                      from_cv(cv::findHomography(to_cv(pairs.then_px), to_cv(pairs.now_px), 0))};
    const FitResult ours = fit(pairs.then_px, pairs.now_px, Curve::per2);
    FitResult measured{FitStatus::Converged, theirs};
    measure(pairs.then_px, pairs.now_px, measured);
    // OpenCV stops after at most ten steps in raw pixels: it may be above the minimum, never below.
    EXPECT_LE(ours.rms_px, measured.rms_px * (1 + 1e-9)) << "seed " << seed;
    EXPECT_GE(ours.rms_px, measured.rms_px * 0.8) << "seed " << seed;
    if (ours.rms_px >= measured.rms_px * (1 - 1e-3)) ++equal;
  }
  EXPECT_GE(equal, 150);
}

TEST(OpenCvOracle, FindHomographyOfFourCorners) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Pairs pairs{{{100, 100}, {900, 100}, {900, 700}, {100, 700}}, {}};
    tests::Random random(seed);
    for (const dvec2& p : pairs.then_px) pairs.now_px.push_back(p + random.in_square(100));
    const dmat3 theirs = from_cv(cv::findHomography(to_cv(pairs.then_px), to_cv(pairs.now_px), 0));
    for (Curve curve : {Curve::per, Curve::per2}) {
      const FitResult ours = fit(pairs.then_px, pairs.now_px, curve);
      ASSERT_EQ(ours.status, FitStatus::Converged) << "seed " << seed;
      EXPECT_LT(largest_distance(pairs, ours.warp, theirs), kFloatRoundingPx) << "seed " << seed;
      EXPECT_LT(glm::length(ours.warp(dvec2(512, 384)) - tests::through(theirs, {512, 384})),
                kFloatRoundingPx)
          << "seed " << seed;
    }
  }
}

}  // namespace
}  // namespace talisman::warp
