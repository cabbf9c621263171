// SPDX-License-Identifier: Apache-2.0
// Fits of warps: planted maps evaluated in long double, least squares in long double, all discs through two or three
// points, and Ceres.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "sequences/experiments/hard/hard_case.h"
#include "sequences/experiments/warps/point_workload.h"
#include "warp/ceres_reference.h"
#include "warp/enclosing_disc.h"
#include "warp/fit.h"

namespace talisman::sequences {
namespace {

using Exact = long double;
using warp::Curve;
using warp::Family;
using warp::FitResult;
using warp::FitStatus;

constexpr int kFittedPoints = 14;
constexpr double kDoubleUlp = std::numeric_limits<double>::epsilon();

struct ExactPoint {
  Exact x = 0, y = 0;
};

Exact exact_distance(ExactPoint a, ExactPoint b) { return std::hypot(a.x - b.x, a.y - b.y); }
ExactPoint exact_of(dvec2 p) { return {p.x, p.y}; }

/// The image of a point under a 3×3 matrix of doubles, without further rounding.
ExactPoint image_in_exact(const dmat3& m, ExactPoint p) {
  const Exact w = Exact(m[0].z) * p.x + Exact(m[1].z) * p.y + Exact(m[2].z);
  return {(Exact(m[0].x) * p.x + Exact(m[1].x) * p.y + Exact(m[2].x)) / w,
          (Exact(m[0].y) * p.x + Exact(m[1].y) * p.y + Exact(m[2].y)) / w};
}

/// A layer of which everything is known: its points then, and the map that carries them.
struct PlantedMotion {
  Curve curve = Curve::aff;
  dmat3 map{1.0};  ///< about `centre`: what is near it stays near it
  dvec2 centre{0, 0};
  dvec2 half_px{100, 100};
};

dmat3 planted_matrix(const Affine2& map) { return layers::to_mat3(map); }

/// Largest distance of the fitted warp's images from the planted ones, in ulp of the largest coordinate: what the
/// doubles of the points themselves do not know.
HardOutcome recover_planted(const PlantedMotion& motion) {
  Random random(2);
  std::vector<dvec2> then_px, now_px;
  std::vector<ExactPoint> right;
  Exact largest = 0;
  for (int i = 0; i < kFittedPoints; ++i) {
    const dvec2 offset = random.in_square(1) * motion.half_px;
    then_px.push_back(motion.centre + offset);
    const ExactPoint from_centre{Exact(then_px[i].x) - motion.centre.x,
                                 Exact(then_px[i].y) - motion.centre.y};
    const ExactPoint moved = image_in_exact(motion.map, from_centre);
    right.push_back({moved.x + motion.centre.x, moved.y + motion.centre.y});
    now_px.push_back(dvec2(double(right[i].x), double(right[i].y)));
    for (const double c : {then_px[i].x, then_px[i].y, now_px[i].x, now_px[i].y})
      largest = std::max(largest, std::fabs(Exact(c)));
  }
  const FitResult fitted = warp::fit(then_px, now_px, motion.curve);
  Exact worst = 0;
  for (int i = 0; i < kFittedPoints; ++i)
    worst = worse(worst,
                  exact_distance(image_in_exact(fitted.warp.now_from_then, exact_of(then_px[i])), right[i]));
  return {double(worst / (largest * kDoubleUlp)), fitted.status != FitStatus::Converged};
}

HardCase planted_case(std::string_view name, std::string_view special, double extreme, double ulp,
                      const PlantedMotion& motion) {
  return {HardStage::Warps,
          name,
          special,
          extreme,
          {ulp, "ulp of the coordinates", "planted map, long double"},
          [motion] { return recover_planted(motion); }};
}

dmat3 planted_affine() { return planted_matrix({1.01, 0.02, 3, -0.015, 0.99, -2}); }

/// The denominator goes from 1 to 1/`foreshortening` within 100 px on one side of the middle.
dmat3 planted_tilt(double foreshortening) {
  dmat3 m(1.0);
  m[0].z = (1 / foreshortening - 1) / 100;
  return m;
}

void add_planted(std::vector<HardCase>& cases) {
  const dmat3 affine = planted_affine();
  const auto add = [&](const char* name, const char* special, double extreme, const PlantedMotion& motion,
                       double ulp = 32) {
    cases.push_back(planted_case(name, special, extreme, ulp, motion));
  };
  add("aff, 2 px at 700", "small and not at the origin [A 5]", 700, {Curve::aff, affine, {700, 700}, {1, 1}});
  add("aff, 1 px at 1e6", "coordinates a million times the sprite", 1e6,
      {Curve::aff, affine, {1e6, -1e6}, {1, 1}});
  add("aff, 1 px at 1e9", "7 digits are left of 16", 1e9, {Curve::aff, affine, {1e9, -1e9}, {1, 1}});
  add("aff, 1e-6 px", "a sprite of less than a pixel at the origin", 1e-6,
      {Curve::aff, planted_matrix({1.01, 0.02, 0, -0.015, 0.99, 0}), {0, 0}, {1e-6, 1e-6}});
  add("aff, 1e12 px", "a sprite of 1e12 px", 1e12, {Curve::aff, affine, {0, 0}, {1e12, 1e12}});
  add("aff, 1e3 x 1e-3 px", "a needle: what rounds along it counts 1e6-fold across", 1e6,
      {Curve::aff, affine, {500, 500}, {1e3, 1e-3}}, 1e6);
  add("trn at 1e12", "a shift of 3 px where an ulp is 1e-4 px", 1e12,
      {Curve::trn, planted_matrix({1, 0, 3, 0, 1, -2}), {1e12, 1e12}, {10, 10}});
  add("so, 1e4 x 1e-2 px", "a scale per axis, one axis 1e6 times the other", 1e6,
      {Curve::so, planted_matrix({1.25, 0, 0, 0, 0.5, 0}), {0, 0}, {1e4, 1e-2}});
  add("per, 1000 : 1", "denominators 1000 : 1 over the sprite", 1e3,
      {Curve::per, planted_tilt(1e3), {0, 0}, {99.9, 99.9}}, 1e5);
  add("per2, 1000 : 1", "the same after the divide", 1e3,
      {Curve::per2, planted_tilt(1e3), {0, 0}, {99.9, 99.9}}, 1e5);
  add("per2, 10 px at 1e5", "a perspective far from the origin", 1e4,
      {Curve::per2, planted_tilt(1.5), {1e5, 1e5}, {10, 10}}, 1e4);
}

// --- Sums of squares

/// Solves the 3×3 normal equations of centred points: in long double nothing of them is lost.
struct ExactLeastSquares {
  Exact cx = 0, cy = 0, mx = 0, my = 0, xx = 0, xy = 0, yy = 0, ux = 0, uy = 0, vx = 0, vy = 0;

