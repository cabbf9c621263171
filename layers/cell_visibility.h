// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What can be seen from a cell, and what from an eye, through the portals [Fu93 3-4]? Always at least what can.
///
/// From a cell C through its portal S and a row of others, the last of which shows the window W (a part of itself):
/// a plane n · x = d with all of S on one side and all of W on the other is never crossed back by a line that has
/// gone from S to W, so that what is seen behind W lies on W's side of every such plane. Those through an edge of one and a
/// corner of the other are the tightest. The next portal is clipped to these half-spaces, and what is
/// left of it is the next window. A sightline enters a convex cell once; but rows of portals need not be followed one by
/// one: for each pair (S, portal) one window is kept, the first that is found, or all of the portal as soon as another
/// is not in it. So the work is at most 2 · portals² for each cell, however the paths branch or go round. Any convex
/// polygon serves as a portal; Fu93's three bow ties are the case of axial rectangles.
///
/// Direct neighbours are seen whole, without a test. A window narrower than kCellTolerance of all cells' extent counts as
/// closed: so do portals in one plane, which no line passes both.
///
/// From an eye the windows are exact: the wedge of planes through the eye and the edges of the portal, as far as that
/// is in the wedge before it. An eye nearer to a portal than `reach` (where the near plane may lie behind it) sees
/// through it with the wedge that it has. Rows of portals are followed depth first; since a ray takes one of them, their
/// wedges share no more than edges, and their number is bounded by the picture.

#include <vector>

#include "layers/cells.h"

namespace talisman::layers {

/// What an eye somewhere in one cell may see of another: what meets the region. Without planes: all of it.
struct CellSight {
  int cell = -1;
  Region region;
};

/// All that an eye somewhere in `cell` may see: itself, its neighbours, and what lies behind. A cell may come up more than
/// once, by other portals.
std::vector<CellSight> sights_from_cell(const CellSet& set, const std::vector<std::vector<int>>& portals_of,
                                        int cell);

/// The cells whose closed boxes, `reach` larger, hold the point.
std::vector<int> cells_around(const CellSet& set, const dvec3& eye, double reach);

/// What the eye sees of a cell: what meets one of the wedges.
struct EyeSights {
  std::vector<CellSight> sights;
  int portals = 0;       ///< that were looked through
  bool gave_up = false;  ///< more than kMostWedges: then nothing is known
};
inline constexpr int kMostWedges = 100'000;

/// `view`: the sides of what the camera shows, without the near plane. `allowed`: by cell, those that may be seen at all;
/// empty: all. `from`: cells_around the eye.
EyeSights sights_from_eye(const CellSet& set, const std::vector<std::vector<int>>& portals_of,
                          std::span<const int> from, const dvec3& eye, double reach,
                          std::span<const Plane> view, std::span<const char> allowed = {});

}  // namespace talisman::layers
