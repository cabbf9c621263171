// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/culling/octree.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace talisman::sequences {

using layers::Box3;
using layers::dvec3;

namespace {

dvec3 middle_of(const Box3& box) {
  return 0.5 * (dvec3(box.lo[0], box.lo[1], box.lo[2]) + dvec3(box.hi[0], box.hi[1], box.hi[2]));
}

Box3 cube(const dvec3& centre, double side) {
  return layers::box_of(centre - dvec3(side / 2), centre + dvec3(side / 2));
}

bool encloses(const Box3& outer, const Box3& inner) { return layers::joined(outer, inner) == outer; }

}  // namespace

void Octree::build(std::span<const Box3> boxes) {
  cells_.clear();
  place_.assign(boxes.size(), {});
  Box3 all;
  for (const Box3& box : boxes)
    if (!box.empty() && box != layers::kEverywhere) all = layers::joined(all, box);
  reach_m_ = layers::reach_of(boxes);
  side_m_ = 0;
  for (int k = 0; k < 3 && !all.empty(); ++k) side_m_ = std::max(side_m_, double(all.hi[k]) - all.lo[k]);
  cells_.emplace_back();
  cells_[0].centre = all.empty() ? dvec3(0) : middle_of(all);
  cells_[0].bounds = layers::kEverywhere;  // what lies outside of the cube stays here
  for (std::size_t i = 0; i < boxes.size(); ++i) insert(static_cast<int>(i), boxes[i]);
}

bool Octree::fits(const Box3& box, const dvec3& centre, double side) const {
  if (looseness_ <= 1) return encloses(cube(centre, side), box);
  for (int k = 0; k < 3; ++k)
    if (double(box.hi[k]) - box.lo[k] > (looseness_ - 1) * side) return false;
  return encloses(cube(centre, looseness_ * side), box);
}

std::int32_t Octree::child_of(std::int32_t cell, int octant) {
  if (cells_[cell].child[octant] >= 0) return cells_[cell].child[octant];
  Cell child;
  child.parent = cell;
  child.level = cells_[cell].level + 1;
  const double side = std::ldexp(side_m_, -child.level);
  for (int k = 0; k < 3; ++k)
    child.centre[k] = cells_[cell].centre[k] + (octant >> k & 1 ? side / 2 : -side / 2);
  child.bounds = cube(child.centre, looseness_ * side);
  const auto number = static_cast<std::int32_t>(cells_.size());
  cells_.push_back(std::move(child));
  return cells_[cell].child[octant] = number;
}

std::int32_t Octree::cell_for(const Box3& box) {
  std::int32_t cell = 0;
  if (box == layers::kEverywhere || !(side_m_ > 0)) return cell;
  const dvec3 middle = middle_of(box);
  while (cells_[cell].level < kMostLevels) {
    const dvec3 centre = cells_[cell].centre;
    const double side = std::ldexp(side_m_, -cells_[cell].level - 1);
    int octant = 0;
    dvec3 of_child = centre;
    for (int k = 0; k < 3; ++k) {
      octant |= int(middle[k] >= centre[k]) << k;
      of_child[k] += middle[k] >= centre[k] ? side / 2 : -side / 2;
    }
    if (!fits(box, of_child, side)) break;
    cell = child_of(cell, octant);
  }
  return cell;
}

void Octree::insert(int entry, const Box3& box) {
  if (box.empty()) return;
  const std::int32_t number = cell_for(box);
  Cell& cell = cells_[number];
  const auto slot = static_cast<std::int32_t>(cell.entries.size());
  place_[entry] = {number, slot};
  cell.entries.push_back(entry);
  if (slot % 4 == 0) cell.lanes.emplace_back();
  cell.lanes.back().put(slot % 4, box);
  for (std::int32_t up = number; up >= 0; up = cells_[up].parent) ++cells_[up].below;
}

void Octree::remove(int entry) {
  const Place place = place_[entry];
  if (place.cell < 0) return;
  Cell& cell = cells_[place.cell];
  const auto last = static_cast<std::int32_t>(cell.entries.size()) - 1;
  cell.lanes[place.slot / 4].put(place.slot % 4, cell.lanes[last / 4].at(last % 4));
  cell.entries[place.slot] = cell.entries[last];
  place_[cell.entries[place.slot]].slot = place.slot;
  cell.entries.pop_back();
  if (last % 4 == 0) cell.lanes.pop_back();
  for (std::int32_t up = place.cell; up >= 0; up = cells_[up].parent) --cells_[up].below;
  place_[entry] = {};
}

void Octree::update(std::span<const Box3> boxes, std::span<const int> moved) {
  for (const int entry : moved) {
    reach_m_ = std::max(reach_m_, layers::reach_of({&boxes[entry], 1}));
    remove(entry);
    insert(entry, boxes[entry]);
  }
}

void Octree::take_all(const Cell& cell, std::vector<int>& found) const {
  found.insert(found.end(), cell.entries.begin(), cell.entries.end());
  for (const std::int32_t child : cell.child)
    if (child >= 0 && cells_[child].below > 0) take_all(cells_[child], found);
}

void Octree::test_entries(const Cell& cell, const layers::RegionTest& test, layers::PlaneMask mask,
                          std::vector<int>& found, layers::QueryCounters& counters) const {
  for (std::size_t block = 0; block < cell.lanes.size(); ++block) {
    const std::size_t count = std::min<std::size_t>(4, cell.entries.size() - 4 * block);
    unsigned alive = (1u << count) - 1;
    ++counters.nodes;
    for (layers::PlaneMask left = mask; left != 0 && alive != 0; left &= left - 1, ++counters.tests)
      alive &= ~test.outside(std::countr_zero(left), cell.lanes[block]);
    for (; alive != 0; alive &= alive - 1) found.push_back(cell.entries[4 * block + std::countr_zero(alive)]);
  }
}

void Octree::visit(const Cell& cell, const layers::RegionTest& test, layers::PlaneMask mask,
                   std::vector<int>& found, layers::QueryCounters& counters) const {
  ++counters.nodes;
  counters.tests += std::popcount(mask);
  counters.spared += test.planes() - std::popcount(mask);
  const layers::Side side = test.side_of(cell.bounds, mask);
  if (side == layers::Side::Outside) return;
  if (side == layers::Side::Inside) {
    counters.whole += cell.below;
    take_all(cell, found);
    return;
  }
  test_entries(cell, test, mask, found, counters);
  for (const std::int32_t child : cell.child)
    if (child >= 0 && cells_[child].below > 0) visit(cells_[child], test, mask, found, counters);
}

void Octree::query(std::span<const layers::Plane> region, std::vector<int>& found,
                   layers::QueryCounters& counters) {
  const layers::RegionTest test(region, reach_m_);
  if (!cells_.empty() && cells_[0].below > 0) visit(cells_[0], test, test.all(), found, counters);
}

}  // namespace talisman::sequences
