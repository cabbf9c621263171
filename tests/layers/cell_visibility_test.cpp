// SPDX-License-Identifier: Apache-2.0
#include "layers/cell_visibility.h"

#include <algorithm>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "tests/layers/boxes_by_lot.h"

namespace talisman::layers {
namespace {

/// A rectangle, or an octagon within it, in the plane axis = where.
Portal hole(int a, int b, int axis, double where, const dvec3& lo, const dvec3& hi, bool octagon = false) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  Portal portal{{a, b}, {}};
  const int corners = octagon ? 8 : 4;
  for (int k = 0; k < corners; ++k) {
    dvec3 p;
    p[axis] = where;
    const double angle = 2 * M_PI * (k + 0.5) / corners, scale = octagon ? 0.5 : std::sqrt(0.5);
    p[u] = 0.5 * (lo[u] + hi[u]) + scale * std::cos(angle) * (hi[u] - lo[u]);
    p[v] = 0.5 * (lo[v] + hi[v]) + scale * std::sin(angle) * (hi[v] - lo[v]);
    portal.corners.push_back(p);
  }
  return portal;
}

/// nx × ny × nz cells of unequal sides, with holes by lot in most of the faces that two share: small, large, up to the
/// edges of the face.
CellSet maze(int nx, int ny, int nz, unsigned seed, double scale = 1, const dvec3& shift = {0, 0, 0}) {
  std::mt19937 lot(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const int count[3] = {nx, ny, nz};
  std::vector<double> planes[3];
  for (int k = 0; k < 3; ++k) {
    planes[k].push_back(shift[k]);
    for (int i = 0; i < count[k]; ++i) planes[k].push_back(planes[k].back() + scale * (2 + 3 * unit(lot)));
  }
  CellSet set;
  const auto number = [&](int x, int y, int z) { return (z * ny + y) * nx + x; };
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x)
        set.cells.push_back({std::to_string(number(x, y, z)),
                             {planes[0][x], planes[1][y], planes[2][z]},
                             {planes[0][x + 1], planes[1][y + 1], planes[2][z + 1]}});
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x)
        for (int axis = 0; axis < 3; ++axis) {
          int next[3] = {x, y, z};
          if (++next[axis] >= count[axis] || unit(lot) < 0.25) continue;
          const int a = number(x, y, z), b = number(next[0], next[1], next[2]);
          dvec3 lo = set.cells[a].lo, hi = set.cells[a].hi;
          const double where = hi[axis];
          const dvec3 size = hi - lo;
          if (unit(lot) < 0.8) lo += 0.4 * unit(lot) * size, hi -= 0.4 * unit(lot) * size;
          set.portals.push_back(hole(a, b, axis, where, lo, hi, unit(lot) < 0.2));
        }
  return set;
}

bool is_inside(const Portal& portal, int axis, const dvec3& p) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  int left = 0, right = 0;
  for (std::size_t i = 0; i < portal.corners.size(); ++i) {
    const dvec3 &a = portal.corners[i], &b = portal.corners[(i + 1) % portal.corners.size()];
    const double turn = (b[u] - a[u]) * (p[v] - a[v]) - (b[v] - a[v]) * (p[u] - a[u]);
    left += turn > 0, right += turn < 0;
  }
  return left == 0 || right == 0;
}

/// A piece of a ray: in a cell, from one point to another.
struct Leg {
  int cell;
  dvec3 from, to;
};

/// Where the ray goes, cell by cell, until it meets a face beside its portals. The slow oracle: no planes, no windows.
std::vector<Leg> walk(const CellSet& set, const std::vector<std::vector<int>>& portals_of, int cell,
                      dvec3 eye, const dvec3& direction) {
  std::vector<Leg> legs;
  for (int steps = 0; steps < 1000; ++steps) {
    double t = HUGE_VAL;
    int axis = 0;
    for (int k = 0; k < 3; ++k) {
      if (direction[k] == 0) continue;
      const double at =
          ((direction[k] > 0 ? set.cells[cell].hi[k] : set.cells[cell].lo[k]) - eye[k]) / direction[k];
      if (at < t) t = at, axis = k;
    }
    const dvec3 out = eye + std::max(t, 0.0) * direction;
    legs.push_back({cell, eye, out});
    int next = -1;
    for (const int i : portals_of[cell]) {
      const Portal& portal = set.portals[i];
      const double where = direction[axis] > 0 ? set.cells[cell].hi[axis] : set.cells[cell].lo[axis];
      const bool in_face = std::all_of(portal.corners.begin(), portal.corners.end(),
                                       [&](const dvec3& p) { return p[axis] == where; });
      if (in_face && is_inside(portal, axis, out))
        next = portal.cells[0] == cell ? portal.cells[1] : portal.cells[0];
    }
    if (next < 0) break;
    cell = next, eye = out;
  }
  return legs;
}

