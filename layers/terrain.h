// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Height-map terrain, cut into segments [LS97 7.2: split landscape, expanded along the split].
///
/// A grid of heights becomes meshes of at most `cells_per_segment` rows each, of about equal size, and each of
/// these `across` tiles side by side. Each tile reaches over its far and its right border by `seam_cells` cells,
/// so that small separations of the warped sprites do not open a crack. Grid column 0 … is x, row 0 … is -z
/// (rows run away from a viewer who looks along -z); both are centred in x and start at z = 0. Vertices that two
/// tiles share are bit-identical. A coarser mesh has a vertex at each `every`-th sample, and at the rim.

#include <vector>

#include "layers/scene.h"

namespace talisman::layers {

struct HeightField {
  int columns = 0, rows = 0;         ///< samples, ≥ 2 each
  std::vector<float> heights_m;      ///< row by row
  float cell_x_m = 1, cell_z_m = 1;  ///< distance of samples
};

struct TerrainOptions {
  int cells_per_segment = 100;  ///< rows of the mesh's cells per segment, ≥ 1
  int seam_cells = 1;  ///< cells by which neighbours overlap, ≥ 0; hides cracks of about that size, costs
                       ///< 2 · columns polygons per row and inner border
  int across = 1;      ///< 1 … columns of cells; tiles side by side in each segment
  int every = 1;       ///< ≥ 1; samples between vertices; polygons fall with its square
};

/// One mesh per tile ("terrain_0", the nearest at the left, then those to its right, …): positions, smooth normals (computed on the whole grid,
/// so that seams do not show in the shading), uvs in 0 … 1 over the whole field (u along x, v along -z, v = 0
/// at row 0). Triangles face up.
std::vector<Mesh> terrain_segments(const HeightField& field, const TerrainOptions& options);

}  // namespace talisman::layers
