// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/ground_texture.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <tbb/parallel_for.h>

#include "sequences/import/texture_io.h"

namespace talisman::sequences {

namespace {

constexpr double kSlowScale = 7.3;  // the copy of a tile that varies the brightness is so many times larger;
                                    // not a whole number, so that the two never fall into step
constexpr float kSlowShare = 0.5f;  // how much of that variation is used

float mean_brightness(const TileImage& tile) {
  double sum = 0;
  for (const layers::vec3& texel : tile.texels) sum += brightness(texel);
  return std::max(1e-4f, static_cast<float>(sum / static_cast<double>(tile.texels.size())));
}

std::size_t nearest_class(const std::vector<GroundClass>& classes, const std::uint8_t* rgb) {
  const auto distance = [&](const GroundClass& c) {
    int sum = 0;
    for (int k = 0; k < 3; ++k) sum += (c.rgb[k] - rgb[k]) * (c.rgb[k] - rgb[k]);
    return sum;
  };
  const auto nearest = std::min_element(classes.begin(), classes.end(), [&](const auto& a, const auto& b) {
    return distance(a) < distance(b);
  });
  return static_cast<std::size_t>(nearest - classes.begin());
}

}  // namespace

GroundPainter::GroundPainter(const TerrainContent& content, const layers::HeightField& field)
    : columns_(field.columns), rows_(field.rows), cell_m_(content.cell_m), tile_m_(content.tile_m) {
  if (content.classes_file.empty() || content.classes.empty()) return;
  const layers::Texture map = read_texture(content.classes_file);
  if (map.width != columns_ || map.height - content.first_row != rows_)
    throw InputError("class image of " + std::to_string(map.width) + " × " + std::to_string(map.height) +
                         ", rule: as many pixels as the height map, " + std::to_string(columns_) + " × " +
                         std::to_string(rows_ + content.first_row),
                     content.classes_file);
  std::map<std::size_t, std::uint8_t> tile_of;  // class → index into tiles_
  const std::size_t first = 4 * static_cast<std::size_t>(content.first_row) * map.width;
  for (std::size_t i = first; i < map.rgba.size(); i += 4) {
    const std::size_t found = nearest_class(content.classes, &map.rgba[i]);
    const auto [entry, is_new] = tile_of.emplace(found, static_cast<std::uint8_t>(tiles_.size()));
    if (is_new) {
      TileImage tile = linear_tile(read_texture(content.classes[found].texture_file));
      const float mean = mean_brightness(tile);
      tiles_.push_back({reduced_tile(std::move(tile), tile_m_, cell_m_ / content.texels_per_cell), mean});
    }
    classes_.push_back(entry->second);
  }
}

int GroundPainter::class_at(int column, int row) const {
  const int c = std::clamp(column, 0, columns_ - 1), r = std::clamp(row, 0, rows_ - 1);
  return classes_[static_cast<std::size_t>(r) * columns_ + c];
}

layers::vec3 GroundPainter::tile_color(const Tile& tile, double x_m, double z_m) const {
  const layers::vec3 near = tile.image(x_m / tile_m_, z_m / tile_m_);
  const layers::vec3 slow = tile.image(x_m / (kSlowScale * tile_m_), z_m / (kSlowScale * tile_m_));
  return near * (1 - kSlowShare + kSlowShare * brightness(slow) / tile.mean_brightness);
}

layers::vec3 GroundPainter::color_at(double column, double row) const {
  const int c = static_cast<int>(std::floor(column)), r = static_cast<int>(std::floor(row));
  const float fc = static_cast<float>(column - c), fr = static_cast<float>(row - r);
  const int corner[4] = {class_at(c, r), class_at(c + 1, r), class_at(c, r + 1), class_at(c + 1, r + 1)};
  const float weight[4] = {(1 - fc) * (1 - fr), fc * (1 - fr), (1 - fc) * fr, fc * fr};
  layers::vec3 sum(0);
  for (int k = 0; k < 4; ++k) {
    float total = weight[k];  // a class that lies at several corners is looked up once, at the first of them
    bool seen = false;
    for (int j = 0; j < 4; ++j)
      if (j != k && corner[j] == corner[k]) j < k ? void(seen = true) : void(total += weight[j]);
    if (!seen) sum += total * tile_color(tiles_[corner[k]], column * cell_m_, row * cell_m_);
  }
  return sum;
}

layers::Texture GroundPainter::bake(const GroundWindow& window, int texels_per_cell) const {
  layers::Texture texture;
  texture.width = window.columns * texels_per_cell;
  texture.height = window.rows * texels_per_cell;
  texture.rgba.resize(4 * static_cast<std::size_t>(texture.width) * texture.height);
  tbb::parallel_for(0, texture.height, [&](int y) {
    std::uint8_t* out = &texture.rgba[4 * static_cast<std::size_t>(y) * texture.width];
    const double row = window.first_row + (y + 0.5) / texels_per_cell;
    for (int x = 0; x < texture.width; ++x, out += 4) {
      const layers::vec3 color = color_at(window.first_column + (x + 0.5) / texels_per_cell, row);
      for (int k = 0; k < 3; ++k) out[k] = srgb_byte(color[k]);
      out[3] = 255;
    }
  });
  return texture;
}

}  // namespace talisman::sequences
