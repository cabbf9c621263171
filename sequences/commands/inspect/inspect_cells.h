// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman inspect --cells`: how many cells and portals there are, what lies in a cell and what can be seen from it, as
/// [Fu93 Table 3.2]; and a plan of what an eye sees in one frame (content/culling/cell_plan.h).

#include <string>

#include "sequences/content/sequence.h"

namespace talisman::sequences {

/// Mean and most over the cells.
struct PerCell {
  double mean = 0;
  int most = 0;
};

struct CellFigures {
  int cells = 0, portals = 0, parts = 0, outside = 0;  ///< outside: parts in no cell
  PerCell portals_of, parts_in, cells_seen, parts_seen;
  double precompute_ms = 0;
};

CellFigures cell_figures(const Sequence& sequence);

/// Writes the plan of the frame into the file `out` (empty: out/<name>-cells.svg) and says the rest. Throws InputError and OutputError.
std::string inspect_cells(const Sequence& sequence, int frame, const std::string& out, bool json);

}  // namespace talisman::sequences