  explicit ExactLeastSquares(const Pairs& pairs) {
    const Exact n = Exact(pairs.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      cx += pairs.then_px[i].x / n, cy += pairs.then_px[i].y / n;
      mx += pairs.now_px[i].x / n, my += pairs.now_px[i].y / n;
    }
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const Exact x = pairs.then_px[i].x - cx, y = pairs.then_px[i].y - cy, u = pairs.now_px[i].x - mx,
                  v = pairs.now_px[i].y - my;
      xx += x * x, xy += x * y, yy += y * y, ux += u * x, uy += u * y, vx += v * x, vy += v * y;
    }
  }
  ExactPoint operator()(ExactPoint p) const {
    const Exact det = xx * yy - xy * xy, x = p.x - cx, y = p.y - cy;
    const Exact a = (ux * yy - uy * xy) / det, b = (uy * xx - ux * xy) / det;
    const Exact c = (vx * yy - vy * xy) / det, d = (vy * xx - vx * xy) / det;
    return {a * x + b * y + mx, c * x + d * y + my};
  }
};

/// Largest distance of the images of the points, over the rounding of the residuals.
HardOutcome agree_with_exact_squares(const Pairs& pairs) {
  const FitResult fitted = warp::fit(pairs.then_px, pairs.now_px, Curve::aff);
  const ExactLeastSquares right(pairs);
  Exact worst = 0;
  for (const dvec2& p : pairs.then_px)
    worst = worse(worst,
                  exact_distance(image_in_exact(fitted.warp.now_from_then, exact_of(p)), right(exact_of(p))));
  return {double(worst), fitted.status != FitStatus::Converged};
}

/// Points along a diagonal, off it by `thickness` of its length; now turned, and off by a fifth of the thickness.
Pairs thin_pairs(double thickness) {
  Random random(7);
  Pairs pairs;
  for (int i = 0; i < kFittedPoints; ++i) {
    const double t = 200 * (i / double(kFittedPoints - 1) - 0.5),
                 off = 200 * thickness * random.uniform(-1, 1);
    pairs.then_px.push_back(dvec2{512 + 0.8 * t - 0.6 * off, 512 + 0.6 * t + 0.8 * off});
    pairs.now_px.push_back(dvec2{530 + 0.6 * t - 0.8 * off, 505 + 0.8 * t + 0.6 * off} +
                           random.in_square(40 * thickness));
  }
  return pairs;
}

Pairs with_repeated_corner(int times) {
  Pairs pairs = moving_box(3, 8);
  for (int i = 0; i < times; ++i)
    pairs.then_px.push_back(pairs.then_px[0]), pairs.now_px.push_back(pairs.now_px[0]);
  return pairs;
}

/// While the thickness falls from 1e-6 to 1e-10 the affine family hands over to simpler ones: the largest step of a
/// point's image from one thickness to the next, 5 % less.
HardOutcome hand_over() {
  double worst = 0;
  std::vector<dvec2> before;
  for (double thickness = 1e-6; thickness > 1e-10; thickness *= 0.95) {
    const Pairs pairs = thin_pairs(thickness);
    const FitResult fitted = warp::fit(pairs.then_px, pairs.now_px, Curve::aff);
    std::vector<dvec2> images;
    for (const dvec2& p : pairs.then_px) images.push_back(fitted.warp(p));
    for (std::size_t i = 0; i < before.size(); ++i)
      worst = worse(worst, std::hypot(images[i].x - before[i].x, images[i].y - before[i].y));
    before = images;
  }
  return {worst, false};
}

void add_squares(std::vector<HardCase>& cases) {
  const auto add = [&](const char* name, const char* special, double extreme, double most,
                       const Pairs& pairs) {
    cases.push_back(
        {HardStage::Warps, name, special, extreme, {most, "px", "least squares, long double"}, [pairs] {
           return agree_with_exact_squares(pairs);
         }});
  };
  add("aff, 1e-3 thin", "nearly collinear and noisy", 1e3, 1e-9, thin_pairs(1e-3));
  add("aff, 1e-6 thin", "nearly collinear and noisy", 1e6, 1e-6, thin_pairs(1e-6));
  add("aff, 1 point 1000 times", "a corner weighs 125 times all others", 1e3, 1e-9,
      with_repeated_corner(1000));
  cases.push_back({HardStage::Warps,
                   "aff hands over",
                   "collinear in 180 steps of 5 %, 1e-6 ... 1e-10",
                   1e10,
                   {1, "px per step", "the step before"},
                   hand_over});
}

// --- Largest errors

/// Largest distance of an image from its point, in long double.
Exact largest_in_exact(const dmat3& map, const Pairs& pairs) {
  Exact largest = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    largest = worse(
        largest, exact_distance(image_in_exact(map, exact_of(pairs.then_px[i])), exact_of(pairs.now_px[i])));
  return largest;
}

/// How far our largest error is above Ceres's, or our lower bound above what Ceres reached (no such bound can be right), or
/// the stated error off the true one.
HardOutcome not_above_ceres(const Pairs& pairs, Curve curve) {
  const FitResult fitted = warp::fit(pairs.then_px, pairs.now_px, curve);
  const FitResult ceres = warp::ceres_max_norm(pairs.then_px, pairs.now_px, warp::family_of(curve));
  const Exact reached = largest_in_exact(ceres.warp.now_from_then, pairs);
  const Exact ours = largest_in_exact(fitted.warp.now_from_then, pairs);
  const Exact excess =
      worse(worse(ours - reached, fitted.max_lower_bound_px - reached), std::fabs(ours - fitted.max_px));
  return {double(worse(Exact(0), excess / reached)), fitted.status != FitStatus::Converged};
}

Pairs scaled_pairs(Pairs pairs, double scale, dvec2 offset) {
  for (std::vector<dvec2>* side : {&pairs.then_px, &pairs.now_px})
    for (dvec2& p : *side) p = p * scale + offset;
  return pairs;
}

/// The smallest disc among those through all pairs and triples of points.
Exact smallest_disc_by_trial(std::span<const dvec2> points) {
  Exact best = HUGE_VALL;
  const auto try_centre = [&](ExactPoint c) {
    Exact radius = 0;
    for (const dvec2& p : points) radius = worse(radius, exact_distance(c, exact_of(p)));
    best = std::min(best, radius);
  };
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const ExactPoint a = exact_of(points[i]), b = exact_of(points[j]);
      try_centre({(a.x + b.x) / 2, (a.y + b.y) / 2});
      for (std::size_t k = 0; k < j; ++k) {
        const Exact bx = b.x - a.x, by = b.y - a.y, cx = points[k].x - a.x, cy = points[k].y - a.y;
        const Exact d = 2 * (bx * cy - by * cx), bb = bx * bx + by * by, cc = cx * cx + cy * cy;
        if (d != 0) try_centre({a.x + (cy * bb - by * cc) / d, a.y + (bx * cc - cx * bb) / d});
      }
    }
  return best;
}

