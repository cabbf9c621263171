// SPDX-License-Identifier: Apache-2.0
#include "warp/homography.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "layers/check.h"

namespace talisman::warp {
namespace {

/// Below this mean square, in normalised units, a column of the Jacobian is nothing but rounding.
constexpr double kNoInformation = 1e-20;
/// The iteration stops when the next step promises less than this share of the sum of squares …
constexpr double kRelativePromise = 1e-14;
/// … or less than this per point: the square of the rounding of a normalised coordinate.
constexpr double kRoundingPromise = 1e-31;
constexpr double kFirstDamping = 1e-3, kLargestDamping = 1e8;

struct Pair {
  dvec2 q, p;  ///< normalised then and now
};

struct Row {
  double w = 1, per_w = 1;
  std::array<double, 3> basis{};  ///< orthonormal over the points, spans 1/w, u/w, v/w
  dvec2 residual{0, 0};           ///< p minus the best A q / w
};

/// What the projection leaves of the problem at one (g, h).
struct State {
  dvec2 gh{0, 0};
  double cost = 0;  ///< sum of squared residuals
  std::vector<Row> rows;
  std::array<double, 6> r{};  ///< upper triangle of the basis change: 00 01 02 11 12 22
};

/// A 2×2 symmetric system in g and h.
struct Normal {
  double gg = 0, gh = 0, hh = 0;
  dvec2 gradient{0, 0};
  double smaller_eigenvalue() const {
    const double half = (gg - hh) / 2;
    return (gg + hh) / 2 - std::sqrt(half * half + gh * gh);
  }
  dvec2 solve(double damping) const {
    const double a = gg * (1 + damping), d = hh * (1 + damping), det = a * d - gh * gh;
    return {(gradient.x * d - gradient.y * gh) / det, (gradient.y * a - gradient.x * gh) / det};
  }
};

class Separable {
 public:
  Separable(std::span<const dvec2> then_px, std::span<const dvec2> now_px, const PerspectiveFrame& frame) {
    pairs_.reserve(then_px.size());
    for (std::size_t i = 0; i < then_px.size(); ++i)
      pairs_.push_back({frame.normalised_then(then_px[i]), frame.normalised_now(now_px[i])});
  }

  double count() const { return static_cast<double>(pairs_.size()); }

  /// Fills `state` for `gh`; false when a denominator is not positive or the horizon comes too near.
  bool evaluate(dvec2 gh, State& state) const {
    state.gh = gh;
    state.rows.resize(pairs_.size());
    double least = HUGE_VAL, most = 0;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      const double w = 1 + gh.x * pairs_[i].q.x + gh.y * pairs_[i].q.y;
      state.rows[i].w = w;
      least = std::min(least, w);
      most = std::max(most, w);
    }
    if (!(least >= kSmallestDenominatorRatio * most) || !std::isfinite(most)) return false;
    orthonormalise(state);
    project(state);
    return std::isfinite(state.cost);
  }

