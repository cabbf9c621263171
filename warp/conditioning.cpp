// SPDX-License-Identifier: Apache-2.0
#include "warp/conditioning.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "layers/check.h"

namespace talisman::warp {
namespace {

bool is_good(double coordinate) { return std::fabs(coordinate) <= kLargestCoordinatePx; }  // false for NaN

/// Unit eigenvector of the larger eigenvalue of | xx xy ; xy yy |, by the half-angle formula that does not
/// cancel.
dvec2 principal_axis(double xx, double xy, double yy) {
  const double difference = xx - yy, twice = 2 * xy,
               length = std::sqrt(difference * difference + twice * twice);
  if (!(length > 0)) return {1, 0};
  if (difference >= 0) {
    const double cosine = std::sqrt((1 + difference / length) / 2);
    return {cosine, twice / (2 * length * cosine)};
  }
  const double sine = std::sqrt((1 - difference / length) / 2);
  return {twice / (2 * length * sine), sine};
}

/// 0 up to `lo`, 1 from `hi`, a smooth step of the logarithm between.
double step_between(double ratio, double lo, double hi) {
  if (!(ratio > lo)) return 0;
  if (ratio >= hi) return 1;
  const double t = std::log(ratio / lo) / std::log(hi / lo);
  return t * t * (3 - 2 * t);
}

double share(double part, double whole) { return whole > 0 ? part / whole : 0; }

/// Of a spread against the rounding of the coordinates.
double resolved(double sigma, const Spread& spread) {
  return step_between(share(sigma, spread.largest_coordinate), kCoincidentRatio, kSpreadRatio);
}

double both_resolved(double smaller, double larger, const Spread& spread) {
  return std::fmin(resolved(smaller, spread),
                   step_between(share(smaller, larger), kCollinearRatio, kSpanningRatio));
}

/// Neither mirrored nor flat. Written so that NaN fails; where squares leave the range of a double the
/// entries are scaled.
bool keeps_area(double a, double b, double c, double d) {
  const double det = a * d - b * c, squares = a * a + b * b + c * c + d * d;
  if (squares > 1e-200 && squares < 1e200) return det > kFlattest * squares;
  const double largest = std::max({std::fabs(a), std::fabs(b), std::fabs(c), std::fabs(d)});
  if (!(largest > 0) || !std::isfinite(largest)) return false;
  return keeps_area(a / largest, b / largest, c / largest, d / largest);
}

dvec2 centroid_of(std::span<const dvec2> points) {
  if (points.empty()) return {0, 0};
  dvec2 sum{0, 0};
  for (const dvec2& p : points)
    sum += p - points[0];  // differences: exact where the points are close together
  return points[0] + sum / static_cast<double>(points.size());
}

/// How far the rounding of the matrix can move the image of p: numerator and denominator are sums of large
/// terms of both signs.
bool is_precise(const Warp& warp, dvec2 p, double w, dvec2 image) {
  const dmat3& m = warp.now_from_then;
  const double terms = std::fabs(m[0].z * p.x) + std::fabs(m[1].z * p.y) + std::fabs(m[2].z);
  const double coordinate = std::max(std::fabs(image.x), std::fabs(image.y)), epsilon = 0x1p-52;
  return epsilon * terms * coordinate <= w * std::max(kLargestRoundingPx, kSpreadRatio * coordinate);
}

bool acceptable_perspective(const Warp& warp, std::span<const dvec2> then_px) {
  double least = HUGE_VAL, most = 0;
  for (const dvec2& p : then_px) {
    const double w = warp.denominator(p);
    if (!(w > 0) || !std::isfinite(w) || !is_precise(warp, p, w, warp(p))) return false;
    least = std::min(least, w);
    most = std::max(most, w);
  }
  if (!(least >= kSmallestDenominatorRatio * most)) return false;
  // The Jacobian at the centroid; its determinant has the same sign wherever the denominator is positive.
  const dvec2 centre = centroid_of(then_px), image = warp(centre);
  const dmat3& m = warp.now_from_then;
  return keeps_area(m[0].x - image.x * m[0].z, m[1].x - image.x * m[1].z, m[0].y - image.y * m[0].z,
                    m[1].y - image.y * m[1].z);
}

}  // namespace

int points_needed(Family family) {
  switch (family) {
    case Family::Translation:
      return 1;
    case Family::Isotropic:
    case Family::XyScale:
      return 2;
    case Family::Affine:
      return 3;
    case Family::Perspective:
      return 4;
  }
  TALISMAN_CHECK(false && "no such family");
}

int first_bad_point(std::span<const dvec2> points) {
  unsigned bad_ones = 0;  // without branches: nearly always all are good
  for (const dvec2& p : points)
    bad_ones |= static_cast<unsigned>(!is_good(p.x)) | static_cast<unsigned>(!is_good(p.y));
  if (bad_ones == 0) return -1;
  const auto bad = [](const dvec2& p) { return !is_good(p.x) || !is_good(p.y); };
  const auto found = std::find_if(points.begin(), points.end(), bad);
  return static_cast<int>(found - points.begin());
}

Spread spread_of(std::span<const dvec2> points) {
  Spread s;
  if (points.empty()) return s;
  s.centroid = centroid_of(points);
  double unit = 0;  // largest deviation
  for (const dvec2& p : points) {
    s.largest_coordinate = std::max({s.largest_coordinate, std::fabs(p.x), std::fabs(p.y)});
    unit = std::max({unit, std::fabs(p.x - s.centroid.x), std::fabs(p.y - s.centroid.y)});
  }
  if (!(unit >= std::numeric_limits<double>::min())) return s;
  // Squares of deviations in this unit neither overflow nor vanish; a power of two changes no digit.
  const double per_unit = std::ldexp(1.0, -std::ilogb(unit));
  unit = 1 / per_unit;
  double xx = 0, xy = 0, yy = 0;
  for (const dvec2& p : points) {
    const dvec2 d = (p - s.centroid) * per_unit;
    xx += d.x * d.x, xy += d.x * d.y, yy += d.y * d.y;
  }
  s.axis = principal_axis(xx, xy, yy);
  // Once more along the axes: the small singular value would drown in the rounding of the large moments.
  double uu = 0, uv = 0, vv = 0;
  for (const dvec2& p : points) {
    const dvec2 d = (p - s.centroid) * per_unit;
    const double u = d.x * s.axis.x + d.y * s.axis.y, v = d.y * s.axis.x - d.x * s.axis.y;
    uu += u * u, uv += u * v, vv += v * v;
  }
  const double n = static_cast<double>(points.size());
  s.sigma_x = unit * std::sqrt(xx / n);
  s.sigma_y = unit * std::sqrt(yy / n);
  s.sigma_1 = unit * std::sqrt(uu / n);
  s.sigma_2 = unit * std::sqrt(std::fmax(0, vv - uv * uv / uu) / n);
  return s;
}

double strength(Family family, const Spread& spread) {
  switch (family) {
    case Family::Translation:
      return 1;
    case Family::Isotropic:
      return resolved(spread.sigma_1, spread);
    case Family::XyScale:
      return both_resolved(std::fmin(spread.sigma_x, spread.sigma_y),
                           std::fmax(spread.sigma_x, spread.sigma_y), spread);
    case Family::Affine:
    case Family::Perspective:
      return both_resolved(spread.sigma_2, spread.sigma_1, spread);
  }
  TALISMAN_CHECK(false && "no such family");
}

bool acceptable(const Warp& warp, std::span<const dvec2> then_px) {
  const dmat3& m = warp.now_from_then;
  double zero = 0;  // stays so only if all entries are finite
  for (int column = 0; column < 3; ++column) zero += m[column].x * 0 + m[column].y * 0 + m[column].z * 0;
  if (zero != 0) return false;
  if (!warp.is_affine()) return acceptable_perspective(warp, then_px);
  return keeps_area(m[0].x, m[1].x, m[0].y, m[1].y);
}

}  // namespace talisman::warp
