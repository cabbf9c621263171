// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Slow, independent answers for the visibility sort: depth by all planes that can carry a facet, order by
/// transitive closure, and the worlds that both sides are asked about.

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "layers/visibility.h"

namespace talisman::layers::tests {

using Points = std::vector<dvec3>;

inline Points box(const dvec3& centre, const dvec3& half) {
  Points p;
  for (int k = 0; k < 8; ++k)
    p.push_back(centre + half * dvec3{k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1});
  return p;
}

/// Normals of all planes that can carry a facet of A - C: faces of either, and pairs of edges.
inline std::vector<dvec3> facet_normals(const Points& a, const Points& c) {
  std::vector<dvec3> normals;
  const auto add = [&](const dvec3& u, const dvec3& v) {
    const dvec3 n = glm::cross(u, v);
    const double length = glm::length(n);
    if (length > 1e-12 * glm::length(u) * glm::length(v)) normals.push_back(n / length);
  };
  const auto edges_of = [](const Points& p) {
    std::vector<dvec3> edges;
    for (std::size_t i = 0; i < p.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) edges.push_back(p[i] - p[j]);
    return edges;
  };
  for (const Points* p : {&a, &c})
    for (std::size_t i = 0; i < p->size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        for (std::size_t k = 0; k < j; ++k) add((*p)[i] - (*p)[k], (*p)[j] - (*p)[k]);
  for (const dvec3& u : edges_of(a))
    for (const dvec3& v : edges_of(c)) add(u, v);
  return normals;
}

/// depth(A, C) where that is positive; something ≤ 0 where it is not (with all of A - C in a line: 0).
inline double slow_depth(const Points& a, const Points& c) {
  double depth = HUGE_VAL;
  for (const dvec3& n : facet_normals(a, c)) {
    double amin = HUGE_VAL, amax = -HUGE_VAL, cmin = HUGE_VAL, cmax = -HUGE_VAL;
    for (const dvec3& p : a) amin = std::min(amin, glm::dot(p, n)), amax = std::max(amax, glm::dot(p, n));
    for (const dvec3& p : c) cmin = std::min(cmin, glm::dot(p, n)), cmax = std::max(cmax, glm::dot(p, n));
    depth = std::min({depth, amax - cmin, cmax - amin});
  }
  return depth == HUGE_VAL ? 0 : depth;
}

inline double size_of(const Points& points) {
  const WorldBounds b = [&] {
    WorldBounds w;
    for (const dvec3& p : points) w.lo = glm::min(w.lo, p), w.hi = glm::max(w.hi, p);
    return w;
  }();
  const dvec3 d = b.hi - b.lo;
  return std::max({d.x, d.y, d.z});
}

/// By how much the depth of `front` in conv({eye} ∪ behind) exceeds the tolerance; > 0: it can occlude.
inline double slow_occlusion(const dvec3& eye, const Points& front, const Points& behind, double touch) {
  Points cone = behind;
  cone.push_back(eye);
  return slow_depth(front, cone) - touch * std::min(size_of(front), size_of(behind));
}

/// A world of layers of one body each.
struct World {
  dvec3 eye{0, 0, 0};
  std::vector<Points> bodies;

  std::vector<Occluder> occluders() const {
    std::vector<Occluder> layers;
    for (std::size_t i = 0; i < bodies.size(); ++i)
      layers.push_back({static_cast<int>(i), OrderGroup::Normal, {bodies[i]}});
    return layers;
  }
};

using Relation = std::vector<std::vector<bool>>;  ///< [front][behind]

/// Empty where some pair is so near the tolerance that rounding may decide.
inline Relation slow_relation(const World& world, double touch, double doubt = 1e-9) {
  const std::size_t n = world.bodies.size();
  Relation relation(n, std::vector<bool>(n, false));
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n; ++b) {
      if (a == b) continue;
      const double excess = slow_occlusion(world.eye, world.bodies[a], world.bodies[b], touch);
      if (std::fabs(excess) < doubt) return {};
      relation[a][b] = excess > 0;
    }
  return relation;
}

/// [front][behind], through any chain.
inline Relation closure(Relation r) {
  for (std::size_t k = 0; k < r.size(); ++k)
    for (std::size_t i = 0; i < r.size(); ++i)
      for (std::size_t j = 0; j < r.size(); ++j)
        if (r[i][k] && r[k][j]) r[i][j] = true;
  return r;
}

/// "" or what is wrong: each layer once, nobody before what lies in front of it, and, where `exactly`, no
/// layers merged that do not occlude each other through some chain.
inline std::string wrong_with(const VisibilityOrder& order, const Relation& relation, bool exactly) {
  const int n = static_cast<int>(relation.size());
  std::vector<int> group_of(n, -1);
  for (std::size_t g = 0; g < order.groups_back_to_front.size(); ++g)
    for (const int layer : order.groups_back_to_front[g]) {
      if (layer < 0 || layer >= n || group_of[layer] >= 0) return "a layer twice, or an unknown one";
      group_of[layer] = static_cast<int>(g);
    }
  if (std::find(group_of.begin(), group_of.end(), -1) != group_of.end()) return "a layer is missing";
  const Relation chains = closure(relation);
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b) {
      if (a == b) continue;
      const std::string pair = std::to_string(a) + " and " + std::to_string(b);
      if (relation[a][b] && group_of[a] < group_of[b]) return pair + ": the one in front comes first";
      const bool together = group_of[a] == group_of[b], cyclic = chains[a][b] && chains[b][a];
      if (cyclic && !together) return pair + ": in a cycle, and not merged";
      if (exactly && together && !cyclic) return pair + ": merged without a cycle";
    }
  return "";
}

