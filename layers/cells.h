// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Rooms, and the openings between them [Fu93 3].
///
/// A cell is an axis-aligned box of the world whose faces nobody can see through, but where a portal is: a convex
/// flat polygon in the faces of two cells. Cells touch and do not overlap. Who writes them promises that the faces
/// are opaque; `talisman accuracy --visibility` and the tests ask rays whether they are.
///
/// What lies in no cell is never hidden by one, and from an eye in no cell nothing is.

#include <string>
#include <vector>

#include "layers/region.h"

namespace talisman::layers {

struct Cell {
  std::string name;
  dvec3 lo{0, 0, 0}, hi{0, 0, 0};  ///< metres
};

struct Portal {
  int cells[2] = {-1, -1};
  std::vector<dvec3> corners;  ///< in their order around it, three or more
};

/// Lengths below this share of all cells' extent are roundings: of a portal's plane, of a corner on a face.
inline constexpr double kCellTolerance = 1e-6;

struct CellSet {
  std::vector<Cell> cells;
  std::vector<Portal> portals;

  /// The largest side of the box around all cells.
  double extent() const;
  /// The portals of each cell.
  std::vector<std::vector<int>> portals_of() const;
};

/// First broken rule ("portal 3: 'hall' and 'store' do not share a face, rule: …"), or an empty string. Cost:
/// O(cells²).
std::string first_defect(const CellSet& set);

}  // namespace talisman::layers
