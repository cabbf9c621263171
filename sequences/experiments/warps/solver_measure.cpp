// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/warps/solver_measure.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "layers/check.h"
#include "warp/ceres_reference.h"
#include "warp/conditioning.h"

namespace talisman::sequences {
namespace {

using warp::Curve;
using warp::Family;
using warp::FitResult;

constexpr std::array kFamilies = {Family::Translation, Family::Isotropic, Family::XyScale, Family::Affine,
                                  Family::Perspective};
/// Below this an optimum counts as this, so that exact fits do not divide by zero.
constexpr double kSmallestOptimum_px = 1e-6;

Curve least_squares_curve(Family family) {
  constexpr std::array curves = {Curve::trn, Curve::iso, Curve::so, Curve::aff, Curve::per2};
  return curves[static_cast<int>(family)];
}
Curve maximum_curve(Family family) {
  constexpr std::array curves = {Curve::trni, Curve::isoi, Curve::soi, Curve::affi, Curve::per2i};
  return curves[static_cast<int>(family)];
}

double least_maximum(const LadderInput& input, Family family) {
  warp::FitOptions exact;
  exact.relative_gap = 1e-9;
  return warp::fit(input.matched.then_px, input.matched.now_px, maximum_curve(family), exact)
      .max_lower_bound_px;
}

double least_rms(const LadderInput& input, Family family) {
  const auto& [then_px, now_px] = std::tie(input.matched.then_px, input.matched.now_px);
  const double own = warp::fit(then_px, now_px, least_squares_curve(family)).rms_px;
  if (family != Family::Perspective) return own;
  FitResult other = warp::ceres_post_divide(then_px, now_px, warp::fit(then_px, now_px, Curve::aff).warp);
  if (!warp::acceptable(other.warp, then_px)) return own;
  warp::measure(then_px, now_px, other);
  return std::fmin(own, other.rms_px);
}

// --- Time

using Clock = std::chrono::steady_clock;
double microseconds(Clock::duration d) { return std::chrono::duration<double, std::micro>(d).count(); }

/// What the optimiser cannot remove.
volatile double sink = 0;

/// Enough fits for 4 µs, so that the clock's own 0.05 µs do not count.
std::size_t batch_size(double fit_us) {
  return static_cast<std::size_t>(std::clamp(std::ceil(4 / std::fmax(fit_us, 0.01)), 1.0, 16.0));
}

double percentile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * double(values.size() - 1) + 0.5)];
}

double sum_of(const std::vector<double>& values, std::size_t count) {
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += values[i];
  return sum;
}

// --- Stability

/// An exact map of a family about a centre: turned, scaled and bent a little, as far as the family can.
struct ExactMap {
  long double a = 1, b = 0, c = 0, d = 1, g = 0, h = 0;
  dvec2 operator()(dvec2 centre, dvec2 p) const {
    const long double x = static_cast<long double>(p.x) - centre.x,
                      y = static_cast<long double>(p.y) - centre.y;
    const long double w = 1 + g * x + h * y;
    return {static_cast<double>(centre.x + 3 + (a * x + b * y) / w),
            static_cast<double>(centre.y + 5 + (c * x + d * y) / w)};
  }
};

ExactMap exact_map(Family family, double sprite_px) {
  switch (family) {
    case Family::Translation:
      return {};
    case Family::Isotropic:
      return {1.03L, 0, 0, 1.03L, 0, 0};
    case Family::XyScale:
      return {1.03L, 0, 0, 0.98L, 0, 0};
    case Family::Affine:
      return {1.03L, -0.05L, 0.07L, 0.98L, 0, 0};
    case Family::Perspective:
      return {1.03L, -0.05L, 0.07L, 0.98L, 0.04L / sprite_px, -0.03L / sprite_px};
  }
  TALISMAN_CHECK(false && "no such family");
}

LadderInput exact_input(Family family, std::uint64_t seed, double offset_px, double sprite_px) {
  Random random(seed);
  const dvec2 centre(offset_px, offset_px);
  const ExactMap map = exact_map(family, sprite_px);
  Pairs pairs;
  for (int i = 0; i < 14; ++i) {
    pairs.then_px.push_back(centre + random.in_square(sprite_px / 2));
    pairs.now_px.push_back(map(centre, pairs.then_px.back()));
  }
  return ladder_input(std::move(pairs));
}

/// The error in extended precision, so that it is the warp's own and not that of evaluating it.
double error_of(const warp::Warp& warp, const LadderInput& input) {
  const auto at = [&](int column, int row) {
    return static_cast<long double>(warp.now_from_then[column][row]);
  };
  long double largest = 0;
  for (std::size_t i = 0; i < input.matched.then_px.size(); ++i) {
    const dvec2 p = input.matched.then_px[i], q = input.matched.now_px[i];
    const long double w = warp.is_affine() ? 1 : at(0, 2) * p.x + at(1, 2) * p.y + at(2, 2);
    const long double x = (at(0, 0) * p.x + at(1, 0) * p.y + at(2, 0)) / w - q.x;
    const long double y = (at(0, 1) * p.x + at(1, 1) * p.y + at(2, 1)) / w - q.y;
    largest = std::fmax(largest, std::hypot(x, y));
  }
  return static_cast<double>(largest);
}

