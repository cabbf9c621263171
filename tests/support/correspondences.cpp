// SPDX-License-Identifier: Apache-2.0
#include "tests/support/correspondences.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>

namespace talisman::tests {
namespace {}  // namespace

Pairs with_noise(Pairs pairs, std::uint64_t seed, double amount_px) {
  Random random(seed);
  for (auto& p : pairs.now_px) p += random.in_square(amount_px);
  return pairs;
}

Pairs in_similar_display(Pairs pairs, std::uint64_t seed, double scale) {
  Random random(seed + 78);
  const double angle = random.uniform(-3, 3), c = scale * std::cos(angle), s = scale * std::sin(angle);
  const Affine2 similarity{c, -s, random.uniform(-500, 500), s, c, random.uniform(-500, 500)};
  for (auto& p : pairs.then_px) p = similarity(p);
  for (auto& p : pairs.now_px) p = similarity(p);
  return pairs;
}

Pairs near_collinear(std::uint64_t seed, int points, double thickness, double angle_rad, double length_px) {
  Random random(seed);
  const dvec2 along{std::cos(angle_rad), std::sin(angle_rad)}, across{-along.y, along.x};
  Pairs pairs;
  for (int i = 0; i < points; ++i) {
    const double t = length_px * (i / std::fmax(1.0, points - 1.0) - 0.5);
    const double off = length_px * thickness * random.uniform(-1, 1);
    pairs.then_px.push_back(dvec2{512, 512} + t * along + off * across);
    pairs.now_px.push_back(dvec2{530, 505} + 1.1 * t * (along + 0.05 * across) + random.in_square(1));
  }
  return pairs;
}

namespace {

void add_few_points(std::vector<HardCase>& cases) {
  for (int n = 0; n <= 4; ++n)
    cases.push_back(
        {std::to_string(n) + " points", with_noise(exact_affine(n + 1, n, gentle_affine(1)), 3, 5)});
}

void add_coincident(std::vector<HardCase>& cases) {
  cases.push_back(
      {"all then coincide", {std::vector<dvec2>(8, {100, 200}), with_noise(moving_box(1, 8), 1, 1).now_px}});
  cases.push_back({"all now coincide", {moving_box(1, 8).then_px, std::vector<dvec2>(8, {100, 200})}});
  cases.push_back({"all coincide", {std::vector<dvec2>(8, {100, 200}), std::vector<dvec2>(8, {101, 202})}});
  Pairs close = moving_box(2, 8);
  for (auto& p : close.then_px) p = dvec2{512, 512} + (p - dvec2{512, 512}) * 1e-10;
  cases.push_back({"then 1e-8 apart", close});
  Pairs repeated = moving_box(3, 8);
  for (int i = 0; i < 8; ++i)
    repeated.then_px.push_back(repeated.then_px[i / 2]), repeated.now_px.push_back(repeated.now_px[i / 2]);
  cases.push_back({"duplicates", repeated});
  Pairs clusters;
  Random random(9);
  for (int i = 0; i < 12; ++i) {
    const dvec2 centre = i < 6 ? dvec2{10, 20} : dvec2{900, 700};
    clusters.then_px.push_back(centre + random.in_square(1e-6));
    clusters.now_px.push_back(centre + dvec2{3, 4} + random.in_square(0.5));
  }
  cases.push_back({"two clusters", clusters});
}

void add_collinear(std::vector<HardCase>& cases) {
  const std::array<double, 4> angles{0, std::numbers::pi / 2, std::numbers::pi / 4, 1.1};
  for (double angle : angles)
    cases.push_back({"collinear at " + std::to_string(angle), near_collinear(4, 8, 0, angle)});
  for (int e = 3; e <= 12; ++e)
    cases.push_back(
        {"nearly collinear 1e-" + std::to_string(e), near_collinear(e, 14, std::pow(10, -e), 0.7)});
}

void add_magnitudes(std::vector<HardCase>& cases) {
  for (double size : {1e-3, 1.0, 1e5})
    for (double offset : {0.0, 1e4, 1e8})
      cases.push_back({"sprite of " + std::to_string(size) + " px at " + std::to_string(offset),
                       exact_affine(11, 8, {1.01, 0.02, 1, -0.01, 0.99, 2}, size / 2, {offset, -offset})});
}

void add_bad_maps(std::vector<HardCase>& cases) {
  const auto of = [](const Affine2& map) { return with_noise(exact_affine(21, 8, map), 22, 0.5); };
  cases.push_back({"mirrored in x", of({-1, 0, 1024, 0, 1, 0})});
  cases.push_back({"mirrored on a diagonal", of({0, 1, 0, 1, 0, 0})});
  cases.push_back({"turned by 180 degrees", of({-1, 0, 1024, 0, -1, 1024})});
  cases.push_back({"turned by 90 degrees", of({0, -1, 1024, 1, 0, 0})});
  cases.push_back({"collapsed to a line", exact_affine(23, 8, {1, 0.5, 0, 2, 1, 0})});
  cases.push_back({"identical", {moving_box(5, 14).then_px, moving_box(5, 14).then_px}});
  // The line x = 512 goes to infinity: the points on its two sides have denominators of different sign.
  cases.push_back(
      {"horizon among the points", exact_perspective(24, 12, {1, 0, 0.01, 0, 1, 0, 0, 0, -5.12})});
  Pairs blow_up = moving_box(6, 8);
  blow_up.now_px[3] = {4e11, -7e11};  // a point at w = 1e-9 of its neighbours'
  cases.push_back({"one point at the near plane", blow_up});
}

void add_not_finite(std::vector<HardCase>& cases) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (double bad : {nan, inf, -inf})
    for (int where = 0; where < 2; ++where) {
      Pairs pairs = moving_box(7, 8);
      (where == 0 ? pairs.then_px : pairs.now_px)[5].y = bad;
      cases.push_back({"one coordinate is " + std::to_string(bad), pairs, false});
    }
}

}  // namespace