/// Is the whole leg in one of the sights of its cell, to rounding?
bool is_seen(const std::vector<CellSight>& sights, const Leg& leg, double tolerance) {
  return std::any_of(sights.begin(), sights.end(), [&](const CellSight& sight) {
    if (sight.cell != leg.cell) return false;
    return std::all_of(sight.region.begin(), sight.region.end(), [&](const Plane& plane) {
      const double least = -tolerance * glm::length(plane.normal);
      return plane.height(leg.from) >= least && plane.height(leg.to) >= least;
    });
  });
}

dvec3 direction_by_lot(std::mt19937& lot) {
  std::normal_distribution<double> normal;
  return glm::normalize(dvec3(normal(lot), 0.3 * normal(lot), normal(lot)));
}

void expect_rays_stay_in_sight(const CellSet& set, unsigned seed, int eyes, int rays) {
  ASSERT_EQ(first_defect(set), "");
  const auto portals_of = set.portals_of();
  const double tolerance = 1e-9 * set.extent();
  std::mt19937 lot(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t longest = 0;
  for (int k = 0; k < eyes; ++k) {
    const int cell = static_cast<int>(lot() % set.cells.size());
    const dvec3 eye =
        glm::mix(set.cells[cell].lo, set.cells[cell].hi, dvec3(unit(lot), unit(lot), unit(lot)));
    const std::vector<CellSight> from_cell = sights_from_cell(set, portals_of, cell);
    const std::vector<int> around = cells_around(set, eye, 0);
    const EyeSights from_eye = sights_from_eye(set, portals_of, around, eye, 0, {});
    EXPECT_FALSE(from_eye.gave_up);
    for (int r = 0; r < rays; ++r)
      for (const Leg& leg : walk(set, portals_of, cell, eye, direction_by_lot(lot))) {
        EXPECT_TRUE(is_seen(from_cell, leg, tolerance)) << "cell " << cell << " to " << leg.cell;
        EXPECT_TRUE(is_seen(from_eye.sights, leg, tolerance)) << "eye in " << cell << " to " << leg.cell;
        longest = std::max<std::size_t>(longest, r);
        if (testing::Test::HasFailure()) return;
      }
  }
}

TEST(CellVisibility, RaysThroughMazesHitNothingOutsideOfTheSights) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    expect_rays_stay_in_sight(maze(4, 3, 4, seed), seed, 20, 300);
  }
}

TEST(CellVisibility, ScaleAndPlaceDoNotMatter) {
  for (const double scale : {1e-4, 1e6}) expect_rays_stay_in_sight(maze(3, 2, 3, 5, scale), 5, 10, 200);
  expect_rays_stay_in_sight(maze(3, 2, 3, 5, 1, {1e4, -1e4, 1e4}), 5, 10, 200);
}

// Four cells meet in an edge, whole faces are portals, so that rows of portals go round and round it.
TEST(CellVisibility, PortalsThatGoRoundAnEdgeEnd) {
  CellSet set;
  for (int k = 0; k < 4; ++k) {
    const double x = k == 1 || k == 2 ? 1 : 0, z = k >= 2 ? 1 : 0;
    set.cells.push_back({std::to_string(k), {x, 0, z}, {x + 1, 1, z + 1}});
  }
  set.portals = {hole(0, 1, 0, 1, {1, 0, 0}, {1, 1, 1}), hole(1, 2, 2, 1, {1, 0, 1}, {2, 1, 1}),
                 hole(2, 3, 0, 1, {1, 0, 1}, {1, 1, 2}), hole(3, 0, 2, 1, {0, 0, 1}, {1, 1, 1})};
  expect_rays_stay_in_sight(set, 1, 40, 300);
  EXPECT_EQ(cells_around(set, {1, 0.5, 1}, 0).size(), 4u);  // on the edge: in all four
}