HardOutcome agree_with_all_discs(const std::vector<dvec2>& points) {
  const warp::EnclosingDisc disc = warp::smallest_enclosing_disc(points);
  const Exact right = smallest_disc_by_trial(points);
  const Exact off = worse(Exact(disc.radius) - right, Exact(disc.lower) - right);
  return {double(worse(Exact(0), off / right)), false};
}

std::vector<dvec2> points_on_circle(int count, double radius, dvec2 centre, double wobble) {
  Random random(11);
  std::vector<dvec2> points;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::acos(-1.0) * i / count, r = radius * (1 + random.uniform(-wobble, wobble));
    points.push_back(centre + r * dvec2{std::cos(angle), std::sin(angle)});
  }
  return points;
}

void add_largest(std::vector<HardCase>& cases) {
  const auto against_ceres = [&](const char* name, const char* special, double extreme, Curve curve,
                                 const Pairs& pairs) {
    cases.push_back({HardStage::Warps,
                     name,
                     special,
                     extreme,
                     {1e-6, "of the error", "Ceres, p-norms up to 256"},
                     [pairs, curve] { return not_above_ceres(pairs, curve); }});
  };
  const Pairs box = moving_box(5, kFittedPoints);
  against_ceres("affi", "largest error of a turning box", 1, Curve::affi, box);
  against_ceres("affi, 1e-6 px", "the same, a millionth as large", 1e-6, Curve::affi,
                scaled_pairs(box, 1e-6, {0, 0}));
  against_ceres("affi at 1e7", "the same, far from the origin", 1e5, Curve::affi,
                scaled_pairs(box, 1, {1e7, -1e7}));
  against_ceres("per2i", "largest error after the divide", 1, Curve::per2i, box);
  against_ceres("isoi", "a scale for a box that turns", 1, Curve::isoi, box);
  const auto disc = [&](const char* name, const char* special, double extreme, double most,
                        const std::vector<dvec2>& points) {
    cases.push_back({HardStage::Warps,
                     name,
                     special,
                     extreme,
                     {most, "of the radius", "all pairs and triples, long double"},
                     [points] { return agree_with_all_discs(points); }});
  };
  disc("trni, 64 on a circle", "all of 41,664 triples are nearly right", 1e12, 1e-12,
       points_on_circle(64, 3, {10, 20}, 1e-12));
  disc("trni, 1e-9 px at 1000", "displacements that differ in 4 digits", 1e12, 1e-3,
       points_on_circle(20, 1e-9, {1000, 500}, 0.5));
}

