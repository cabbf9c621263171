// SPDX-License-Identifier: Apache-2.0
#include "warp/fit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "layers/check.h"
#include "warp/ceres_reference.h"
#include "warp/conditioning.h"
#include "warp/homography.h"
#include "warp/least_squares.h"
#include "warp/max_norm.h"

namespace talisman::warp {
namespace {

enum class Norm { SumOfSquares, Maximum };

Norm norm_of(Curve curve) {
  switch (curve) {
    case Curve::trni:
    case Curve::isoi:
    case Curve::soi:
    case Curve::affi:
    case Curve::peri:
    case Curve::per2i:
      return Norm::Maximum;
    default:
      return Norm::SumOfSquares;
  }
}

Family simpler(Family family) { return static_cast<Family>(static_cast<int>(family) - 1); }

FitResult not_finite(int point) {
  FitResult result;
  result.status = FitStatus::NotFinite;
  result.rms_px = result.max_px = kHugePx;
  result.worst_point = point;
  return result;
}

/// One call of fit(), with what all families of the chain share.
class Chain {
 public:
  Chain(std::span<const dvec2> then_px, std::span<const dvec2> now_px, Curve curve, const FitOptions& options)
      : then_px_(then_px),
        now_px_(now_px),
        curve_(curve),
        options_(options),
        spread_(spread_of(then_px)),
        at_rest_(std::equal(then_px.begin(), then_px.end(), now_px.begin())) {}

  /// The answer of `family`, or of the first simpler one that has any.
  FitResult best_of(Family family) const {
    if (static_cast<int>(then_px_.size()) < points_needed(family))
      return demoted(family, FitStatus::TooFewPoints);
    const double trust = strength(family, spread_);
    if (trust == 0) return demoted(family, FitStatus::Degenerate);
    FitResult result = at_rest_ ? FitResult{FitStatus::Converged, Warp{family}} : solve(family);
    if (family == Family::Translation) return result;
    if (result.status == FitStatus::Degenerate || !acceptable(result.warp, then_px_))
      return demoted(family, FitStatus::Degenerate);
    return trust < 1 ? handed_over(result, trust) : result;
  }

 private:
  FitResult demoted(Family family, FitStatus why) const {
    FitResult result = best_of(simpler(family));
    result.status = why;
    return result;
  }

  /// Between two families: the maps are mixed, so that the answer changes smoothly as the points lose their
  /// spread.
  FitResult handed_over(FitResult result, double trust) const {
    const FitResult plain = best_of(simpler(result.warp.family));
    Warp mixed{result.warp.family,
               trust * result.warp.now_from_then + (1 - trust) * plain.warp.now_from_then};
    if (!acceptable(mixed, then_px_)) mixed = plain.warp;
    result.warp = mixed;
    result.status = FitStatus::Degenerate;
    return result;
  }

  FitResult solve(Family family) const {
    if (family == Family::Perspective) return solve_perspective();
    if (norm_of(curve_) == Norm::Maximum) return fit_max_norm(then_px_, now_px_, family, options_);
    return {FitStatus::Converged, fit_least_squares(then_px_, now_px_, family, spread_)};
  }

  FitResult solve_perspective() const {
    switch (curve_) {
      case Curve::per:
        return fit_homogeneous(then_px_, now_px_, spread_);
      case Curve::per2:
        return fit_post_divide(then_px_, now_px_, spread_, options_);
      case Curve::peri:
        return fit_max_norm_homogeneous(then_px_, now_px_, options_);
      case Curve::per2i:
        return fit_max_norm(then_px_, now_px_, Family::Perspective, options_);
      case Curve::pers2:
        return ceres_post_divide(then_px_, now_px_, best_of(Family::Affine).warp);
      default:
        return {FitStatus::Degenerate, {}};  // pers: no quadrilateral without the layer in space
    }
  }

  std::span<const dvec2> then_px_, now_px_;
  Curve curve_;
  FitOptions options_;
  Spread spread_;
  bool at_rest_;
};

/// Sum and largest of the squared errors, in the order of the points.
template <typename Map>
void measure_with(std::span<const dvec2> then_px, std::span<const dvec2> now_px, FitResult& result, Map map) {
  double sum = 0, largest = -1;
  int worst = 0;
  for (std::size_t i = 0; i < then_px.size(); ++i) {
    const dvec2 r = map(then_px[i]) - now_px[i];
    const double squared = r.x * r.x + r.y * r.y;
    sum += squared;
    worst =
        squared > largest ? static_cast<int>(i) : worst;  // a branch here would often be predicted wrongly
    largest = squared > largest ? squared : largest;
  }
  result.rms_px = std::sqrt(sum / static_cast<double>(then_px.size()));
  result.max_px = std::sqrt(largest);
  result.worst_point = worst;
}

}  // namespace

std::string_view name(FitStatus status) {
  switch (status) {
    case FitStatus::Converged:
      return "converged";
    case FitStatus::TooFewPoints:
      return "too few points";
    case FitStatus::Degenerate:
      return "degenerate";
    case FitStatus::NotFinite:
      return "not finite";
    case FitStatus::NotConverged:
      return "not converged";
  }
  TALISMAN_CHECK(false && "no such status");
}

void measure(std::span<const dvec2> then_px, std::span<const dvec2> now_px, FitResult& result) {
  TALISMAN_CHECK_EQ(then_px.size(), now_px.size());
  result.rms_px = result.max_px = 0;
  result.worst_point = -1;
  if (then_px.empty()) return;
  if (result.warp.is_affine()) {
    measure_with(then_px, now_px, result, result.warp.affine());
  } else {
    // Beyond the horizon a point has no image: it counts as being infinitely far away.
    measure_with(then_px, now_px, result, [&](dvec2 p) {
      return result.warp.denominator(p) > 0 ? result.warp(p) : dvec2(2 * kHugePx);
    });
  }
  if (!(result.rms_px <= kHugePx)) result.rms_px = kHugePx;
  if (!(result.max_px <= kHugePx)) result.max_px = kHugePx;
}

FitResult fit(std::span<const dvec2> then_px, std::span<const dvec2> now_px, Curve curve,
              const FitOptions& options) {
  TALISMAN_CHECK_EQ(then_px.size(), now_px.size());
  const Family family = family_of(curve);
  if (then_px.empty()) return {FitStatus::TooFewPoints, Warp{Family::Translation}};
  const int bad_then = first_bad_point(then_px), bad_now = first_bad_point(now_px);
  if (bad_then >= 0 || bad_now >= 0)
    return not_finite(bad_then < 0 ? bad_now : bad_now < 0 ? bad_then : std::min(bad_then, bad_now));
  FitResult result = Chain(then_px, now_px, curve, options).best_of(family);
  measure(then_px, now_px, result);
  result.max_lower_bound_px = std::fmin(result.max_lower_bound_px, result.max_px);
  return result;
}

}  // namespace talisman::warp