  /// Step direction in (g, h): derivatives of the residuals, A projected out. `homogeneous` takes the points
  /// themselves instead of their fitted images, which makes the step at g = h = 0 the exact solution of
  /// `per`.
  Normal normal(const State& state, bool homogeneous) const {
    Normal n;
    std::array<dvec2, 3> on_g{}, on_h{};  // components of the columns along the basis
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      const Columns c = columns(state, i, homogeneous);
      for (int k = 0; k < 3; ++k)
        on_g[k] += c.g * state.rows[i].basis[k], on_h[k] += c.h * state.rows[i].basis[k];
    }
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      Columns c = columns(state, i, homogeneous);
      const auto& basis = state.rows[i].basis;
      c.g -= on_g[0] * basis[0] + on_g[1] * basis[1] + on_g[2] * basis[2];
      c.h -= on_h[0] * basis[0] + on_h[1] * basis[1] + on_h[2] * basis[2];
      const dvec2 r = state.rows[i].residual;
      n.gg += c.g.x * c.g.x + c.g.y * c.g.y;
      n.gh += c.g.x * c.h.x + c.g.y * c.h.y;
      n.hh += c.h.x * c.h.x + c.h.y * c.h.y;
      n.gradient += dvec2{c.g.x * r.x + c.g.y * r.y, c.h.x * r.x + c.h.y * r.y};
    }
    return n;
  }

  /// The homography with the A that fits p (after the divide, `state` at gh) or p w (before it, `state` at
  /// 0).
  dmat3 homography(const State& state, dvec2 gh, bool homogeneous) const {
    std::array<dvec2, 3> c{};
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      const double w = homogeneous ? 1 + gh.x * pairs_[i].q.x + gh.y * pairs_[i].q.y : 1.0;
      for (int k = 0; k < 3; ++k) c[k] += pairs_[i].p * (w * state.rows[i].basis[k]);
    }
    const auto& r = state.r;
    c[2] = c[2] / r[5];
    c[1] = (c[1] - c[2] * r[4]) / r[3];
    c[0] = (c[0] - c[1] * r[1] - c[2] * r[2]) / r[0];
    return {c[1].x, c[1].y, gh.x, c[2].x, c[2].y, gh.y, c[0].x, c[0].y, 1};
  }

 private:
  struct Columns {
    dvec2 g, h;
  };
  Columns columns(const State& state, std::size_t i, bool homogeneous) const {
    const Row& row = state.rows[i];
    const dvec2 image = homogeneous ? pairs_[i].p : (pairs_[i].p - row.residual) * row.per_w;
    return {image * pairs_[i].q.x, image * pairs_[i].q.y};
  }

  /// Modified Gram-Schmidt of the columns 1/w, u/w, v/w, which whitening has made nearly orthogonal already.
  /// Each pass takes out one column and sums what the next needs.
  void orthonormalise(State& state) const {
    auto& rows = state.rows;
    auto& r = state.r;
    double s00 = 0, s01 = 0, s02 = 0, s11 = 0, s12 = 0, s22 = 0;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      const double per_w = 1 / rows[i].w;
      auto& b = rows[i].basis;
      b = {per_w, pairs_[i].q.x * per_w, pairs_[i].q.y * per_w};
      rows[i].per_w = per_w;
      s00 += b[0] * b[0], s01 += b[0] * b[1], s02 += b[0] * b[2];
    }
    r[0] = std::sqrt(s00), r[1] = s01 / r[0], r[2] = s02 / r[0];
    for (Row& row : rows) {
      auto& b = row.basis;
      b[0] /= r[0];
      b[1] -= r[1] * b[0], b[2] -= r[2] * b[0];
      s11 += b[1] * b[1], s12 += b[1] * b[2];
    }
    r[3] = std::sqrt(s11), r[4] = s12 / r[3];
    for (Row& row : rows) {
      auto& b = row.basis;
      b[1] /= r[3];
      b[2] -= r[4] * b[1];
      s22 += b[2] * b[2];
    }
    r[5] = std::sqrt(s22);
    for (Row& row : rows) row.basis[2] /= r[5];
  }

  void project(State& state) const {
    std::array<dvec2, 3> c{};
    for (std::size_t i = 0; i < pairs_.size(); ++i)
      for (int k = 0; k < 3; ++k) c[k] += pairs_[i].p * state.rows[i].basis[k];
    state.cost = 0;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      Row& row = state.rows[i];
      row.residual = pairs_[i].p - (c[0] * row.basis[0] + c[1] * row.basis[1] + c[2] * row.basis[2]);
      state.cost += row.residual.x * row.residual.x + row.residual.y * row.residual.y;
    }
  }

  std::vector<Pair> pairs_;
};

/// The state at g = h = 0 (the affine fit) and the (g, h) of the homogeneous fit; empty where they are not
/// determined.
struct Start {
  State affine;
  dvec2 homogeneous{0, 0};
};
std::optional<Start> start_of(const Separable& problem) {
  Start start;
  if (!problem.evaluate({0, 0}, start.affine)) return std::nullopt;
  const Normal normal = problem.normal(start.affine, true);
  if (!(normal.smaller_eigenvalue() > kNoInformation * problem.count())) return std::nullopt;
  start.homogeneous = -normal.solve(0);
  return start;
}

