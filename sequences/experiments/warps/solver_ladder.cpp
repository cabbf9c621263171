// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/warps/solver_ladder.h"

#include <array>
#include <cmath>
#include <memory>

#include "layers/check.h"
#include "sequences/experiments/warps/update_rate.h"
#include "warp/ceres_reference.h"
#include "warp/least_squares.h"
#include "warp/quadrilateral.h"

namespace talisman::sequences {
namespace {

using warp::Curve;
using warp::Family;
using warp::FitOptions;
using warp::FitResult;

// --- The normal equations, naive on purpose

/// Symmetric 3×3: P̂P̂ᵀ.
template <typename T>
struct Moments {
  T xx = 0, xy = 0, yy = 0, x = 0, y = 0, n = 0;
  void add(T px, T py) { xx += px * px, xy += px * py, yy += py * py, x += px, y += py, n += 1; }
};

/// One row of A: the row of P P̂ᵀ times the inverse of P̂P̂ᵀ, which is its adjugate over its determinant.
template <typename T>
std::array<T, 3> solved(const Moments<T>& m, const std::array<T, 3>& r) {
  const T c00 = m.yy * m.n - m.y * m.y, c01 = m.x * m.y - m.xy * m.n, c02 = m.xy * m.y - m.yy * m.x;
  const T c11 = m.xx * m.n - m.x * m.x, c12 = m.xy * m.x - m.xx * m.y, c22 = m.xx * m.yy - m.xy * m.xy;
  const T det = m.xx * c00 + m.xy * c01 + m.x * c02;
  return {(r[0] * c00 + r[1] * c01 + r[2] * c02) / det, (r[0] * c01 + r[1] * c11 + r[2] * c12) / det,
          (r[0] * c02 + r[1] * c12 + r[2] * c22) / det};
}

template <typename T>
FitResult normal_equations(std::span<const dvec2> then_px, std::span<const dvec2> now_px, dvec2 then_centre,
                           dvec2 now_centre) {
  TALISMAN_CHECK_EQ(then_px.size(), now_px.size());
  Moments<T> moments;
  std::array<T, 3> row_x{}, row_y{};
  for (std::size_t i = 0; i < then_px.size(); ++i) {
    const T x = static_cast<T>(then_px[i].x - then_centre.x),
            y = static_cast<T>(then_px[i].y - then_centre.y);
    const T u = static_cast<T>(now_px[i].x - now_centre.x), v = static_cast<T>(now_px[i].y - now_centre.y);
    moments.add(x, y);
    row_x[0] += u * x, row_x[1] += u * y, row_x[2] += u;
    row_y[0] += v * x, row_y[1] += v * y, row_y[2] += v;
  }
  const std::array<T, 3> a = solved(moments, row_x), b = solved(moments, row_y);
  layers::Affine2 map{double(a[0]), double(a[1]), double(a[2]), double(b[0]), double(b[1]), double(b[2])};
  map.tx += now_centre.x - (map.a * then_centre.x + map.b * then_centre.y);
  map.ty += now_centre.y - (map.c * then_centre.x + map.d * then_centre.y);
  const bool finite = std::isfinite(map.a + map.b + map.tx + map.c + map.d + map.ty);
  FitResult result{finite ? warp::FitStatus::Converged : warp::FitStatus::Degenerate,
                   warp::from_affine(Family::Affine, finite ? map : layers::Affine2{})};
  warp::measure(then_px, now_px, result);
  return result;
}

dvec2 centroid(std::span<const dvec2> points) {
  dvec2 sum(0);
  for (const dvec2& p : points) sum += p;
  return points.empty() ? sum : sum / double(points.size());
}

// --- The rungs

bool is_certified(Curve curve) {
  return curve == Curve::trni || curve == Curve::isoi || curve == Curve::soi || curve == Curve::affi ||
         curve == Curve::per2i;
}

Solver of_curve(const std::string& name, Curve curve, const FitOptions& options) {
  const bool decides = options.decide_px >= 0;
  return {name,
          warp::family_of(curve),
          is_certified(curve) && !decides ? options.relative_gap : -1,
          false,
          !decides && curve != Curve::pers,
          [=](const LadderInput& input) -> ReadyFit {
            const bool in_space = curve == Curve::pers || curve == Curve::pers2;
            if (in_space && !input.then.world_points.empty())
              return [=, &input] { return warp::fit(input.then, input.now, input.matched, curve, options); };
            return [=, &input] {
              return warp::fit(input.matched.then_px, input.matched.now_px, curve, options);
            };
          }};
}

Solver with_gap(Curve curve, double gap, const char* gap_text) {
  FitOptions options;
  options.relative_gap = gap;
  return of_curve(std::string(warp::name(curve)) + " gap " + gap_text, curve, options);
}

Solver deciding(Curve curve) {
  FitOptions options;
  options.decide_px = 1;
  return of_curve(std::string(warp::name(curve)) + " decision 1 px", curve, options);
}

using PlaneFit = std::function<FitResult(std::span<const dvec2>, std::span<const dvec2>)>;

Solver on_points(const std::string& name, Family family, const PlaneFit& fit, bool slow = false) {
  return {name, family, -1, slow, true, [=](const LadderInput& input) -> ReadyFit {
            return [=, &input] { return fit(input.matched.then_px, input.matched.now_px); };
          }};
}

Solver kept_k() {
  return {"aff, K kept", Family::Affine, -1, false, true, [](const LadderInput& input) -> ReadyFit {
            const auto solver = std::make_shared<warp::AffineLeastSquares>(input.matched.then_px);
            return [solver, &input] { return solver->fit(input.matched.now_px); };
          }};
}

Solver ceres_max(Family family, int log2_p) {
  return on_points(
      "Ceres p = " + std::to_string(1 << log2_p) + ", " + std::string(warp::name(family)), family,
      [=](auto then, auto now) { return warp::ceres_max_norm(then, now, family, log2_p); }, true);
}

FitResult ceres_sum_of_squares(std::span<const dvec2> then_px, std::span<const dvec2> now_px) {
  FitResult result = warp::ceres_post_divide(then_px, now_px, warp::fit(then_px, now_px, Curve::aff).warp);
  warp::measure(then_px, now_px, result);
  return result;
}

}  // namespace

LadderInput ladder_input(Pairs pairs) {
  LadderInput input;
  for (std::size_t i = 0; i < pairs.size(); ++i) input.matched.point.push_back(-1);
  input.matched.then_px.append(pairs.then_px);
  input.matched.now_px.append(pairs.now_px);
  input.matched.overlap = true;
  return input;
}

LadderInput workload_input(std::uint64_t seed, int points) {
  LadderInput input = ladder_input(moving_box(seed, points));
  const SpacePairs space = moving_box_in_space(seed, points);
  for (auto [state, world] : {std::pair{&input.then, &space.then_m}, std::pair{&input.now, &space.now_m}}) {
    state->view.display_px = {kWorkloadDisplay_px, kWorkloadDisplay_px};
    state->camera.fov_y_rad = kWorkloadFov_rad;
    state->camera.near_m = 0.01;
    state->world_points = *world;
  }
  return input;
}

FitResult fit_normal_equations(std::span<const dvec2> then_px, std::span<const dvec2> now_px) {
  return normal_equations<double>(then_px, now_px, dvec2(0), dvec2(0));
}

FitResult fit_normal_equations_float(std::span<const dvec2> then_px, std::span<const dvec2> now_px,
                                     bool centred) {
  if (!centred) return normal_equations<float>(then_px, now_px, dvec2(0), dvec2(0));
  return normal_equations<float>(then_px, now_px, centroid(then_px), centroid(now_px));
}

std::vector<Solver> solver_ladder() {
  std::vector<Solver> ladder;
  for (const Curve curve : all_curves())
    ladder.push_back(of_curve(std::string(warp::name(curve)), curve, {}));
  const auto naive_float = [](bool centred) {
    return [=](auto then, auto now) { return fit_normal_equations_float(then, now, centred); };
  };
  const std::vector<Solver> others{
      on_points("normal eq. float32", Family::Affine, naive_float(false)),
      on_points("normal eq. float64", Family::Affine, fit_normal_equations),
      on_points("normal eq. float32, centred", Family::Affine, naive_float(true)),
      kept_k(),
      deciding(Curve::affi),
      with_gap(Curve::affi, 1e-1, "1e-1"),
      with_gap(Curve::affi, 1e-2, "1e-2"),
      with_gap(Curve::affi, 1e-3, "1e-3"),
      with_gap(Curve::affi, 1e-9, "1e-9"),
      ceres_max(Family::Affine, 3),
      ceres_max(Family::Affine, 8),
      deciding(Curve::per2i),
      with_gap(Curve::per2i, 1e-1, "1e-1"),
      with_gap(Curve::per2i, 1e-2, "1e-2"),
      with_gap(Curve::per2i, 1e-9, "1e-9"),
      on_points("Ceres sum of squares, perspective", Family::Perspective, ceres_sum_of_squares, true),
      ceres_max(Family::Perspective, 8),
  };
  ladder.insert(ladder.end(), others.begin(), others.end());
  return ladder;
}

}  // namespace talisman::sequences
