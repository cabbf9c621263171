// SPDX-License-Identifier: Apache-2.0
// What does a least-squares fit cost, beside the libraries one would otherwise call? The workload is that of
// the tests: boxes that turn by 0.2 … 3° and move by up to 2 % of their distance. The argument is the number
// of points. `off_px` is how far a fit lies from the one in long double, at most, over all boxes and points.
#include <algorithm>
#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
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

/// Affine least squares about the centroid, by two 2 × 2 systems: what one writes without a library. It tells
/// neither residuals nor whether the points determine the map.
template <typename Real>
layers::Affine2 plain_affine(const tests::Pairs& pairs) {
  const auto n = static_cast<Real>(pairs.size());
  Real x0 = 0, y0 = 0, u0 = 0, v0 = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    x0 += pairs.then_px[i].x, y0 += pairs.then_px[i].y;
    u0 += pairs.now_px[i].x, v0 += pairs.now_px[i].y;
  }
  x0 /= n, y0 /= n, u0 /= n, v0 /= n;
  Real xx = 0, xy = 0, yy = 0, xu = 0, yu = 0, xv = 0, yv = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Real x = pairs.then_px[i].x - x0, y = pairs.then_px[i].y - y0;
    const Real u = pairs.now_px[i].x - u0, v = pairs.now_px[i].y - v0;
    xx += x * x, xy += x * y, yy += y * y;
    xu += x * u, yu += y * u, xv += x * v, yv += y * v;
  }
  const Real r = 1 / (xx * yy - xy * xy);
  const Real a = (xu * yy - yu * xy) * r, b = (yu * xx - xu * xy) * r;
  const Real c = (xv * yy - yv * xy) * r, d = (yv * xx - xv * xy) * r;
  const auto entry = [](Real v) { return static_cast<double>(v); };
  return {entry(a), entry(b), entry(u0 - a * x0 - b * y0), entry(c), entry(d), entry(v0 - c * x0 - d * y0)};
}

/// The normal equations of three unknowns by GLM, moved to the first point so that they are well conditioned.
layers::Affine2 glm_affine(const tests::Pairs& pairs) {
  const dvec2 origin = pairs.then_px[0];
  glm::dmat3 normal(0.0);
  dvec3 u(0.0), v(0.0);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const dvec3 row(pairs.then_px[i] - origin, 1);
    normal += glm::outerProduct(row, row);
    u += row * pairs.now_px[i].x;
    v += row * pairs.now_px[i].y;
  }
  const glm::dmat3 solve = glm::inverse(normal);
  u = solve * u, v = solve * v;
  return {u.x, u.y, u.z - u.x * origin.x - u.y * origin.y, v.x, v.y, v.z - v.x * origin.x - v.y * origin.y};
}

/// How far affine fits lie from those in long double, which no contender computes.
template <typename Fit>
void tell_distance(benchmark::State& state, const std::vector<tests::Pairs>& boxes, Fit fit) {
  double off_px = 0;
  for (int k = 0; k < kBoxes; ++k) {
    const layers::Affine2 exact = plain_affine<long double>(boxes[k]);
    const auto map = fit(k);
    for (const dvec2& p : boxes[k].then_px) off_px = std::max(off_px, glm::distance(exact(p), map(p)));
  }
  state.counters["off_px"] = off_px;
}

template <layers::Affine2 (*Method)(const tests::Pairs&)>
void affine_by(benchmark::State& state) {
  const auto boxes = workload(state);
  const auto fit_box = [&](int k) { return Method(boxes[k]); };
  run(state, fit_box);
  tell_distance(state, boxes, fit_box);
}

void fit_curve(benchmark::State& state, Curve curve) {
  const auto boxes = workload(state);
  run(state, [&](int k) { return fit(boxes[k].then_px, boxes[k].now_px, curve); });
  if (curve == Curve::aff)
    tell_distance(state, boxes, [&](int k) { return fit(boxes[k].then_px, boxes[k].now_px, curve).warp; });
}

void affine_cached(benchmark::State& state) {
  const auto boxes = workload(state);
  std::vector<AffineLeastSquares> solvers;
  for (const auto& box : boxes) solvers.emplace_back(box.then_px);
  run(state, [&](int k) { return solvers[k].fit(boxes[k].now_px); });
  tell_distance(state, boxes, [&](int k) { return solvers[k].fit(boxes[k].now_px).warp; });
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
BENCHMARK(affine_by<plain_affine<double>>)->Name("affine_plain")->Apply(points);
BENCHMARK(affine_by<glm_affine>)->Name("affine_glm")->Apply(points);
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