// --- No answer

/// What a refusal must still be: the errors are those of the warp that it names, and the map does not mirror.
HardOutcome honest_refusal(const Pairs& pairs, Curve curve) {
  const FitResult fitted = warp::fit(pairs.then_px, pairs.now_px, curve);
  const bool refused = fitted.status == FitStatus::Degenerate || fitted.status == FitStatus::TooFewPoints;
  const dmat3& m = fitted.warp.now_from_then;
  if (m[0].x * m[1].y - m[1].x * m[0].y <= 0) return {HUGE_VAL, refused};
  const Exact largest = largest_in_exact(m, pairs);
  return {double(std::fabs(largest - fitted.max_px) / std::max(largest, Exact(1))), refused};
}

HardOutcome refused_as_not_finite(double bad) {
  Pairs pairs = moving_box(7, 8);
  pairs.now_px[5].y = bad;
  const FitResult fitted = warp::fit(pairs.then_px, pairs.now_px, Curve::per2);
  const bool says_so = fitted.worst_point == 5 && fitted.max_px == warp::kHugePx && fitted.warp.is_identity();
  return {says_so ? 0.0 : 1.0, fitted.status == FitStatus::NotFinite};
}

Pairs mapped_box(const dmat3& map) {
  Pairs pairs = moving_box(21, 8);
  for (std::size_t i = 0; i < pairs.size(); ++i) pairs.now_px[i] = through(map, pairs.then_px[i]);
  return pairs;
}

