// SPDX-License-Identifier: Apache-2.0
#include "layers/terrain.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <glm/geometric.hpp>

#include "layers/check.h"

namespace talisman::layers {

namespace {

double height(const HeightField& field, int column, int row) {
  return field.heights_m[static_cast<std::size_t>(row) * field.columns + column];
}

vec3 position(const HeightField& field, int column, int row) {
  const double x = (column - (field.columns - 1) / 2.0) * field.cell_x_m;
  return {static_cast<float>(x), static_cast<float>(height(field, column, row)),
          static_cast<float>(-static_cast<double>(row) * field.cell_z_m)};
}

/// From central differences of the whole field over `every` samples (one-sided at its rim): n ∝ (−∂h/∂x, 1,
/// −∂h/∂z), where z = −row · cell.
vec3 normal(const HeightField& field, int column, int row, int every) {
  const int left = std::max(column - every, 0), right = std::min(column + every, field.columns - 1);
  const int near = std::max(row - every, 0), far = std::min(row + every, field.rows - 1);
  const double slope_x =
      (height(field, right, row) - height(field, left, row)) / ((right - left) * double{field.cell_x_m});
  const double slope_z =
      (height(field, column, near) - height(field, column, far)) / ((far - near) * double{field.cell_z_m});
  return vec3(glm::normalize(dvec3{-slope_x, 1, -slope_z}));
}

void add_vertex(const HeightField& field, int column, int row, int every, Mesh& mesh) {
  mesh.positions.push_back(position(field, column, row));
  mesh.normals.push_back(normal(field, column, row, every));
  mesh.uvs.push_back({static_cast<float>(column) / static_cast<float>(field.columns - 1),
                      static_cast<float>(row) / static_cast<float>(field.rows - 1)});
}

/// Lines of the mesh, in samples: a range of one tile, both ends included.
using Lines = std::vector<int>;

/// The lines of each tile along one side of the field.
std::vector<Lines> cut(int samples, int tiles, int every, int seam_cells) {
  Lines all;
  for (int at = 0; at < samples - 1; at += every) all.push_back(at);
  all.push_back(samples - 1);
  const int cells = static_cast<int>(all.size()) - 1;
  const auto border = [&](int k) { return static_cast<int>(std::int64_t{cells} * k / tiles); };
  std::vector<Lines> cuts;
  for (int k = 0; k < tiles; ++k) {
    const int last = k + 1 < tiles ? border(k + 1) + std::min(seam_cells, cells - border(k + 1)) : cells;
    cuts.emplace_back(all.begin() + border(k), all.begin() + last + 1);
  }
  return cuts;
}

int cells_of(int samples, int every) { return (samples - 2) / every + 1; }

Mesh tile(const HeightField& field, const Lines& rows, const Lines& columns, int every) {
  Mesh mesh;
  for (const int row : rows)
    for (const int column : columns) add_vertex(field, column, row, every, mesh);
  const auto stride = static_cast<std::uint32_t>(columns.size());
  for (std::uint32_t row = 0; row + 1 < rows.size(); ++row)
    for (std::uint32_t column = 0; column + 1 < stride; ++column) {
      const std::uint32_t near = row * stride + column, far = near + stride;
      mesh.indices.insert(mesh.indices.end(), {near, near + 1, far + 1, near, far + 1, far});
    }
  return mesh;
}

}  // namespace

std::vector<Mesh> terrain_segments(const HeightField& field, const TerrainOptions& options) {
  TALISMAN_CHECK_GE(field.columns, 2);
  TALISMAN_CHECK_GE(field.rows, 2);
  TALISMAN_CHECK_EQ(field.heights_m.size(), static_cast<std::size_t>(field.columns) * field.rows);
  TALISMAN_CHECK(field.cell_x_m > 0 && field.cell_z_m > 0);
  TALISMAN_CHECK_GE(options.cells_per_segment, 1);
  TALISMAN_CHECK_GE(options.seam_cells, 0);
  TALISMAN_CHECK_GE(options.every, 1);
  const int count = (cells_of(field.rows, options.every) - 1) / options.cells_per_segment + 1;
  TALISMAN_CHECK(options.across >= 1 && options.across <= cells_of(field.columns, options.every));
  std::vector<Mesh> segments;
  for (const Lines& rows : cut(field.rows, count, options.every, options.seam_cells))
    for (const Lines& columns : cut(field.columns, options.across, options.every, options.seam_cells)) {
      segments.push_back(tile(field, rows, columns, options.every));
      segments.back().name = "terrain_" + std::to_string(segments.size() - 1);
    }
  return segments;
}

}  // namespace talisman::layers
