// SPDX-License-Identifier: Apache-2.0
// What does a least-squares fit cost, beside the libraries one would otherwise call? The workload is that of
// the tests: boxes that turn by 0.2 … 3° and move by up to 2 % of their distance. The argument is the number
// of points.
#include <vector>

#include <benchmark/benchmark.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

#include "tests/support/correspondences.h"
#include "warp/ceres_reference.h"
#include "warp/fit.h"
#include "warp/least_squares.h"

namespace talisman::warp {
namespace {

constexpr int kBoxes = 500;

std::vector<tests::Pairs> workload(const benchmark::State& state) {
  std::vector<tests::Pairs> boxes;
  for (int seed = 0; seed < kBoxes; ++seed)
    boxes.push_back(tests::moving_box(seed, static_cast<int>(state.range(0))));
  return boxes;
}

/// Runs one fit per iteration, the boxes in turn: branch predictors must not learn a single input by heart.
template <typename Fit>
void run(benchmark::State& state, Fit fit) {
  int k = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(fit(k));
    k = k + 1 == kBoxes ? 0 : k + 1;
  }
}

void fit_curve(benchmark::State& state, Curve curve) {
  const auto boxes = workload(state);
  run(state, [&](int k) { return fit(boxes[k].then_px, boxes[k].now_px, curve); });
}

void affine_cached(benchmark::State& state) {
  const auto boxes = workload(state);
  std::vector<AffineLeastSquares> solvers;
  for (const auto& box : boxes) solvers.emplace_back(box.then_px);
  run(state, [&](int k) { return solvers[k].fit(boxes[k].now_px); });
}

void ceres_per2(benchmark::State& state) {
  const auto boxes = workload(state);
  run(state, [&](int k) {
    return ceres_post_divide(boxes[k].then_px, boxes[k].now_px,
                             fit(boxes[k].then_px, boxes[k].now_px, Curve::aff).warp);
  });
}

using CvPoints = std::vector<cv::Point2d>;

template <typename Fit>
void run_cv(benchmark::State& state, Fit fit) {
  std::vector<CvPoints> then, now;
  for (const auto& box : workload(state)) {
    auto& from = then.emplace_back();
    auto& to = now.emplace_back();
    for (const auto& p : box.then_px) from.emplace_back(p.x, p.y);
    for (const auto& p : box.now_px) to.emplace_back(p.x, p.y);
  }
  run(state, [&](int k) { return fit(then[k], now[k]); });
}

void opencv_estimate_affine(benchmark::State& state) {
  run_cv(state, [](const CvPoints& from, const CvPoints& to) { return cv::estimateAffine2D(from, to); });
}

void opencv_find_homography(benchmark::State& state) {
  run_cv(state, [](const CvPoints& from, const CvPoints& to) { return cv::findHomography(from, to, 0); });
}

void points(benchmark::internal::Benchmark* b) { b->Arg(8)->Arg(14)->Arg(26)->MinTime(0.1); }

BENCHMARK(affine_cached)->Apply(points);
BENCHMARK_CAPTURE(fit_curve, trn, Curve::trn)->Apply(points);
BENCHMARK_CAPTURE(fit_curve, so, Curve::so)->Apply(points);
BENCHMARK_CAPTURE(fit_curve, aff, Curve::aff)->Apply(points);
BENCHMARK_CAPTURE(fit_curve, per, Curve::per)->Apply(points);
BENCHMARK_CAPTURE(fit_curve, per2, Curve::per2)->Apply(points);
BENCHMARK(ceres_per2)->Apply(points);
BENCHMARK(opencv_estimate_affine)->Apply(points);
BENCHMARK(opencv_find_homography)->Apply(points);

}  // namespace
}  // namespace talisman::warp
