// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/ear_clipping.h"

#include <cstddef>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace talisman::sequences {

namespace {

using glm::dvec2;
using glm::dvec3;

/// Of the triangles from the first corner; the length of the sum is twice the area. Where that is zero (an outline like
/// an 8) each counts as if it turned the same way.
dvec3 newell_normal(std::span<const dvec3> corners) {
  dvec3 sum(0), sizes(0);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const dvec3 n = glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    sum += n;
    sizes += glm::abs(n);
  }
  return sum == dvec3(0) ? sizes : sum;
}

/// Along the axis that is nearest to the normal, and such that the outline turns counterclockwise.
std::vector<dvec2> flattened(std::span<const dvec3> corners) {
  const dvec3 n = newell_normal(corners), size = glm::abs(n);
  const int z = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
  const int x = (z + 1) % 3, y = (z + 2) % 3;
  std::vector<dvec2> flat;
  flat.reserve(corners.size());
  for (const dvec3& corner : corners) {
    const dvec3 from_first = corner - corners[0];
    flat.emplace_back(n[z] < 0 ? -from_first[x] : from_first[x], from_first[y]);
  }
  return flat;
}

/// Twice the area of a triangle, positive where it turns counterclockwise.
double turn(const dvec2& a, const dvec2& b, const dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// What is left of the polygon, as a ring.
class Outline {
 public:
  explicit Outline(std::vector<dvec2> places) : place_(std::move(places)) {
    const int count = static_cast<int>(place_.size());
    for (int i = 0; i < count; ++i) ring_.push_back({(i + count - 1) % count, (i + 1) % count});
    for (int i = 0; i < count; ++i)
      if (turn_at(i) <= 0) inward_.push_back(i);
  }

  int before(int i) const { return at(i).before; }
  int after(int i) const { return at(i).after; }
  double turn_at(int i) const { return turn(place(before(i)), place(i), place(after(i))); }

  /// Whether the triangle at the corner lies in the polygon: it turns as that does, and no corner that turns inwards
  /// is in it. (One that turns outwards is in it only together with such.)
  bool is_ear(int i) const {
    if (turn_at(i) <= 0) return false;
    const dvec2 &a = place(before(i)), &b = place(i), &c = place(after(i));
    for (const int k : inward_) {
      if (at(k).is_cut) continue;
      const dvec2& p = place(k);
      if (p == a || p == b || p == c) continue;
      if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
    }
    return true;
  }

  void cut(int i) {
    ring_[static_cast<std::size_t>(before(i))].after = after(i);
    ring_[static_cast<std::size_t>(after(i))].before = before(i);
    ring_[static_cast<std::size_t>(i)].is_cut = true;
  }

 private:
  struct Corner {
    int before, after;
    bool is_cut = false;
  };
  const Corner& at(int i) const { return ring_[static_cast<std::size_t>(i)]; }
  const dvec2& place(int i) const { return place_[static_cast<std::size_t>(i)]; }

  std::vector<dvec2> place_;
  std::vector<Corner> ring_;
  std::vector<int> inward_;  ///< a corner that turns outwards never comes to turn inwards by a cut
};

/// The first corner from `from` on that can be cut: an ear; else one whose triangle is empty; else, of an outline that
/// crosses itself, one that turns as the polygon does; else any.
int next_cut(const Outline& outline, int from, int left) {
  int flat = -1, outward = -1;
  for (int n = 0, i = from; n < left; ++n, i = outline.after(i)) {
    if (outline.is_ear(i)) return i;
    const double turn = outline.turn_at(i);
    if (turn == 0 && flat < 0) flat = i;
    if (turn > 0 && outward < 0) outward = i;
  }
  return flat >= 0 ? flat : outward >= 0 ? outward : from;
}

}  // namespace

std::vector<std::array<int, 3>> triangulated(std::span<const dvec3> corners) {
  std::vector<std::array<int, 3>> triangles;
  const int count = static_cast<int>(corners.size());
  if (count < 3) return triangles;
  if (count == 3) return {{0, 1, 2}};
  Outline outline(flattened(corners));
  // The corner of a quadrilateral that is cut first is one beside the shorter diagonal.
  int at =
      count == 4 && glm::distance(corners[0], corners[2]) < glm::distance(corners[1], corners[3]) ? 1 : 0;
  for (int left = count; left >= 3; --left) {
    const int corner = next_cut(outline, at, left);
    if (outline.turn_at(corner) != 0)
      triangles.push_back({corner, outline.after(corner), outline.before(corner)});
    at = outline.after(corner);
    outline.cut(corner);
  }
  return triangles;
}

}  // namespace talisman::sequences