class Dice {
 public:
  explicit Dice(unsigned seed) : random_(seed) {}
  double uniform(double lo, double hi) { return lo + (hi - lo) * (random_() / 4294967296.0); }
  int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
  dvec3 in_cube(double half) {
    const double x = uniform(-half, half), y = uniform(-half, half), z = uniform(-half, half);
    return {x, y, z};
  }
  dvec3 direction() {
    for (;;) {
      const dvec3 v = in_cube(1);
      const double length = glm::length(v);
      if (length > 0.1 && length < 1) return v / length;
    }
  }

 private:
  std::mt19937 random_;
};

/// Convex bodies that drift and turn, among them flat ones, needles and points.
class MovingBodies {
 public:
  MovingBodies(unsigned seed, int count, double spread, double speed) {
    Dice dice(seed);
    for (int i = 0; i < count; ++i) {
      Body b;
      const dvec3 stretch = glm::abs(dice.in_cube(1)) + 0.1;
      const int kind = dice.below(12), points = kind == 0   ? 1
                                                : kind == 1 ? 2
                                                : kind == 2 ? 4
                                                            : 4 + dice.below(3);
      for (int k = 0; k < points; ++k) b.shape.push_back(dice.in_cube(1) * stretch);
      if (kind == 2)
        for (dvec3& p : b.shape) p.z = 0;
      b.centre = dice.in_cube(spread);
      b.velocity = dice.in_cube(speed);
      b.axis = dice.direction();
      b.rate = dice.uniform(-speed, speed);
      bodies_.push_back(b);
    }
    eye_ = dice.in_cube(1.5 * spread), eye_velocity_ = dice.in_cube(speed);
  }

  World at(double time) const {
    World world{eye_ + eye_velocity_ * time, {}};
    for (const Body& b : bodies_) {
      Points& points = world.bodies.emplace_back();
      const glm::dquat turn = glm::angleAxis(b.rate * time, b.axis);
      for (const dvec3& p : b.shape) points.push_back(b.centre + b.velocity * time + turn * p);
    }
    return world;
  }

 private:
  struct Body {
    Points shape;
    dvec3 centre, velocity, axis;
    double rate;
  };
  std::vector<Body> bodies_;
  dvec3 eye_, eye_velocity_;
};

}  // namespace talisman::layers::tests
