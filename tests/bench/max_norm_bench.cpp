// SPDX-License-Identifier: Apache-2.0

/// What do certified maximum-norm fits cost, beside the methods they replace?
///
/// Each benchmark runs over the same boxes (correspondences.h). `us_median` and `us_p99` are percentiles over
/// the boxes, each box timed as the best of some repetitions, so that they show the spread of the problem and
/// not that of the machine; `uncertified` counts the boxes whose result is not known to be within the gap;
/// `gap_max` is the largest relative gap that the method itself can prove (1 where it proves nothing).

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <vector>

#include "tests/support/correspondences.h"
#include "warp/ceres_reference.h"
#include "warp/max_norm.h"

namespace talisman::warp {
namespace {

using tests::Pairs;

struct Proof {
  double upper = 0, lower = 0;
  bool wanted = true;  ///< false: the run ended before what was asked for
};
using Method = std::function<Proof(const Pairs&)>;

void measure_percentiles(benchmark::State& state, int boxes, int repetitions, const Method& method) {
  using Clock = std::chrono::steady_clock;
  std::vector<Pairs> cases;
  for (int seed = 0; seed < boxes; ++seed)
    cases.push_back(tests::moving_box(seed, static_cast<int>(state.range(0))));
  std::vector<double> best_us(cases.size(), HUGE_VAL);
  double uncertified = 0, gap_max = 0;
  for (auto _ : state) {
    for (std::size_t i = 0; i < cases.size(); ++i) {
      for (int k = 0; k < repetitions; ++k) {
        const auto start = Clock::now();
        benchmark::DoNotOptimize(method(cases[i]));
        const std::chrono::duration<double, std::micro> taken = Clock::now() - start;
        best_us[i] = std::min(best_us[i], taken.count());
      }
    }
  }
  for (const Pairs& pairs : cases) {
    const Proof proof = method(pairs);
    uncertified += !proof.wanted;
    gap_max = std::max(gap_max, (proof.upper - proof.lower) / proof.upper);
  }
  std::sort(best_us.begin(), best_us.end());
  state.counters["us_median"] = best_us[cases.size() / 2];
  state.counters["us_p99"] = best_us[cases.size() * 99 / 100];
  state.counters["uncertified"] = uncertified;
  state.counters["gap_max"] = gap_max;
}

Method ours(Family family, double decide_px) {
  return [family, decide_px](const Pairs& pairs) {
    FitOptions options;
    options.decide_px = decide_px;
    const FitResult r = fit_max_norm(pairs.then_px, pairs.now_px, family, options);
    return Proof{r.max_px, r.max_lower_bound_px, r.status != FitStatus::NotConverged};
  };
}

/// Lawson's method as in a textbook: affine least squares by 3 × 3 normal equations about the centroid,
/// weights multiplied by the residuals, until the bounds are within `gap`.
Proof textbook_lawson(const Pairs& pairs, double gap, int most_steps) {
  const int n = static_cast<int>(pairs.size());
  std::vector<double> w(n, 1.0 / n), r(n);
  Proof proof{HUGE_VAL, 0, false};
  for (int step = 0; step < most_steps && !proof.wanted; ++step) {
    dvec2 p0{0, 0}, q0{0, 0};
    for (int i = 0; i < n; ++i) q0 += w[i] * pairs.then_px[i], p0 += w[i] * pairs.now_px[i];
    double xx = 0, xy = 0, yy = 0;
    dvec2 px{0, 0}, py{0, 0};
    for (int i = 0; i < n; ++i) {
      const dvec2 q = pairs.then_px[i] - q0, p = w[i] * (pairs.now_px[i] - p0);
      xx += w[i] * q.x * q.x, xy += w[i] * q.x * q.y, yy += w[i] * q.y * q.y;
      px += q.x * p, py += q.y * p;
    }
    const double det = xx * yy - xy * xy;
    const dvec2 ax = (yy * px - xy * py) / det, ay = (xx * py - xy * px) / det;
    double squares = 0, largest = 0, sum = 0;
    for (int i = 0; i < n; ++i) {
      const dvec2 q = pairs.then_px[i] - q0, e = pairs.now_px[i] - p0 - q.x * ax - q.y * ay;
      const double f = e.x * e.x + e.y * e.y;
      squares += w[i] * f;
      largest = std::max(largest, f);
      sum += w[i] *= r[i] = std::sqrt(f);
    }
    for (double& weight : w) weight /= sum;
    proof.upper = std::min(proof.upper, std::sqrt(largest));
    proof.lower = std::max(proof.lower, std::sqrt(squares));
    proof.wanted = proof.upper - proof.lower <= gap * proof.upper;
  }
  return proof;
}

Method ceres(Family family) {
  return [family](const Pairs& pairs) {
    return Proof{ceres_max_norm(pairs.then_px, pairs.now_px, family).max_px, 0, false};
  };
}

void affine_value(benchmark::State& s) { measure_percentiles(s, 1000, 5, ours(Family::Affine, -1)); }
void affine_decision_at_4_px(benchmark::State& s) {
  measure_percentiles(s, 1000, 5, ours(Family::Affine, 4));
}
void xy_scale_value(benchmark::State& s) { measure_percentiles(s, 1000, 5, ours(Family::XyScale, -1)); }
void isotropic_value(benchmark::State& s) { measure_percentiles(s, 1000, 5, ours(Family::Isotropic, -1)); }
void translation_value(benchmark::State& s) {
  measure_percentiles(s, 1000, 5, ours(Family::Translation, -1));
}
void perspective_value(benchmark::State& s) {
  measure_percentiles(s, 1000, 5, ours(Family::Perspective, -1));
}
void perspective_decision_at_4_px(benchmark::State& s) {
  measure_percentiles(s, 1000, 5, ours(Family::Perspective, 4));
}
void homogeneous_value(benchmark::State& s) {
  measure_percentiles(s, 1000, 5, [](const Pairs& pairs) {
    HomogeneousBounds bounds;
    const FitResult r = fit_max_norm_homogeneous(pairs.then_px, pairs.now_px, {}, &bounds);
    return Proof{bounds.upper, bounds.lower, r.status != FitStatus::NotConverged};
  });
}
void affine_lawson_gap_1e2(benchmark::State& s) {
  measure_percentiles(s, 300, 3, [](const Pairs& pairs) { return textbook_lawson(pairs, 1e-2, 20000); });
}
void affine_lawson_gap_1e4(benchmark::State& s) {
  measure_percentiles(s, 100, 1, [](const Pairs& pairs) { return textbook_lawson(pairs, 1e-4, 20000); });
}
void affine_ceres(benchmark::State& s) { measure_percentiles(s, 30, 1, ceres(Family::Affine)); }
void perspective_ceres(benchmark::State& s) { measure_percentiles(s, 30, 1, ceres(Family::Perspective)); }

BENCHMARK(affine_decision_at_4_px)->Arg(8)->Arg(14)->Arg(26)->Arg(64)->Iterations(1);
BENCHMARK(affine_value)->Arg(8)->Arg(14)->Arg(26)->Arg(64)->Iterations(1);
BENCHMARK(affine_lawson_gap_1e2)->Arg(8)->Arg(14)->Arg(26)->Arg(64)->Iterations(1);
BENCHMARK(affine_lawson_gap_1e4)->Arg(8)->Arg(14)->Arg(26)->Arg(64)->Iterations(1);
BENCHMARK(affine_ceres)->Arg(8)->Arg(14)->Arg(26)->Iterations(1);
BENCHMARK(translation_value)->Arg(14)->Iterations(1);
BENCHMARK(isotropic_value)->Arg(14)->Iterations(1);
BENCHMARK(xy_scale_value)->Arg(14)->Iterations(1);
BENCHMARK(perspective_decision_at_4_px)->Arg(8)->Arg(14)->Arg(26)->Iterations(1);
BENCHMARK(perspective_value)->Arg(8)->Arg(14)->Arg(26)->Iterations(1);
BENCHMARK(homogeneous_value)->Arg(8)->Arg(14)->Arg(26)->Iterations(1);
BENCHMARK(perspective_ceres)->Arg(8)->Arg(14)->Arg(26)->Iterations(1);

}  // namespace
}  // namespace talisman::warp
