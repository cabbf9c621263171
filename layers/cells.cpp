// SPDX-License-Identifier: Apache-2.0
#include "layers/cells.h"

#include <algorithm>
#include <set>

#include <glm/geometric.hpp>

#include "layers/vectors.h"

namespace talisman::layers {
namespace {

std::string quoted_name(const CellSet& set, int cell) { return "'" + set.cells[cell].name + "'"; }

bool overlap_inside(const Cell& a, const Cell& b, double tolerance) {
  for (int k = 0; k < 3; ++k)
    if (std::min(a.hi[k], b.hi[k]) - std::max(a.lo[k], b.lo[k]) <= tolerance) return false;
  return true;
}

std::string defect_of_cells(const CellSet& set, double tolerance) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < set.cells.size(); ++i) {
    const Cell& cell = set.cells[i];
    if (cell.name.empty()) return "cell " + std::to_string(i) + ": no name, rule: every cell has one";
    if (!names.insert(cell.name).second) return "cell '" + cell.name + "': named twice, rule: names differ";
    if (!is_finite(cell.lo) || !is_finite(cell.hi))
      return "cell '" + cell.name + "': not finite, rule: six finite numbers";
    for (int k = 0; k < 3; ++k)
      if (!(cell.lo[k] < cell.hi[k]))
        return "cell '" + cell.name + "': inside out along " + "xyz"[k] + ", rule: lo below hi";
  }
  for (std::size_t i = 0; i < set.cells.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (overlap_inside(set.cells[i], set.cells[j], tolerance))
        return "cells '" + set.cells[j].name + "' and '" + set.cells[i].name +
               "' overlap, rule: cells touch at most";
  return {};
}

/// The axis across which two cells touch, and where; -1: they do not.
int shared_axis(const Cell& a, const Cell& b, double tolerance, double& where) {
  for (int k = 0; k < 3; ++k)
    for (const auto& [low, high] : {std::pair(&a, &b), std::pair(&b, &a)})
      if (std::fabs(low->hi[k] - high->lo[k]) <= tolerance) {
        where = low->hi[k];
        return k;
      }
  return -1;
}

bool is_convex(const std::vector<dvec3>& corners, double tolerance) {
  const std::size_t count = corners.size();
  dvec3 area(0);
  for (std::size_t i = 0; i < count; ++i) area += cross(corners[i], corners[(i + 1) % count]);
  if (!(glm::length(area) > tolerance * tolerance)) return false;
  double turned = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const dvec3 a = corners[(i + 1) % count] - corners[i],
                b = corners[(i + 2) % count] - corners[(i + 1) % count];
    const double turn = dot(cross(a, b), glm::normalize(area));
    if (turn < -tolerance * tolerance) return false;
    turned += std::atan2(turn, dot(a, b));
  }
  return turned < 7;  // once around, 2π; a star goes round twice
}

std::string defect_of_portal(const CellSet& set, std::size_t number, double tolerance) {
  const Portal& portal = set.portals[number];
  const std::string name = "portal " + std::to_string(number);
  for (const int cell : portal.cells)
    if (cell < 0 || cell >= static_cast<int>(set.cells.size()))
      return name + ": cell " + std::to_string(cell) + ", rule: below " + std::to_string(set.cells.size());
  if (portal.cells[0] == portal.cells[1]) return name + ": one cell twice, rule: two cells";
  if (portal.corners.size() < 3) return name + ": fewer than three corners, rule: a polygon";
  for (const dvec3& p : portal.corners)
    if (!is_finite(p)) return name + ": not finite, rule: finite corners";
  const Cell &a = set.cells[portal.cells[0]], &b = set.cells[portal.cells[1]];
  double where = 0;
  const int axis = shared_axis(a, b, tolerance, where);
  if (axis < 0)
    return name + ": " + quoted_name(set, portal.cells[0]) + " and " + quoted_name(set, portal.cells[1]) +
           " do not touch, rule: a portal is in the faces of both cells";
  for (const dvec3& p : portal.corners) {
    if (std::fabs(p[axis] - where) > tolerance)
      return name + ": a corner is off the shared face, rule: flat, in the faces of both cells";
    for (int k = 0; k < 3; ++k)
      if (p[k] < std::max(a.lo[k], b.lo[k]) - tolerance || p[k] > std::min(a.hi[k], b.hi[k]) + tolerance)
        return name + ": a corner is outside of " + quoted_name(set, portal.cells[0]) + " or " +
               quoted_name(set, portal.cells[1]) + ", rule: in the faces of both cells";
  }
  if (!is_convex(portal.corners, tolerance))
    return name + ": not convex, or without area, rule: a convex polygon";
  return {};
}

}  // namespace

double CellSet::extent() const {
  dvec3 lo(HUGE_VAL), hi(-HUGE_VAL);
  for (const Cell& cell : cells) lo = glm::min(lo, cell.lo), hi = glm::max(hi, cell.hi);
  return cells.empty() ? 0 : std::max({hi.x - lo.x, hi.y - lo.y, hi.z - lo.z});
}

std::vector<std::vector<int>> CellSet::portals_of() const {
  std::vector<std::vector<int>> of(cells.size());
  for (std::size_t i = 0; i < portals.size(); ++i)
    for (const int cell : portals[i].cells) of[cell].push_back(static_cast<int>(i));
  return of;
}

std::string first_defect(const CellSet& set) {
  const double tolerance = kCellTolerance * set.extent();
  if (std::string defect = defect_of_cells(set, tolerance); !defect.empty()) return defect;
  for (std::size_t i = 0; i < set.portals.size(); ++i)
    if (std::string defect = defect_of_portal(set, i, tolerance); !defect.empty()) return defect;
  return {};
}

}  // namespace talisman::layers
