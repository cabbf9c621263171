// SPDX-License-Identifier: Apache-2.0
#include "layers/extent_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace talisman::layers {

namespace {

constexpr int kLeaf = 4;
/// Above the rounding of a double quotient and of its conversion to float.
constexpr float kOutwards = 2.5e-7f;

/// The largest u·axis over points whose coordinate is at most `along` and whose other two coordinates have a
/// sum of squares between `least` and `most`.
double largest(double along, double least, double most) {
  const double others = along >= 0 ? least : most;
  const double length2 = along * along + others;
  return length2 > 0 ? along / std::sqrt(length2) : 0;
}

void include(DirectionBox& box, const DirectionBox& other) {
  for (int k = 0; k < 3; ++k) {
    box.lo[k] = std::min(box.lo[k], other.lo[k]);
    box.hi[k] = std::max(box.hi[k], other.hi[k]);
  }
}

}  // namespace

DirectionBox directions_to(const dvec3& eye, const dvec3& lo, const dvec3& hi) {
  const dvec3 from = lo - eye, to = hi - eye;
  double least[3], most[3];  // squares of the coordinates
  for (int k = 0; k < 3; ++k) {
    const double near = std::max({0.0, from[k], -to[k]}), far = std::max(-from[k], to[k]);
    least[k] = near * near, most[k] = far * far;
  }
  DirectionBox box;
  for (int k = 0; k < 3; ++k) {
    const int u = (k + 1) % 3, v = (k + 2) % 3;
    const double near2 = least[u] + least[v], far2 = most[u] + most[v];
    box.hi[k] = static_cast<float>(largest(to[k], near2, far2)) + kOutwards;
    box.lo[k] = static_cast<float>(-largest(-from[k], near2, far2)) - kOutwards;
  }
  return box;
}

void ExtentTree::build(std::span<const DirectionBox> boxes) {
  nodes_.clear();
  entries_.clear();
  for (std::size_t i = 0; i < boxes.size(); ++i)
    if (!boxes[i].empty()) entries_.push_back(static_cast<int>(i));
  if (!entries_.empty()) split(boxes, 0, static_cast<int>(entries_.size()));
  built_widths_ = 0;
  refit(boxes);
  built_widths_ = widths();
}

void ExtentTree::split(std::span<const DirectionBox> boxes, int first, int count) {
  const std::size_t node = nodes_.size();
  nodes_.emplace_back();
  if (count <= kLeaf) {
    nodes_[node].first = first, nodes_[node].count = count;
  } else {
    DirectionBox middles;
    const auto twice_middle = [&](int entry, int k) { return boxes[entry].lo[k] + boxes[entry].hi[k]; };
    middles.lo.fill(std::numeric_limits<float>::max());
    middles.hi.fill(std::numeric_limits<float>::lowest());
    for (int i = first; i < first + count; ++i)
      for (int k = 0; k < 3; ++k) {
        middles.lo[k] = std::min(middles.lo[k], twice_middle(entries_[i], k));
        middles.hi[k] = std::max(middles.hi[k], twice_middle(entries_[i], k));
      }
    int axis = 0;
    for (int k = 1; k < 3; ++k)
      if (middles.hi[k] - middles.lo[k] > middles.hi[axis] - middles.lo[axis]) axis = k;
    const auto begin = entries_.begin() + first;
    std::nth_element(begin, begin + count / 2, begin + count, [&](int a, int b) {
      const float ma = twice_middle(a, axis), mb = twice_middle(b, axis);
      return ma != mb ? ma < mb : a < b;  // a total order, so that every library builds the same tree
    });
    split(boxes, first, count / 2);
    split(boxes, first + count / 2, count - count / 2);
  }
  nodes_[node].next = static_cast<std::int32_t>(nodes_.size());
}

double ExtentTree::refit(std::span<const DirectionBox> boxes) {
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    Node& node = nodes_[i];
    if (node.count > 0) {
      node.box = boxes[entries_[node.first]];
      for (int k = 1; k < node.count; ++k) include(node.box, boxes[entries_[node.first + k]]);
    } else {
      node.box = nodes_[i + 1].box;
      include(node.box, nodes_[nodes_[i + 1].next].box);
    }
  }
  return built_widths_ > 0 ? widths() / built_widths_ : 1;
}

double ExtentTree::widths() const {
  double sum = 0;
  for (const Node& node : nodes_)
    for (int k = 0; k < 3; ++k) sum += node.box.hi[k] - node.box.lo[k];
  return sum;
}

void ExtentTree::query(const DirectionBox& box, std::span<const DirectionBox> boxes,
                       std::vector<int>& found) const {
  const std::int32_t end = static_cast<std::int32_t>(nodes_.size());
  for (std::int32_t i = 0; i < end;) {
    const Node& node = nodes_[i];
    if (!overlap(node.box, box)) {
      i = node.next;
      continue;
    }
    for (int k = node.first; k < node.first + node.count; ++k)
      if (overlap(boxes[entries_[k]], box)) found.push_back(entries_[k]);
    ++i;
  }
}

}  // namespace talisman::layers
