// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What colour is the ground at a place? The tile textures of the classes, mixed by how much of each class is
/// near.

#include <vector>

#include "sequences/content/ground.h"
#include "sequences/content/tile_image.h"
#include "sequences/pictures/srgb.h"

namespace talisman::sequences {

/// A rectangle of cells of the height field; it may reach over the field's border, where the border's class
/// goes on.
struct GroundWindow {
  int first_column = 0, first_row = 0, columns = 0, rows = 0;
};

class GroundPainter {
 public:
  /// Reads the class image and the textures of the classes that occur in it. Throws InputError.
  GroundPainter(const TerrainContent& content, const layers::HeightField& field);

  bool has_textures() const { return !tiles_.empty(); }
  /// An opaque sRGB texture of texels_per_cell² texels per cell. Rows are independent jobs; the bytes do not
  /// depend on how many threads there are.
  layers::Texture bake(const GroundWindow& window, int texels_per_cell) const;

 private:
  layers::vec3 color_at(double column, double row) const;
  struct Tile {
    TileImage image;
    float mean_brightness;
  };
  layers::vec3 tile_color(const Tile& tile, double x_m, double z_m) const;
  int class_at(int column, int row) const;

  std::vector<Tile> tiles_;            // of the classes that occur
  std::vector<std::uint8_t> classes_;  // index into tiles_, per sample
  int columns_ = 0, rows_ = 0;
  double cell_m_ = 1, tile_m_ = 1;
};

}  // namespace talisman::sequences
