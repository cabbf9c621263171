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

/// From central differences of the whole field (one-sided at its rim): n ∝ (−∂h/∂x, 1, −∂h/∂z), where z =
/// −row · cell.
vec3 normal(const HeightField& field, int column, int row) {
  const int left = std::max(column - 1, 0), right = std::min(column + 1, field.columns - 1);
  const int near = std::max(row - 1, 0), far = std::min(row + 1, field.rows - 1);
  const double slope_x =
      (height(field, right, row) - height(field, left, row)) / ((right - left) * double{field.cell_x_m});
  const double slope_z =
      (height(field, column, near) - height(field, column, far)) / ((far - near) * double{field.cell_z_m});
  return vec3(glm::normalize(dvec3{-slope_x, 1, -slope_z}));
}

void add_vertex(const HeightField& field, int column, int row, Mesh& mesh) {
  mesh.positions.push_back(position(field, column, row));
  mesh.normals.push_back(normal(field, column, row));
  mesh.uvs.push_back({static_cast<float>(column) / static_cast<float>(field.columns - 1),
                      static_cast<float>(row) / static_cast<float>(field.rows - 1)});
}

/// The vertices of rows first_row … last_row (both included) and the cells between them.
Mesh segment(const HeightField& field, int first_row, int last_row) {
  Mesh mesh;
  for (int row = first_row; row <= last_row; ++row)
    for (int column = 0; column < field.columns; ++column) add_vertex(field, column, row, mesh);
  const auto stride = static_cast<std::uint32_t>(field.columns);
  for (std::uint32_t row = 0; row < static_cast<std::uint32_t>(last_row - first_row); ++row)
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
  const int cells = field.rows - 1;
  const int count = (cells - 1) / options.cells_per_segment + 1;
  const auto border = [&](int k) { return static_cast<int>(std::int64_t{cells} * k / count); };
  std::vector<Mesh> segments;
  for (int k = 0; k < count; ++k) {
    const int last_row =
        k + 1 < count ? border(k + 1) + std::min(options.seam_cells, cells - border(k + 1)) : cells;
    segments.push_back(segment(field, border(k), last_row));
    segments.back().name = "terrain_" + std::to_string(k);
  }
  return segments;
}

}  // namespace talisman::layers
