// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <glm/matrix.hpp>

#include "fiducials/fiducials.h"

namespace talisman::fiducials {
namespace {

using layers::dmat3;
using layers::RectD;
using warp::kHugePx;
using warp::Warp;

/// Segments per side of the rectangle on which the bounds of a perspective warp are taken: an excess of r
/// over the whole side falls to about r / 8.
constexpr int kSegmentsPerSide = 8;

/// x = product + error exactly, for factors whose halves do not over- or underflow (Dekker 1971).
struct TwoProduct {
  double product, error;
};
TwoProduct two_product(double x, double y) {
  const auto high = [](double v) {
    const double c = 134217729.0 * v;  // 2²⁷ + 1
    return c - (c - v);
  };
  const double p = x * y, xh = high(x), xl = x - xh, yh = high(y), yl = y - yh;
  return {p, ((xh * yh - p) + xh * yl + xl * yh) + xl * yl};
}

/// a d - b c without cancellation of the rounding errors of the products.
double determinant(double a, double b, double c, double d) {
  const TwoProduct ad = two_product(a, d), bc = two_product(b, c);
  return (ad.product - bc.product) + (ad.error - bc.error);
}

/// Of a perspective map p ↦ (A p + t) / w, w = g·p + k, at one place: the matrix N = w² J = A w - (A p + t)
/// gᵀ, which is affine in p.
struct Place {
  dvec2 p;
  double w = 1;
  double sigma_1 = 0;  ///< of N
};

Place place_at(const dmat3& m, dvec2 p) {
  const double w = m[0].z * p.x + m[1].z * p.y + m[2].z;
  const double x = m[0].x * p.x + m[1].x * p.y + m[2].x, y = m[0].y * p.x + m[1].y * p.y + m[2].y;
  const dvec2 sigma = singular_values(m[0].x * w - x * m[0].z, m[1].x * w - x * m[1].z,
                                      m[0].y * w - y * m[0].z, m[1].y * w - y * m[1].z);
  return {p, w, sigma.x};
}

Sampling sampling_of_affine(const Warp& warp, dvec2 centre) {
  const layers::Affine2 map = warp.affine();
  const dvec2 sigma = singular_values(map.a, map.b, map.c, map.d);
  const double ratio = sigma.y > 0 ? sigma.x / sigma.y : kHugePx;
  return {sigma.x, sigma.y, std::fmin(ratio, kHugePx), warp(centre)};
}

Sampling worst_sampling(dvec2 where) { return {kHugePx, 0, kHugePx, where}; }

/// Bounds over a convex quadrilateral of the domain on which w > 0.
///
/// With N = w² J affine in p and det J = det H / w³, the three figures are
///   magnification  σ₁(J)        = σ₁(N) / w²
///   minification   σ₂(J)        = |det H| / (w σ₁(N))
///   anisotropy     σ₁(J)/σ₂(J)  = σ₁(N)² / (w |det H|)
/// σ₁ is a norm, so σ₁(N) is convex in p. On a line of constant w all three (the second inverted) therefore
/// have their worst case at an end: it lies on the boundary. On a piece of the boundary σ₁(N) and w are each
/// bounded by their values at its two ends, which bounds the first two. The third is a squared convex
/// function over a positive affine one, hence convex itself: its maximum is at a corner, exactly.
Sampling sampling_of_perspective(const Warp& warp, const std::array<dvec2, 4>& corners) {
  const dmat3& m = warp.now_from_then;
  const double det = std::fabs(glm::determinant(m));
  Sampling bounds{0, kHugePx, 0, {0, 0}};
  double worst = -1;
  for (int side = 0; side < 4; ++side) {
    const dvec2 from = corners[side], to = corners[(side + 1) % 4];
    Place last = place_at(m, from);
    bounds.anisotropy = std::fmax(bounds.anisotropy, last.sigma_1 * last.sigma_1 / (last.w * det));
    for (int k = 1; k <= kSegmentsPerSide; ++k) {
      const Place next = place_at(m, from + (to - from) * (static_cast<double>(k) / kSegmentsPerSide));
      const double least_w = std::fmin(last.w, next.w), most_w = std::fmax(last.w, next.w);
      const double most_sigma = std::fmax(last.sigma_1, next.sigma_1);
      bounds.magnification = std::fmax(bounds.magnification, most_sigma / (least_w * least_w));
      bounds.minification = std::fmin(bounds.minification, det / (most_w * most_sigma));
      if (last.sigma_1 / (last.w * last.w) > worst) {
        worst = last.sigma_1 / (last.w * last.w);
        bounds.where_px = warp(last.p);
      }
      last = next;
    }
  }
  bounds.anisotropy = std::fmax(bounds.anisotropy, 1);  // rounding
  return bounds;
}

bool all_finite(const Sampling& s) {
  return std::isfinite(s.magnification) && std::isfinite(s.minification) && std::isfinite(s.anisotropy);
}

}  // namespace

dvec2 singular_values(double a, double b, double c, double d) {
  const double largest = std::max({std::fabs(a), std::fabs(b), std::fabs(c), std::fabs(d)});
  const bool finite = std::isfinite(a) && std::isfinite(b) && std::isfinite(c) && std::isfinite(d);
  if (!finite) return {kHugePx, 0};
  if (!(largest > 0)) return {0, 0};
  // A power of two as unit: exact, and no square over- or underflows.
  const int exponent = std::ilogb(largest);
  a = std::scalbn(a, -exponent), b = std::scalbn(b, -exponent), c = std::scalbn(c, -exponent),
  d = std::scalbn(d, -exponent);
  const double sum = std::hypot(a + d, c - b), difference = std::hypot(a - d, c + b);
  const double larger = (sum + difference) / 2;
  // The textbook (sum - difference) / 2 cancels for flat maps; the product of the two is the determinant.
  const double smaller = std::fmin(std::fabs(determinant(a, b, c, d)) / larger, larger);
  return {std::scalbn(larger, exponent), std::scalbn(smaller, exponent)};
}

Sampling sampling_over(const Warp& warp, const RectD& domain_px) {
  if (domain_px.empty()) return {};
  const dvec2 centre = (domain_px.lo + domain_px.hi) / 2.0;
  if (warp.is_affine()) return sampling_of_affine(warp, centre);
  const std::array<dvec2, 4> corners{domain_px.lo, dvec2{domain_px.hi.x, domain_px.lo.y}, domain_px.hi,
                                     dvec2{domain_px.lo.x, domain_px.hi.y}};
  for (const dvec2& corner : corners)
    if (!(warp.denominator(corner) > 0)) return worst_sampling(centre);  // the horizon crosses the sprite
  const Sampling bounds = sampling_of_perspective(warp, corners);
  return all_finite(bounds) ? bounds : worst_sampling(centre);
}

}  // namespace talisman::fiducials