std::vector<HardCase> hard_cases() {
  std::vector<HardCase> cases;
  add_few_points(cases);
  add_coincident(cases);
  add_collinear(cases);
  add_magnitudes(cases);
  add_bad_maps(cases);
  add_not_finite(cases);
  return cases;
}

Pairs garbage(std::uint64_t seed) {
  Random random(seed);
  const double inf = std::numeric_limits<double>::infinity();
  const double lo = std::pow(10, random.uniform(-300, 0)), hi = std::pow(10, random.uniform(0, 300));
  const bool poisoned = random.integer(0, 9) == 0, gridded = random.integer(0, 2) == 0;
  const auto coordinate = [&]() -> double {
    if (poisoned && random.integer(0, 19) == 0) return random.integer(0, 1) != 0 ? inf : inf - inf;
    if (gridded) return random.integer(-2, 2);  // small integers provoke every kind of coincidence
    return random.log_uniform(lo, hi) * (random.integer(0, 1) != 0 ? 1 : -1);
  };
  Pairs pairs;
  const int count = random.integer(0, 16);
  for (int i = 0; i < count; ++i) {
    const double a = coordinate(), b = coordinate(), c = coordinate(), d = coordinate();
    pairs.then_px.push_back({a, b});
    pairs.now_px.push_back({c, d});
  }
  return pairs;
}

double largest_error(const Pairs& pairs, const std::function<dvec2(dvec2)>& map) {
  double largest = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    largest = std::fmax(largest, glm::length(map(pairs.then_px[i]) - pairs.now_px[i]));
  return largest;
}

double rms_error(const Pairs& pairs, const std::function<dvec2(dvec2)>& map) {
  long double sum = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const dvec2 r = map(pairs.then_px[i]) - pairs.now_px[i];
    sum += static_cast<long double>(r.x) * r.x + static_cast<long double>(r.y) * r.y;
  }
  return pairs.size() == 0 ? 0 : static_cast<double>(std::sqrt(sum / static_cast<long double>(pairs.size())));
}

}  // namespace talisman::tests
