// SPDX-License-Identifier: Apache-2.0
#include "regulator/content_leaves.h"

#include <algorithm>
#include <cmath>

namespace talisman::regulator {

using layers::dvec2;
using layers::dvec3;

namespace {

/// The longest edge along an axis on the display; endless where one reaches through the near plane.
double extent_px(const Corners& corners, unsigned axis, double near_m) {
  double longest = 0;
  for (unsigned k = 0; k < kBoxCorners; ++k) {
    if ((k & axis) != 0) continue;
    const dvec3 &a = corners[k], &b = corners[k | axis];
    if (a.x == b.x && a.y == b.y && a.z == b.z) continue;
    if (!(a.z > near_m && b.z > near_m)) return HUGE_VAL;
    longest = std::max(longest, glm::distance(dvec2(a) / a.z, dvec2(b) / b.z));
  }
  return longest;
}

class Halving {
 public:
  Halving(layers::ivec2 display_px, double margin_px, double near_m)
      : size_(display_px), margin_px_(margin_px), near_m_(near_m) {}

  void add(ContentLeaf leaf, int times, std::vector<ContentLeaf>& leaves) const {
    leaf.on_display =
        box_reach(BoxCorners(leaf.now), {}, size_, margin_px_, near_m_).sight != BoxSight::Outside;
    unsigned longest = 0;
    double extent = kLeafExtent_px;
    if (leaf.on_display && times > 0)
      for (const unsigned axis : {1u, 2u, 4u})
        if (const double px = extent_px(leaf.now, axis, near_m_); px > extent) {
          extent = px;
          longest = axis;
        }
    if (longest == 0) {
      leaves.push_back(leaf);
      return;
    }
    const int k = longest == 1 ? 0 : longest == 2 ? 1 : 2;
    const double middle = 0.5 * (leaf.lo[k] + leaf.hi[k]);
    ContentLeaf upper = leaf;
    leaf.hi[k] = upper.lo[k] = middle;
    for (unsigned c = 0; c < kBoxCorners; ++c) {
      if ((c & longest) != 0) continue;
      const dvec3 half = 0.5 * (leaf.now[c] + leaf.now[c | longest]);
      leaf.now[c | longest] = upper.now[c] = half;
    }
    add(leaf, times - 1, leaves);
    add(upper, times - 1, leaves);
  }

 private:
  dvec2 size_;
  double margin_px_, near_m_;
};

}  // namespace

Corners corners_of_part(BoxCorners box, const dvec3& lo, const dvec3& hi) {
  Corners corners;
  if (lo == dvec3(0) && hi == dvec3(1)) {
    std::copy(box.begin(), box.end(), corners.begin());
    return corners;
  }
  const auto mixed = [](const dvec3& a, const dvec3& b, double share) { return a + share * (b - a); };
  for (unsigned k = 0; k < kBoxCorners; ++k) {
    const double x = k & 1 ? hi.x : lo.x, y = k & 2 ? hi.y : lo.y, z = k & 4 ? hi.z : lo.z;
    const dvec3 near = mixed(mixed(box[0], box[1], x), mixed(box[2], box[3], x), y);
    const dvec3 far = mixed(mixed(box[4], box[5], x), mixed(box[6], box[7], x), y);
    corners[k] = mixed(near, far, z);
  }
  return corners;
}

std::vector<ContentLeaf> content_leaves(const std::vector<dvec3>& now, layers::ivec2 display_px,
                                        double margin_px, double near_m) {
  const Halving halving(display_px, margin_px, near_m);
  std::vector<ContentLeaf> leaves;
  leaves.reserve(now.size() / kBoxCorners);
  for (std::size_t box = 0; kBoxCorners * box < now.size(); ++box) {
    ContentLeaf leaf;
    leaf.box = box;
    std::copy_n(now.begin() + static_cast<std::ptrdiff_t>(kBoxCorners * box), kBoxCorners, leaf.now.begin());
    halving.add(leaf, kMostHalvings, leaves);
  }
  return leaves;
}

}  // namespace talisman::regulator
