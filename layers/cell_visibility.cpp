// SPDX-License-Identifier: Apache-2.0
#include "layers/cell_visibility.h"

#include <algorithm>
#include <limits>

#include <glm/geometric.hpp>

#include "layers/vectors.h"

namespace talisman::layers {
namespace {

using Window = std::vector<dvec3>;

/// n · x + d ≥ 0 with n of unit length.
Plane unit_plane(const dvec3& normal, const dvec3& through) {
  const dvec3 n = direction_or_zero(normal);
  return {n, -glm::dot(n, through)};
}

double lowest(const Plane& plane, const Window& points) {
  double least = HUGE_VAL;
  for (const dvec3& p : points) least = std::min(least, plane.height(p));
  return least;
}
double highest(const Plane& plane, const Window& points) {
  double most = -HUGE_VAL;
  for (const dvec3& p : points) most = std::max(most, plane.height(p));
  return most;
}

/// What is left of a convex polygon inside of the plane, `by` metres beyond it counting as inside.
Window clipped(const Window& polygon, const Plane& plane, double by) {
  Window left;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double ha = plane.height(a) + by, hb = plane.height(b) + by;
    if (ha >= 0) left.push_back(a);
    if ((ha >= 0) != (hb >= 0)) left.push_back(a + ha / (ha - hb) * (b - a));
  }
  return left;
}

/// Is it narrower than `width` everywhere?
bool is_closed(const Window& window, double width) {
  if (window.size() < 3) return true;
  dvec3 area(0);
  double around = 0;
  for (std::size_t i = 0; i < window.size(); ++i) {
    const dvec3 &a = window[i] - window[0], &b = window[(i + 1) % window.size()] - window[0];
    area += cross(a, b);
    around += glm::distance(a, b);
  }
  return !(glm::length(area) >
           width * around / 2);  // twice the area of a strip is its width times its way around
}

/// The plane of a portal, facing into `cell`.
Plane into(const CellSet& set, const Portal& portal, int cell) {
  dvec3 area(0);
  for (std::size_t i = 0; i < portal.corners.size(); ++i)
    area += cross(portal.corners[i] - portal.corners[0],
                  portal.corners[(i + 1) % portal.corners.size()] - portal.corners[0]);
  Plane plane = unit_plane(area, portal.corners[0]);
  const dvec3 middle = 0.5 * (set.cells[cell].lo + set.cells[cell].hi);
  return plane.height(middle) < 0 ? Plane{-plane.normal, -plane.offset} : plane;
}

int other_cell(const Portal& portal, int cell) {
  return portal.cells[0] == cell ? portal.cells[1] : portal.cells[0];
}

/// Adds the planes through edges of `edges` and corners of `corners` with all of `before` below and of `behind` above.
void add_separators(const Window& edges, const Window& corners, const Window& before, const Window& behind,
                    double tolerance, Region& region) {
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const dvec3& a = edges[i];
    const dvec3 along = edges[(i + 1) % edges.size()] - a;
    for (const dvec3& corner : corners) {
      const dvec3 normal = cross(along, corner - a);
      if (!(glm::length(normal) > tolerance * tolerance)) continue;
      for (const double sign : {1.0, -1.0}) {
        Plane plane = unit_plane(sign * normal, a);
        if (highest(plane, before) > tolerance || lowest(plane, behind) < -tolerance) continue;
        plane.offset += tolerance;
        const bool is_known = std::any_of(region.begin(), region.end(), [&](const Plane& p) {
          return glm::dot(p.normal, plane.normal) > 1 - 1e-12 &&
                 std::fabs(p.offset - plane.offset) < tolerance;
        });
        if (!is_known && region.size() < kMostPlanes) region.push_back(plane);
      }
    }
  }
}

/// The half-spaces behind `window` of lines that come from `source`.
Region behind(const Window& source, const Window& window, const Plane& out, double tolerance) {
  Region region{out};
  add_separators(source, window, source, window, tolerance, region);
  add_separators(window, source, source, window, tolerance, region);
  return region;
}

