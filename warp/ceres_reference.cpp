// SPDX-License-Identifier: Apache-2.0
#include "warp/ceres_reference.h"

#include <array>
#include <cmath>

#include <ceres/ceres.h>
#include <glm/matrix.hpp>

#include "layers/check.h"
#include "warp/conditioning.h"
#include "warp/homography.h"
#include "warp/least_squares.h"

namespace talisman::warp {
namespace {

/// The unknowns of a family as the six entries of A (a b tx c d ty) and g h, in normalised coordinates. A
/// translation cannot change the scale, which the two normalisations have made different: `rest` is their
/// ratio.
template <Family kFamily, typename T>
std::array<T, 8> entries(const T* x, double rest) {
  const T zero(0.0);
  if constexpr (kFamily == Family::Translation) return {T(rest), zero, x[0], zero, T(rest), x[1], zero, zero};
  if constexpr (kFamily == Family::Isotropic) return {x[0], zero, x[1], zero, x[0], x[2], zero, zero};
  if constexpr (kFamily == Family::XyScale) return {x[0], zero, x[1], zero, x[2], x[3], zero, zero};
  if constexpr (kFamily == Family::Affine) return {x[0], x[1], x[2], x[3], x[4], x[5], zero, zero};
  if constexpr (kFamily == Family::Perspective) return {x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7]};
}

constexpr int unknowns(Family family) {
  constexpr std::array<int, 5> kUnknowns{2, 3, 4, 6, 8};
  return kUnknowns[static_cast<int>(family)];
}

/// Errors below this share of the size of the points now cannot be made smaller.
constexpr double kRounding = 1e-13;

/// What one continuation step minimises: Σ (‖r‖ / scale)ᵖ.
struct Power {
  int p = 2;
  double scale = 1;
};

template <Family kFamily>
struct Residual {
  dvec2 q, p;
  double rest;
  Power power;

  template <typename T>
  bool operator()(const T* x, T* out) const {
    const std::array<T, 8> e = entries<kFamily>(x, rest);
    const T w = e[6] * q.x + e[7] * q.y + 1.0;
    if (!(w > 0.0)) return false;
    const T rx = (e[0] * q.x + e[1] * q.y + e[2]) / w - p.x, ry = (e[3] * q.x + e[4] * q.y + e[5]) / w - p.y;
    out[0] = rx / power.scale;
    out[1] = ry / power.scale;
    if (power.p == 2) return true;
    // The square of this scalar is ‖r‖ᵖ; p ≥ 4 keeps it differentiable at r = 0. A step that makes an error
    // ten times the last largest one is refused before its power overflows.
    const T squared = out[0] * out[0] + out[1] * out[1];
    if (!(squared < 100.0)) return false;
    out[0] = ceres::pow(squared, power.p / 4.0);
    out[1] = T(0.0);
    return true;
  }
};

/// Both sides normalised by a similarity, so that no family is distorted.
struct Problem {
  std::span<const dvec2> then_px, now_px;
  PerspectiveFrame frame;
  double rest = 1;
};

Problem problem_of(std::span<const dvec2> then_px, std::span<const dvec2> now_px) {
  TALISMAN_CHECK_EQ(then_px.size(), now_px.size());
  Spread then = spread_of(then_px);
  then.axis = {1, 0};
  then.sigma_2 = then.sigma_1 = then.sigma_1 > 0 ? then.sigma_1 : 1;
  const PerspectiveFrame frame = perspective_frame(now_px, then);
  return {then_px, now_px, frame, then.sigma_1 / frame.now_scale};
}

ceres::Solver::Options quiet_options() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-15;
  options.gradient_tolerance = 1e-15;
  options.parameter_tolerance = 1e-13;
  return options;
}