std::set<int> cells_seen(const std::vector<CellSight>& sights) {
  std::set<int> cells;
  for (const CellSight& sight : sights) cells.insert(sight.cell);
  return cells;
}

/// Rooms 0 … n-1 on one side of a corridor, n … 2n-1 on the other; each has a door of 1 m in its middle.
CellSet corridor(int n) {
  CellSet set;
  for (int k = 0; k < 2 * n; ++k) {
    const double x = 4 * (k % n), z = k < n ? 2 : -4;
    set.cells.push_back({"room " + std::to_string(k), {x, 0, z}, {x + 4, 3, z + 4}});
  }
  set.cells.push_back({"corridor", {0, 0, 0}, {4.0 * n, 3, 2}});
  for (int k = 0; k < 2 * n; ++k) {
    const double x = 4 * (k % n) + 2, z = k < n ? 2 : 0;
    set.portals.push_back(hole(k, 2 * n, 2, z, {x - 0.5, 0, z}, {x + 0.5, 2, z}));
  }
  return set;
}

// Doors of one wall lie in one plane: no line goes through two of them. Across the corridor the view from a
// room through its door widens by hand: from (1.5 … 2.5, z = 2) lines of slope at most … reach the room across whole, and
// its neighbours only by doors 4 m on, 2 m away: slope (3 … 5) / 2, which is there from a room 4 m deep.
TEST(CellVisibility, RoomsOnOneSideOfACorridorDoNotSeeEachOther) {
  const CellSet set = corridor(20);
  ASSERT_EQ(first_defect(set), "");
  const std::set<int> seen = cells_seen(sights_from_cell(set, set.portals_of(), 3));
  EXPECT_TRUE(seen.contains(3) && seen.contains(40) && seen.contains(23));
  for (int room = 0; room < 20; ++room) EXPECT_EQ(seen.contains(room), room == 3) << room;
  EXPECT_EQ(cells_seen(sights_from_cell(set, set.portals_of(), 40)).size(), 41u);
  expect_rays_stay_in_sight(set, 2, 40, 300);
}

TEST(CellVisibility, ACellWithSixtyThreePortalsIsWorkedOut) {
  const CellSet set = corridor(32);  // 64 doors
  expect_rays_stay_in_sight(set, 3, 20, 200);
}

TEST(CellVisibility, AnEyeOnAPortalSeesBothSidesWhole) {
  const CellSet set = corridor(3);
  const dvec3 eye(6, 1, 2);  // in the door of room 1
  const std::vector<int> around = cells_around(set, eye, 0.05);
  EXPECT_EQ(std::set<int>(around.begin(), around.end()), (std::set<int>{1, 6}));
  const EyeSights sights = sights_from_eye(set, set.portals_of(), around, eye, 0.05, {});
  for (const int cell : {1, 6})
    EXPECT_TRUE(std::any_of(sights.sights.begin(), sights.sights.end(),
                            [&](const CellSight& s) { return s.cell == cell && s.region.empty(); }));
}

// Before a closed wall, away from its door, with the eye a hair off the plane of the door.
TEST(CellVisibility, AnEyeInThePlaneOfADoorDoesNotLookThroughIt) {
  const CellSet set = corridor(3);
  for (const double off : {0.0, 1e-12, 1e-9, 1e-6}) {
    const dvec3 eye(4.6, 1, 2 + off);
    const EyeSights sights = sights_from_eye(set, set.portals_of(), std::vector<int>{1}, eye, 0.01, {});
    EXPECT_LE(cells_seen(sights.sights).size(), 2u) << off;
  }
}

TEST(CellVisibility, NothingIsSeenThroughWhatIsNotAllowed) {
  const CellSet set = corridor(3);
  std::vector<char> allowed(set.cells.size(), 0);
  allowed[1] = 1;
  const EyeSights sights =
      sights_from_eye(set, set.portals_of(), std::vector<int>{1}, {6, 1, 4}, 0.01, {}, allowed);
  EXPECT_EQ(cells_seen(sights.sights), (std::set<int>{1}));
}

TEST(CellVisibility, AnEyeOutsideIsInNoCell) {
  EXPECT_TRUE(cells_around(corridor(3), {6, 10, 2}, 0.1).empty());
  EXPECT_TRUE(cells_around(CellSet{}, {0, 0, 0}, 1).empty());
}

}  // namespace
}  // namespace talisman::layers
