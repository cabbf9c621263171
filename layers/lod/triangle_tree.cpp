// SPDX-License-Identifier: Apache-2.0
#include "layers/lod/triangle_tree.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "layers/vectors.h"

namespace talisman::layers {
namespace {

constexpr int kLeaf = 4;
constexpr int kDeepest = 64;  // a median halves: 2^60 triangles

double square(const dvec3& v) { return glm::dot(v, v); }

double square_to_segment(const dvec3& p, const dvec3& a, const dvec3& b) {
  const dvec3 along = b - a;
  const double length2 = square(along);
  const double t = length2 > 0 ? std::clamp(glm::dot(p - a, along) / length2, 0.0, 1.0) : 0.0;
  return square(p - (a + t * along));
}

/// To the plane where the foot lies inside, else to the nearest edge: right without area, too.
double square_to_triangle(const dvec3& p, const dvec3& a, const dvec3& b, const dvec3& c) {
  const dvec3 normal = direction_or_zero(glm::cross(b - a, c - a));
  if (normal != dvec3(0.0)) {
    const auto side = [&](const dvec3& from, const dvec3& to) {
      return glm::dot(glm::cross(to - from, p - from), normal);
    };
    if (side(a, b) >= 0 && side(b, c) >= 0 && side(c, a) >= 0) {
      const double height = glm::dot(p - a, normal);
      return height * height;
    }
  }
  return std::min({square_to_segment(p, a, b), square_to_segment(p, b, c), square_to_segment(p, c, a)});
}

double square_to_box(const dvec3& p, const dvec3& lo, const dvec3& hi) {
  return square(glm::max(glm::max(lo - p, p - hi), dvec3(0.0)));
}

}  // namespace

TriangleTree::TriangleTree(std::vector<dvec3> positions, std::span<const std::uint32_t> indices) {
  triangles_.reserve(indices.size() / 3);
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
    triangles_.push_back({positions[indices[i]], positions[indices[i + 1]], positions[indices[i + 2]]});
  if (!triangles_.empty()) build(0, static_cast<int>(triangles_.size()));
}

int TriangleTree::build(int first, int count) {
  const int index = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  dvec3 lo(HUGE_VAL), hi(-HUGE_VAL), middle_lo(HUGE_VAL), middle_hi(-HUGE_VAL);
  for (int i = first; i < first + count; ++i) {
    const Triangle& t = triangles_[static_cast<std::size_t>(i)];
    lo = glm::min(lo, glm::min(t.a, glm::min(t.b, t.c)));
    hi = glm::max(hi, glm::max(t.a, glm::max(t.b, t.c)));
    middle_lo = glm::min(middle_lo, t.a + t.b + t.c);
    middle_hi = glm::max(middle_hi, t.a + t.b + t.c);
  }
  Node node{lo, hi, first, count, -1, -1};
  if (count > kLeaf) {
    const dvec3 extent = middle_hi - middle_lo;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const auto begin = triangles_.begin() + first;
    std::nth_element(begin, begin + count / 2, begin + count, [axis](const Triangle& s, const Triangle& t) {
      return s.a[axis] + s.b[axis] + s.c[axis] < t.a[axis] + t.b[axis] + t.c[axis];
    });
    node.count = 0;
    node.left = build(first, count / 2);
    node.right = build(first + count / 2, count - count / 2);
  }
  nodes_[static_cast<std::size_t>(index)] = node;
  return index;
}

double TriangleTree::distance(const dvec3& point) const {
  double best = HUGE_VAL;
  if (nodes_.empty()) return best;
  std::array<int, kDeepest> stack{};
  int depth = 0;
  stack[static_cast<std::size_t>(depth++)] = 0;
  const auto square_to = [&](int node) {
    const Node& n = nodes_[static_cast<std::size_t>(node)];
    return square_to_box(point, n.lo, n.hi);
  };
  while (depth > 0) {
    const Node& node = nodes_[static_cast<std::size_t>(stack[static_cast<std::size_t>(--depth)])];
    if (square_to_box(point, node.lo, node.hi) >= best) continue;
    for (int i = node.first; i < node.first + node.count; ++i) {
      const Triangle& t = triangles_[static_cast<std::size_t>(i)];
      best = std::min(best, square_to_triangle(point, t.a, t.b, t.c));
    }
    if (node.count > 0) continue;
    const bool left_first = square_to(node.left) <= square_to(node.right);
    stack[static_cast<std::size_t>(depth++)] = left_first ? node.right : node.left;
    stack[static_cast<std::size_t>(depth++)] = left_first ? node.left : node.right;
  }
  return std::sqrt(best);
}

double TriangleTree::best_facing(const dvec3& point, double within_m, const dvec3& facing) const {
  double best = -2;
  if (nodes_.empty()) return best;
  const double within2 = within_m * within_m;
  std::vector<int> stack{0};
  while (!stack.empty()) {
    const Node& node = nodes_[static_cast<std::size_t>(stack.back())];
    stack.pop_back();
    if (square_to_box(point, node.lo, node.hi) > within2) continue;
    for (int i = node.first; i < node.first + node.count; ++i) {
      const Triangle& t = triangles_[static_cast<std::size_t>(i)];
      if (square_to_triangle(point, t.a, t.b, t.c) > within2) continue;
      const dvec3 normal = direction_or_zero(glm::cross(t.b - t.a, t.c - t.a));
      if (normal != dvec3(0.0)) best = std::max(best, glm::dot(normal, facing));
    }
    if (node.count > 0) continue;
    stack.push_back(node.left);
    stack.push_back(node.right);
  }
  return best;
}

}  // namespace talisman::layers