/// Levenberg-Marquardt over (g, h). `state` is the start and the result.
struct Descent {
  FitStatus status = FitStatus::NotConverged;
  int iterations = 0;
};
Descent descend(const Separable& problem, State& state, State& trial, int max_iterations) {
  Descent done;
  double damping = 0;
  bool at_horizon = false;
  Normal normal = problem.normal(state, false);
  while (done.iterations < max_iterations) {
    const dvec2 step = -normal.solve(damping);
    const double promise = -(step.x * normal.gradient.x + step.y * normal.gradient.y);
    const bool at_rest = !(promise > kRelativePromise * state.cost + kRoundingPromise * problem.count());
    if (at_rest || damping > kLargestDamping) {
      // A step that only the horizon forbids means that the minimum lies beyond it.
      done.status = at_horizon ? FitStatus::Degenerate : FitStatus::Converged;
      return done;
    }
    ++done.iterations;
    const bool feasible = problem.evaluate(state.gh + step, trial);
    if (feasible && trial.cost < state.cost) {
      std::swap(state, trial);
      normal = problem.normal(state, false);
      damping = damping > kFirstDamping ? damping / 10 : 0;
      at_horizon = false;
    } else {
      at_horizon = !feasible;
      damping = std::max(kFirstDamping, damping * 10);
    }
  }
  return done;
}

}  // namespace

dvec2 PerspectiveFrame::normalised_then(dvec2 p) const {
  const dvec2 d = p - then.centroid;
  return {(d.x * then.axis.x + d.y * then.axis.y) / then.sigma_1,
          (d.y * then.axis.x - d.x * then.axis.y) / then.sigma_2};
}

Warp PerspectiveFrame::to_pixels(const dmat3& normalised) const {
  const dvec2 along = then.axis / then.sigma_1, across = dvec2{-then.axis.y, then.axis.x} / then.sigma_2;
  const dmat3 from_centred{along.x, across.x, 0, along.y, across.y, 0, 0, 0, 1};
  const dmat3 centred{1, 0, 0, 0, 1, 0, -then.centroid.x, -then.centroid.y, 1};
  const dmat3 to_px{now_scale, 0, 0, 0, now_scale, 0, now_centroid.x, now_centroid.y, 1};
  return {Family::Perspective, to_px * (normalised * from_centred) * centred};
}

PerspectiveFrame perspective_frame(std::span<const dvec2> now_px, const Spread& then) {
  const Spread now = spread_of(now_px);
  const double scale = std::hypot(now.sigma_x, now.sigma_y) / std::sqrt(2.0);
  return {then, now.centroid, scale > 0 ? scale : 1.0};
}

FitResult fit_homogeneous(std::span<const dvec2> then_px, std::span<const dvec2> now_px, const Spread& then) {
  TALISMAN_CHECK_EQ(then_px.size(), now_px.size());
  const PerspectiveFrame frame = perspective_frame(now_px, then);
  const Separable problem(then_px, now_px, frame);
  const auto start = start_of(problem);
  if (!start) return {FitStatus::Degenerate, {}};
  return {FitStatus::Converged, frame.to_pixels(problem.homography(start->affine, start->homogeneous, true))};
}

FitResult fit_post_divide(std::span<const dvec2> then_px, std::span<const dvec2> now_px, const Spread& then,
                          const FitOptions& options) {
  TALISMAN_CHECK_EQ(then_px.size(), now_px.size());
  const PerspectiveFrame frame = perspective_frame(now_px, then);
  const Separable problem(then_px, now_px, frame);
  auto start = start_of(problem);
  if (!start) return {FitStatus::Degenerate, {}};
  State& state = start->affine;
  State trial;
  if (problem.evaluate(start->homogeneous, trial) && trial.cost < state.cost) std::swap(state, trial);
  const Descent done = descend(problem, state, trial, options.max_iterations);
  FitResult result{done.status, frame.to_pixels(problem.homography(state, state.gh, false))};
  result.iterations = done.iterations;
  return result;
}

}  // namespace talisman::warp