constexpr double kStable_px = 1e-3;

bool keeps(const Solver& solver, double offset_px, double sprite_px) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const LadderInput input = exact_input(solver.family, seed, offset_px, sprite_px);
    const FitResult result = solver.prepare(input)();
    if (!result.usable() || !(error_of(result.warp, input) <= kStable_px)) return false;
  }
  return true;
}

}  // namespace

Workbench make_workbench(int points, int count) {
  TALISMAN_CHECK_GE(points, 1);
  Workbench bench;
  bench.points = points;
  bench.inputs.reserve(count);  // solvers keep references to inputs
  for (int seed = 0; seed < count; ++seed) bench.inputs.push_back(workload_input(seed, points));
  for (const Family family : kFamilies) {
    auto& maxima = bench.least_max_px.emplace_back();
    auto& rms = bench.least_rms_px.emplace_back();
    for (const LadderInput& input : bench.inputs) {
      maxima.push_back(least_maximum(input, family));
      rms.push_back(least_rms(input, family));
    }
  }
  return bench;
}

TimedSolver::TimedSolver(const Solver& solver, const Workbench& bench, int count) {
  TALISMAN_CHECK(count >= 1 && count <= static_cast<int>(bench.inputs.size()));
  for (int i = 0; i < count; ++i) fits_.push_back(solver.prepare(bench.inputs[i]));
  const std::size_t warm = std::min<std::size_t>(fits_.size(), 8);
  run_batch(0, warm);
  batch_ = batch_size(run_batch(0, warm));
  best_us_.assign((fits_.size() + batch_ - 1) / batch_, HUGE_VAL);
}

double TimedSolver::run_batch(std::size_t first, std::size_t last) const {
  const auto start = Clock::now();
  for (std::size_t i = first; i < last; ++i) sink = fits_[i]().max_px;
  return microseconds(Clock::now() - start) / double(last - first);
}

void TimedSolver::run_round() {
  for (std::size_t k = 0; k < best_us_.size(); ++k)
    best_us_[k] = std::fmin(best_us_[k], run_batch(k * batch_, std::min((k + 1) * batch_, fits_.size())));
}

FitTime TimedSolver::result() const { return {percentile(best_us_, 0.5), percentile(best_us_, 0.99)}; }

FitAccuracy accuracy_of(const Solver& solver, const Workbench& bench, int count) {
  TALISMAN_CHECK(count >= 1 && count <= static_cast<int>(bench.inputs.size()));
  const auto& least_max_px = bench.least_max_px[static_cast<std::size_t>(solver.family)];
  const auto& least_rms_px = bench.least_rms_px[static_cast<std::size_t>(solver.family)];
  FitAccuracy accuracy;
  double sum_px = 0;
  for (int i = 0; i < count; ++i) {
    const FitResult result = solver.prepare(bench.inputs[i])();
    const double excess = (result.max_px - least_max_px[i]) / std::fmax(least_max_px[i], kSmallestOptimum_px);
    sum_px += result.max_px;
    accuracy.mean_excess += excess / count;
    accuracy.worst_excess = std::fmax(accuracy.worst_excess, excess);
    accuracy.mean_rms_excess +=
        (result.rms_px - least_rms_px[i]) / std::fmax(least_rms_px[i], kSmallestOptimum_px) / count;
    accuracy.unfinished += result.status != warp::FitStatus::Converged;
    const double gap_px = result.max_px - result.max_lower_bound_px;
    // An error at rounding level is as certain as a number can be.
    accuracy.uncertified +=
        solver.promised_gap >= 0 && !(gap_px <= solver.promised_gap * result.max_px + 1e-9);
  }
  const double there = sum_of(least_max_px, count), everywhere = sum_of(least_max_px, least_max_px.size());
  const double harder = there > 0 ? everywhere / there : bench.inputs.size() / double(count);
  accuracy.mean_max_px = sum_px * harder / double(bench.inputs.size());
  return accuracy;
}

FitStability stability_of(const Solver& solver) {
  FitStability stability{0, HUGE_VAL};
  for (int exponent = 0; exponent <= 15; ++exponent) {
    const double offset_px = std::pow(10.0, exponent);
    if (!keeps(solver, offset_px, 100)) break;
    stability.largest_offset_px = offset_px;
  }
  for (int exponent = 3; exponent >= -12; --exponent) {
    const double sprite_px = std::pow(10.0, exponent);
    if (!keeps(solver, 700, sprite_px)) break;
    stability.smallest_sprite_px = sprite_px;
  }
  return stability;
}

}  // namespace talisman::sequences
