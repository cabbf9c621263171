// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which solvers are there for a warp, from the quickest to the most exact?
///
/// The rungs of the ladder: the fourteen curves as fit() computes them; the same problems stopped earlier or
/// later (decision mode, other gaps); the affine fit with its K kept; Ceres as the independent reference;
/// and, as a lower rung on purpose, the normal equations exactly as [LS97 4.1] prints them,
///
///   A = P P̂ᵀ (P̂P̂ᵀ)⁻¹        P̂, P: columns (x, y, 1)
///
/// in float32 and in float64, neither centred nor scaled, and centred in float32. They are here to show what
/// they lose far from the origin [A §5]; nothing else uses them.

#include <functional>
#include <string>
#include <vector>

#include "layers/state.h"
#include "sequences/experiments/warps/point_workload.h"
#include "warp/fit.h"

namespace talisman::sequences {

/// One fit to be made: the points, and the layer in space for the curves that need it.
struct LadderInput {
  layers::Correspondences matched;
  layers::LayerState then, now;  ///< without points where there is only the plane
};
LadderInput ladder_input(Pairs pairs);
/// Box `seed` of the realistic workload (point_workload.h), in space.
LadderInput workload_input(std::uint64_t seed, int points);

/// A fit that is ready to run: whatever is done once per render has been done.
using ReadyFit = std::function<warp::FitResult()>;

struct Solver {
  std::string name;  ///< "affi", "affi gap 1e-2", "normal eq. float32", …
  warp::Family family = warp::Family::Affine;
  /// The relative gap that it promises between max_px and its certified lower bound; negative: no
  /// certificate.
  double promised_gap = -1;
  bool slow = false;  ///< milliseconds: measured on fewer inputs
  /// Carries points of an exact map of its family without error; not so a fit that stops at a pixel on
  /// purpose or that needs the layer in space.
  bool exact = true;
  /// The input must outlive the fit.
  std::function<ReadyFit(const LadderInput&)> prepare;
};

/// All rungs, by family, the fourteen curves first.
std::vector<Solver> solver_ladder();

/// The normal equations as printed, in double or float; Degenerate where P̂P̂ᵀ has no inverse in that
/// precision. Errors are filled in. At least 1 point.
warp::FitResult fit_normal_equations(std::span<const dvec2> then_px, std::span<const dvec2> now_px);
warp::FitResult fit_normal_equations_float(std::span<const dvec2> then_px, std::span<const dvec2> now_px,
                                           bool centred);

}  // namespace talisman::sequences
