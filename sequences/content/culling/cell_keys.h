// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Cells and portals as a sequence file lists them (layers/cells.h).

#include <string>
#include <vector>

#include "layers/cells.h"
#include "sequences/content/key_table.h"

namespace talisman::sequences {

struct CellRecipe {
  layers::Cell cell;
  std::string file;  ///< and line: where it is written
  int line = 0;
};

struct PortalRecipe {
  std::string from, to;  ///< names of cells
  std::vector<layers::dvec3> corners;
  std::string file;
  int line = 0;
};

const Table<CellRecipe>& cell_keys();
const Table<PortalRecipe>& portal_keys();

/// Adds what is listed to `set`. Throws InputError for what has a defect, with its line.
void add_cells(const std::vector<CellRecipe>& cells, const std::vector<PortalRecipe>& portals,
               layers::CellSet& set);

}  // namespace talisman::sequences