/// Everything that is seen through one portal of a cell.
class SightThroughPortal {
 public:
  SightThroughPortal(const CellSet& set, const std::vector<std::vector<int>>& portals_of, int cell,
                     int portal)
      : set_(set),
        portals_of_(portals_of),
        tolerance_(kCellTolerance * set.extent()),
        source_(set.portals[portal].corners),
        windows_(2 * set.portals.size()) {
    const int next = other_cell(set.portals[portal], cell);
    follow(portal, next, {into(set, set.portals[portal], next)});
    while (!waiting_.empty()) {
      const int way = waiting_.back();
      waiting_.pop_back();
      follow(way / 2, cell_behind(way), region_behind(way));
    }
  }

  void append_to(std::vector<CellSight>& sights) const {
    for (std::size_t way = 0; way < windows_.size(); ++way)
      if (!windows_[way].empty())
        sights.push_back({cell_behind(static_cast<int>(way)), region_behind(static_cast<int>(way))});
  }

 private:
  /// A way is a portal and a direction: into its cells[way % 2].
  int cell_behind(int way) const { return set_.portals[way / 2].cells[way % 2]; }
  Plane plane_of(int way) const { return into(set_, set_.portals[way / 2], cell_behind(way)); }

  /// Of the source only what lies before the portal counts.
  Region region_behind(int way) const {
    const Plane out = plane_of(way);
    return behind(clipped(source_, {-out.normal, -out.offset}, 0), windows_[way], out, tolerance_);
  }

  /// Looks on from `cell`, entered by `portal`.
  void follow(int portal, int cell, const Region& region) {
    for (const int next : portals_of_[cell]) {
      if (next == portal) continue;
      const int way = 2 * next + (set_.portals[next].cells[1] != cell);
      const Plane out = plane_of(way);
      // No line passes two portals of one plane, nor one whose front it comes from.
      if (lowest(out, source_) > -tolerance_) continue;
      Window window = set_.portals[next].corners;
      for (const Plane& plane : region) window = clipped(window, plane, tolerance_);
      if (is_closed(window, 3 * tolerance_)) continue;
      keep(way, window);
    }
  }

  void keep(int way, const Window& window) {
    Window& kept = windows_[way];
    if (!kept.empty() && is_in(window, kept)) return;
    kept = kept.empty() ? window : set_.portals[way / 2].corners;
    waiting_.push_back(way);
  }

  /// Both in one plane.
  bool is_in(const Window& inner, const Window& outer) const {
    dvec3 area(0);
    for (std::size_t i = 0; i < outer.size(); ++i)
      area += cross(outer[i] - outer[0], outer[(i + 1) % outer.size()] - outer[0]);
    for (std::size_t i = 0; i < outer.size(); ++i) {
      const Plane edge = unit_plane(cross(area, outer[(i + 1) % outer.size()] - outer[i]), outer[i]);
      if (lowest(edge, inner) < -tolerance_) return false;
    }
    return true;
  }

  const CellSet& set_;
  const std::vector<std::vector<int>>& portals_of_;
  double tolerance_;
  Window source_;
  std::vector<Window> windows_;  ///< by way
  std::vector<int> waiting_;
};

double distance_to(const Cell& cell, const dvec3& p) {
  return glm::length(glm::max(dvec3(0), glm::max(cell.lo - p, p - cell.hi)));
}

/// No less than the true one by more than rounding: to the box around the polygon.
double distance_to(const Window& polygon, const dvec3& p) {
  Cell box{"", polygon[0], polygon[0]};
  for (const dvec3& corner : polygon) box.lo = glm::min(box.lo, corner), box.hi = glm::max(box.hi, corner);
  return distance_to(box, p);
}

