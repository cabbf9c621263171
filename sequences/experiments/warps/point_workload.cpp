// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/warps/point_workload.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace talisman::sequences {
namespace {

constexpr double kDisplay_px = kWorkloadDisplay_px;

dvec2 project(dvec3 camera_point) {
  static const double focal = kDisplay_px / 2 / std::tan(std::numbers::pi / 8);
  const double w = -camera_point.z;
  return {kDisplay_px / 2 + focal * camera_point.x / w, kDisplay_px / 2 - focal * camera_point.y / w};
}

/// Point i of the unit box -1 … 1: 27 places of the lattice {-1, 0, 1}³ by rank, the centre left out; then
/// random ones inside.
dvec3 box_point(int i, Random& random) {
  static const std::vector<dvec3> lattice = [] {
    std::vector<dvec3> points;
    for (int zeros = 0; zeros < 3; ++zeros)
      for (int k = 0; k < 27; ++k) {
        const dvec3 p{k % 3 - 1.0, k / 3 % 3 - 1.0, k / 9 - 1.0};
        if ((p.x == 0) + (p.y == 0) + (p.z == 0) == (zeros == 0 ? 0 : zeros == 1 ? 2 : 1))
          points.push_back(p);
      }
    return points;
  }();
  if (i < static_cast<int>(lattice.size())) return lattice[i];
  const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
  return {x, y, z};
}

dvec3 direction(Random& random) {
  for (;;) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    const dvec3 v{x, y, z};
    const double length = glm::length(v);
    if (length > 0.1 && length <= 1) return v / length;
  }
}

/// Turned about a random axis; angle and axis are drawn one after the other, because the order of arguments
/// is not fixed.
layers::dmat4 random_turn(Random& random, double least_rad, double most_rad) {
  const double angle_rad = random.uniform(least_rad, most_rad);
  return glm::rotate(layers::dmat4(1.0), angle_rad, direction(random));
}

std::vector<dvec2> random_points(Random& random, int count, double half_side_px, dvec2 centre) {
  std::vector<dvec2> points(count);
  for (auto& p : points) p = centre + random.in_square(half_side_px);
  return points;
}

Pairs image_of(std::vector<dvec2> then_px, const std::function<dvec2(dvec2)>& map) {
  Pairs pairs{std::move(then_px), {}};
  for (const dvec2& p : pairs.then_px) pairs.now_px.push_back(map(p));
  return pairs;
}

}  // namespace

std::uint64_t Random::bits() {
  std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ull);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}
double Random::uniform(double lo, double hi) {
  return lo + (hi - lo) * (static_cast<double>(bits() >> 11) * 0x1p-53);
}
int Random::integer(int lo, int hi) {
  return lo + static_cast<int>(bits() % (static_cast<std::uint64_t>(hi - lo) + 1));
}
double Random::log_uniform(double lo, double hi) { return std::exp(uniform(std::log(lo), std::log(hi))); }
dvec2 Random::in_square(double half_side) {
  const double x =
      uniform(-half_side, half_side);  // one after the other: the order of arguments is not fixed
  return {x, uniform(-half_side, half_side)};
}

SpacePairs moving_box_in_space(std::uint64_t seed, int points) {
  Random random(seed * 1000003 + 17);
  const double distance = random.log_uniform(1, 100);
  const dvec3 half{distance * random.uniform(0.02, 0.15), distance * random.uniform(0.02, 0.15),
                   distance * random.uniform(0.02, 0.15)};
  const dvec3 centre = dvec3{random.uniform(-0.25, 0.25), random.uniform(-0.25, 0.25), -1} * distance;
  const auto pose = random_turn(random, 0, std::numbers::pi);
  const auto step = random_turn(random, 0.2 * std::numbers::pi / 180, 3 * std::numbers::pi / 180);
  const dvec3 move =
      dvec3{random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02)} * distance;
  SpacePairs pairs;
  for (int i = 0; i < points; ++i) {
    const layers::dvec4 local = pose * layers::dvec4(box_point(i, random) * half, 1);
    const layers::dvec4 turned = step * local;
    pairs.then_m.push_back(centre + dvec3(local));
    pairs.now_m.push_back(centre + move + dvec3(turned));
  }
  return pairs;
}

Pairs moving_box(std::uint64_t seed, int points) {
  const SpacePairs space = moving_box_in_space(seed, points);
  Pairs pairs;
  for (int i = 0; i < points; ++i) {
    pairs.then_px.push_back(project(space.then_m[i]));
    pairs.now_px.push_back(project(space.now_m[i]));
  }
  return pairs;
}

Pairs exact_affine(std::uint64_t seed, int points, const Affine2& map, double half_side_px, dvec2 centre) {
  Random random(seed);
  return image_of(random_points(random, points, half_side_px, centre), map);
}

Pairs exact_perspective(std::uint64_t seed, int points, const dmat3& map, double half_side_px, dvec2 centre) {
  Random random(seed);
  return image_of(random_points(random, points, half_side_px, centre),
                  [&](dvec2 p) { return through(map, p); });
}

dvec2 through(const dmat3& map, dvec2 p) {
  const dvec3 h = map * dvec3(p, 1);
  return {h.x / h.z, h.y / h.z};
}

Affine2 gentle_affine(std::uint64_t seed) {
  Random random(seed ^ 0xa5a5);
  const double angle = random.uniform(-0.3, 0.3), sx = random.uniform(0.8, 1.25),
               sy = random.uniform(0.8, 1.25);
  const double shear = random.uniform(-0.1, 0.1), c = std::cos(angle), s = std::sin(angle);
  Affine2 map{c * sx, c * shear - s * sy, 0, s * sx, s * shear + c * sy, 0};
  const dvec2 centre{512, 512}, offset = centre + random.in_square(30) - map.linear(centre);
  map.tx = offset.x;
  map.ty = offset.y;
  return map;
}

dmat3 gentle_perspective(std::uint64_t seed) {
  Random random(seed ^ 0x5a5a);
  const double g = random.uniform(-3e-4, 3e-4), h = random.uniform(-3e-4, 3e-4);
  dmat3 map = layers::to_mat3(gentle_affine(seed));
  map[0].z = g;
  map[1].z = h;
  map[2].z = 1 - 512 * (g + h);  // denominator 1 at the centre
  return map;
}

}  // namespace talisman::sequences
