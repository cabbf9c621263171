// SPDX-License-Identifier: Apache-2.0
#include "warp/max_norm.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "layers/check.h"
#include "warp/conditioning.h"
#include "warp/enclosing_disc.h"
#include "warp/linear_families.h"
#include "warp/max_norm_parts.h"
#include "warp/min_max.h"

namespace talisman::warp {
namespace {

// The displacements lie in a disc about the best translation, and its radius is the error.
FitResult fit_translation(std::span<const dvec2> then_px, std::span<const dvec2> now_px) {
  std::vector<dvec2> displacements(then_px.size());
  std::transform(now_px.begin(), now_px.end(), then_px.begin(), displacements.begin(), std::minus<>());
  const EnclosingDisc disc = smallest_enclosing_disc(displacements);
  const Affine2 map{1, 0, disc.centre.x, 0, 1, disc.centre.y};
  FitResult result = measured(then_px, now_px, from_affine(Family::Translation, map), true);
  result.max_lower_bound_px = std::fmin(disc.lower, result.max_px);
  result.iterations = disc.iterations;
  return result;
}

template <class Model>
FitResult fit_linear(std::span<const dvec2> then_px, std::span<const dvec2> now_px,
                     const FitOptions& options) {
  ResidualColumns columns(then_px, now_px, Model::kWhitening);
  if (!columns.spans()) return fit_nothing(then_px, now_px, Model::kFamily);
  Model model(columns);
  MinMax<Model> run(model, Goal(options, columns));
  const bool reached = run.run(options.max_iterations);
  if (!run.progress().found) return fit_nothing(then_px, now_px, Model::kFamily);
  FitResult result =
      measured(then_px, now_px, from_affine(Model::kFamily, columns.in_pixels(model.map())), reached);
  result.max_lower_bound_px = std::fmin(run.progress().bounds.lower * columns.unit_px(), result.max_px);
  result.iterations = run.progress().iterations;
  return result;
}

}  // namespace

std::optional<FitResult> refuse(std::span<const dvec2> then_px, std::span<const dvec2> now_px,
                                Family family) {
  TALISMAN_CHECK_EQ(then_px.size(), now_px.size());
  const int bad_then = first_bad_point(then_px), bad_now = first_bad_point(now_px);
  if (bad_then >= 0 || bad_now >= 0) {
    FitResult result;
    result.status = FitStatus::NotFinite;
    result.rms_px = result.max_px = kHugePx;
    result.worst_point = bad_then < 0 ? bad_now : bad_now < 0 ? bad_then : std::min(bad_then, bad_now);
    return result;
  }
  if (static_cast<int>(then_px.size()) >= points_needed(family)) return std::nullopt;
  FitResult result = then_px.empty() ? FitResult{} : fit_translation(then_px, now_px);
  result.status = FitStatus::TooFewPoints;
  return result;
}

FitResult fit_nothing(std::span<const dvec2> then_px, std::span<const dvec2> now_px, Family asked_for) {
  FitResult result = fit_translation(then_px, now_px);
  if (asked_for != Family::Translation) result.status = FitStatus::Degenerate;
  return result;
}

FitResult measured(std::span<const dvec2> then_px, std::span<const dvec2> now_px, const Warp& warp,
                   bool reached) {
  FitResult result;
  result.warp = warp;
  measure(then_px, now_px, result);
  result.status = !acceptable(warp, then_px) ? FitStatus::Degenerate
                  : reached                  ? FitStatus::Converged
                                             : FitStatus::NotConverged;
  return result;
}

FitResult fit_max_norm(std::span<const dvec2> then_px, std::span<const dvec2> now_px, Family family,
                       const FitOptions& options) {
  if (auto refused = refuse(then_px, now_px, family)) return *refused;
  switch (family) {
    case Family::Translation:
      return fit_translation(then_px, now_px);
    case Family::Isotropic:
      return fit_linear<IsotropicModel>(then_px, now_px, options);
    case Family::XyScale:
      return fit_linear<XyScaleModel>(then_px, now_px, options);
    case Family::Affine:
      return fit_linear<AffineModel>(then_px, now_px, options);
    case Family::Perspective:
      return fit_post_divide_max_norm(then_px, now_px, options);
  }
  TALISMAN_CHECK(false && "no such family");
}

}  // namespace talisman::warp