class SightFromEye {
 public:
  SightFromEye(const CellSet& set, const std::vector<std::vector<int>>& portals_of, const dvec3& eye,
               double reach, std::span<const char> allowed)
      : set_(set),
        portals_of_(portals_of),
        eye_(eye),
        reach_(reach),
        tolerance_(1e-3 * kCellTolerance * set.extent()),
        allowed_(allowed),
        on_path_(set.cells.size(), 0) {}

  void visit(int cell, const Region& wedge) {
    if (static_cast<int>(sights_.sights.size()) >= kMostWedges) sights_.gave_up = true;
    if (sights_.gave_up) return;
    sights_.sights.push_back({cell, wedge});
    on_path_[cell] = 1;
    for (const int portal : portals_of_[cell]) {
      const int next = other_cell(set_.portals[portal], cell);
      if (on_path_[next] || (!allowed_.empty() && !allowed_[next])) continue;
      look_through(set_.portals[portal], next, wedge);
    }
    on_path_[cell] = 0;
  }

  EyeSights take() { return std::move(sights_); }

 private:
  void look_through(const Portal& portal, int next, const Region& wedge) {
    if (distance_to(portal.corners, eye_) <= reach_) {
      ++sights_.portals;
      return visit(next, wedge);
    }
    if (into(set_, portal, next).height(eye_) > -tolerance_) return;  // seen from its other side, or edge-on
    Window window = portal.corners;
    for (const Plane& plane : wedge) {
      window = clipped(window, plane, tolerance_ * glm::length(plane.normal));
      if (window.size() < 3) return;
    }
    ++sights_.portals;
    visit(next, through(window));
  }

  /// The planes through the eye and the window's edges. One that does not tell its sides apart is left out.
  Region through(const Window& window) const {
    dvec3 middle(0);
    for (const dvec3& p : window) middle += p / static_cast<double>(window.size());
    Region wedge;
    for (std::size_t i = 0; i < window.size() && wedge.size() < kMostPlanes; ++i) {
      const dvec3 a = window[i] - eye_, b = window[(i + 1) % window.size()] - eye_;
      if (glm::length(b - a) <= tolerance_) continue;
      Plane plane = unit_plane(cross(a, b), eye_);
      if (plane.height(middle) < 0) plane = {-plane.normal, -plane.offset};
      plane.offset += tolerance_;
      if (lowest(plane, window) >= 0 && highest(plane, window) > 4 * tolerance_) wedge.push_back(plane);
    }
    return wedge;
  }

  const CellSet& set_;
  const std::vector<std::vector<int>>& portals_of_;
  dvec3 eye_;
  double reach_, tolerance_;
  std::span<const char> allowed_;
  std::vector<char> on_path_;
  EyeSights sights_;
};

}  // namespace

std::vector<CellSight> sights_from_cell(const CellSet& set, const std::vector<std::vector<int>>& portals_of,
                                        int cell) {
  std::vector<CellSight> sights{{cell, {}}};
  for (const int portal : portals_of[cell]) sights.push_back({other_cell(set.portals[portal], cell), {}});
  for (const int portal : portals_of[cell])
    SightThroughPortal(set, portals_of, cell, portal).append_to(sights);
  return sights;
}

std::vector<int> cells_around(const CellSet& set, const dvec3& eye, double reach) {
  std::vector<int> around;
  const double within = reach + kCellTolerance * set.extent();
  for (std::size_t i = 0; i < set.cells.size(); ++i)
    if (distance_to(set.cells[i], eye) <= within) around.push_back(static_cast<int>(i));
  return around;
}

EyeSights sights_from_eye(const CellSet& set, const std::vector<std::vector<int>>& portals_of,
                          std::span<const int> from, const dvec3& eye, double reach,
                          std::span<const Plane> view, std::span<const char> allowed) {
  SightFromEye sight(set, portals_of, eye, reach, allowed);
  const Region wedge(view);
  for (const int cell : from) sight.visit(cell, wedge);
  return sight.take();
}

}  // namespace talisman::layers