template <Family kFamily>
FitStatus minimise(const Problem& problem, Power power, double* x, int& iterations) {
  ceres::Problem sum;
  for (std::size_t i = 0; i < problem.then_px.size(); ++i) {
    auto* residual =
        new Residual<kFamily>{problem.frame.normalised_then(problem.then_px[i]),
                              problem.frame.normalised_now(problem.now_px[i]), problem.rest, power};
    sum.AddResidualBlock(new ceres::AutoDiffCostFunction<Residual<kFamily>, 2, unknowns(kFamily)>(residual),
                         nullptr, x);
  }
  ceres::Solver::Summary summary;
  ceres::Solve(quiet_options(), &sum, &summary);
  iterations += static_cast<int>(summary.iterations.size());
  return summary.termination_type == ceres::CONVERGENCE ? FitStatus::Converged : FitStatus::NotConverged;
}

template <Family kFamily>
Warp warp_from(const Problem& problem, const double* x) {
  const std::array<double, 8> e = entries<kFamily>(x, problem.rest);
  Warp warp = problem.frame.to_pixels({e[0], e[3], e[6], e[1], e[4], e[7], e[2], e[5], 1});
  warp.family = kFamily;
  return warp;
}

/// p = 2, 4, … each time in units of the last largest error, so that powers neither overflow nor vanish.
template <Family kFamily>
FitResult continue_powers(const Problem& problem, std::array<double, 8> x, int log2_p) {
  FitResult best;
  best.max_px = kHugePx;
  int iterations = 0;
  Power power;
  for (int k = 1; k <= log2_p; ++k) {
    power.p = 1 << k;
    FitResult result;
    result.status = minimise<kFamily>(problem, power, x.data(), iterations);
    result.warp = warp_from<kFamily>(problem, x.data());
    measure(problem.then_px, problem.now_px, result);
    if (!(result.max_px > kRounding * problem.frame.now_scale)) return result;
    if (result.max_px < best.max_px || log2_p == 1) best = result;
    power.scale = result.max_px / problem.frame.now_scale;
  }
  best.iterations = iterations;
  return best;
}

/// The entries of a warp between normalised coordinates, divided by the denominator at the centroid.
std::array<double, 8> normalised_entries(const Problem& problem, const Warp& warp) {
  const PerspectiveFrame& f = problem.frame;
  const dvec2 c = f.then.centroid;
  const double s = f.then.sigma_1;
  const dmat3 from_then{s, 0, 0, 0, s, 0, c.x, c.y, 1};
  const dmat3 to_now{1, 0, 0, 0, 1, 0, -f.now_centroid.x, -f.now_centroid.y, f.now_scale};
  dmat3 h = to_now * (warp.now_from_then * from_then);
  h = h * (1 / h[2].z);
  return {h[0].x, h[1].x, h[2].x, h[0].y, h[1].y, h[2].y, h[0].z, h[1].z};
}

}  // namespace

FitResult ceres_post_divide(std::span<const dvec2> then_px, std::span<const dvec2> now_px,
                            const Warp& start) {
  const Problem problem = problem_of(then_px, now_px);
  std::array<double, 8> x = normalised_entries(problem, start);
  FitResult result;
  result.status = minimise<Family::Perspective>(problem, {}, x.data(), result.iterations);
  result.warp = warp_from<Family::Perspective>(problem, x.data());
  return result;
}

FitResult ceres_max_norm(std::span<const dvec2> then_px, std::span<const dvec2> now_px, Family family,
                         int log2_p) {
  TALISMAN_CHECK_GE(log2_p, 1);
  const Problem problem = problem_of(then_px, now_px);
  const double k = problem.rest;
  switch (family) {
    case Family::Translation:
      return continue_powers<Family::Translation>(problem, {0, 0}, log2_p);
    case Family::Isotropic:
      return continue_powers<Family::Isotropic>(problem, {k, 0, 0}, log2_p);
    case Family::XyScale:
      return continue_powers<Family::XyScale>(problem, {k, 0, k, 0}, log2_p);
    case Family::Affine:
      return continue_powers<Family::Affine>(problem, {k, 0, 0, 0, k, 0}, log2_p);
    case Family::Perspective:
      return continue_powers<Family::Perspective>(problem, {k, 0, 0, 0, k, 0, 0, 0}, log2_p);
  }
  TALISMAN_CHECK(false && "no such family");
}

}  // namespace talisman::warp