void add_refusals(std::vector<HardCase>& cases) {
  const auto refuse = [&](const char* name, const char* special, double extreme, Curve curve,
                          const Pairs& pairs) {
    cases.push_back({HardStage::Warps,
                     name,
                     special,
                     extreme,
                     {1e-9, "of the stated error", "errors again, long double", true},
                     [pairs, curve] { return honest_refusal(pairs, curve); }});
  };
  refuse("aff, collinear", "no extent across a line", 1, Curve::aff, thin_pairs(0));
  refuse("aff, 1e-12 thin", "less extent across than rounding", 1e12, Curve::aff, thin_pairs(1e-12));
  refuse("aff, one place", "14 points that coincide", 1, Curve::aff,
         {std::vector<dvec2>(kFittedPoints, {100, 200}), moving_box(1, kFittedPoints).now_px});
  refuse("aff, mirrored", "the best map turns the sprite over", 1, Curve::aff,
         mapped_box(planted_matrix({-1, 0, 1024, 0, 1, 0})));
  Pairs across = mapped_box(dmat3(1.0));
  dvec2 middle{0, 0};
  for (const dvec2& p : across.then_px) middle += p / double(across.size());
  for (std::size_t i = 0; i < across.size(); ++i) {
    const dvec2 d = across.then_px[i] - middle;
    across.now_px[i] = dvec2{d.x / (0.01 * d.x + 0.001), d.y / (0.01 * d.x + 0.001)};
  }
  refuse("per2, horizon inside", "points on both sides of the horizon", 1, Curve::per2, across);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), 1e30})
    cases.push_back({HardStage::Warps,
                     std::isnan(bad) ? "per2, not a number" : "per2, 1e30 px",
                     "a coordinate without a meaning",
                     std::isnan(bad) ? 1 : 1e30,
                     {0, "wrong answers", "documented answer", true},
                     [bad] { return refused_as_not_finite(bad); }});
}

}  // namespace

std::vector<HardCase> hard_warps() {
  std::vector<HardCase> cases;
  add_planted(cases);
  add_squares(cases);
  add_largest(cases);
  add_refusals(cases);
  return cases;
}

}  // namespace talisman::sequences
