// SPDX-License-Identifier: Apache-2.0
#include "warp/least_squares.h"

#include <cmath>
#include <cstdint>

#include "layers/check.h"

namespace talisman::warp {
namespace {

dvec2 mean_of(std::span<const dvec2> points) {
  dvec2 sum{0, 0};
  for (const dvec2& p : points) sum += p - points[0];
  return points[0] + sum / static_cast<double>(points.size());
}

/// The row kᵢ of K for any point p̂ᵢ: the dual of the basis (along the long axis, across it).
class RowOfK {
 public:
  RowOfK(std::span<const dvec2> then_px, const Spread& spread)
      : centroid_(spread.centroid), axis_(spread.axis), per_sigma_(1 / spread.sigma_1, 1 / spread.sigma_2) {
    double uv = 0, vv = 0, uu = 0;
    for (const dvec2& p : then_px) {
      const dvec2 q = along_axes(p);
      uu += q.x * q.x, uv += q.x * q.y, vv += q.y * q.y;
    }
    slant_ = uv / uu;  // rounding leaves the axes slightly coupled
    per_u_ = 1 / uu;
    per_v_ = 1 / (vv - slant_ * uv);
  }

  dvec2 operator()(dvec2 p) const {
    const dvec2 q = along_axes(p);
    const double across = (q.y - slant_ * q.x) * per_v_, along = q.x * per_u_ - slant_ * across;
    const dvec2 k = dvec2{along, across} * per_sigma_;
    return {k.x * axis_.x - k.y * axis_.y, k.x * axis_.y + k.y * axis_.x};
  }

 private:
  /// In units of the spread along each axis, so that neither large nor tiny sprites leave the range of a
  /// double.
  dvec2 along_axes(dvec2 p) const {
    const dvec2 d = p - centroid_;
    return dvec2{d.x * axis_.x + d.y * axis_.y, d.y * axis_.x - d.x * axis_.y} * per_sigma_;
  }

  dvec2 centroid_, axis_, per_sigma_;
  double slant_ = 0, per_u_ = 0, per_v_ = 0;
};

/// D and t from the points now and the rows of K, `row(i)`.
template <typename Row>
Affine2 affine_from(std::span<const dvec2> now_px, dvec2 centroid, Row row) {
  const dvec2 origin = now_px[0];
  dvec2 sum{0, 0}, along_x{0, 0}, along_y{0, 0};
  for (std::size_t i = 0; i < now_px.size(); ++i) {
    const dvec2 moved = now_px[i] - origin, k = row(i);
    sum += moved;
    along_x += moved * k.x;
    along_y += moved * k.y;
  }
  const dvec2 mean = origin + sum / static_cast<double>(now_px.size());
  const dvec2 t = mean - (along_x * centroid.x + along_y * centroid.y);
  return {along_x.x, along_y.x, t.x, along_x.y, along_y.y, t.y};
}

Affine2 fit_affine(std::span<const dvec2> then_px, std::span<const dvec2> now_px, const Spread& spread) {
  const RowOfK row(then_px, spread);
  return affine_from(now_px, spread.centroid, [&](std::size_t i) { return row(then_px[i]); });
}

/// s and t of each axis, or of both together; deviations in units of `unit_px`.
Affine2 fit_scale(std::span<const dvec2> then_px, std::span<const dvec2> now_px, dvec2 centroid,
                  dvec2 unit_px, bool one_scale) {
  const dvec2 mean = mean_of(now_px);
  dvec2 squares{0, 0}, products{0, 0};
  for (std::size_t i = 0; i < now_px.size(); ++i) {
    const dvec2 d = (then_px[i] - centroid) / unit_px;
    squares += d * d;
    products += d * ((now_px[i] - mean) / unit_px);
  }
  dvec2 scale = products / squares;
  if (one_scale) scale.x = scale.y = (products.x + products.y) / (squares.x + squares.y);
  const dvec2 t = mean - scale * centroid;
  return {scale.x, 0, t.x, 0, scale.y, t.y};
}

}  // namespace

Warp fit_least_squares(std::span<const dvec2> then_px, std::span<const dvec2> now_px, Family family,
                       const Spread& spread) {
  TALISMAN_CHECK_EQ(then_px.size(), now_px.size());
  TALISMAN_CHECK(!then_px.empty() && family != Family::Perspective);
  const dvec2 centroid = spread.centroid;
  switch (family) {
    case Family::Translation: {
      const dvec2 t = mean_of(now_px) - centroid;
      return from_affine(family, {1, 0, t.x, 0, 1, t.y});
    }
    case Family::Isotropic:
      return from_affine(family, fit_scale(then_px, now_px, centroid, dvec2(spread.sigma_1), true));
    case Family::XyScale:
      return from_affine(family,
                         fit_scale(then_px, now_px, centroid, {spread.sigma_x, spread.sigma_y}, false));
    default:
      return from_affine(family, fit_affine(then_px, now_px, spread));
  }
}

AffineLeastSquares::AffineLeastSquares(std::span<const dvec2> then_px)
    : then_px_(then_px.begin(), then_px.end()) {
  if (static_cast<int>(then_px.size()) < points_needed(Family::Affine) || first_bad_point(then_px) >= 0)
    return;
  const Spread spread = spread_of(then_px);
  if (strength(Family::Affine, spread) < 1) return;
  centroid_ = spread.centroid;
  const RowOfK row(then_px, spread);
  k_.reserve(then_px.size());
  for (const dvec2& p : then_px) k_.push_back(row(p));
}

FitResult AffineLeastSquares::fit(std::span<const dvec2> now_px) const {
  TALISMAN_CHECK_EQ(then_px_.size(), now_px.size());
  if (k_.empty() || now_px[0] == then_px_[0])
    return warp::fit(then_px_, now_px, Curve::aff);  // perhaps at rest
  const Affine2 map = affine_from(now_px, centroid_, [&](std::size_t i) { return k_[i]; });
  FitResult result{FitStatus::Converged, from_affine(Family::Affine, map)};
  // A point that is not finite makes the map so; one that is merely huge is refused with the fit's own limit.
  if (!acceptable(result.warp, {})) return warp::fit(then_px_, now_px, Curve::aff);
  measure(then_px_, now_px, result);
  if (!(result.max_px <= kLargestCoordinatePx)) return warp::fit(then_px_, now_px, Curve::aff);
  return result;
}

}  // namespace talisman::warp
