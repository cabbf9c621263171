// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/ground.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "sequences/content/painted_ground.h"
#include "sequences/import/texture_io.h"

namespace talisman::sequences {

namespace {

constexpr int kTextureMargin = 2;  // cells by which a baked texture reaches over its segment

/// Weights of a Gaussian, from its centre outwards, normalised over both sides.
std::vector<double> half_gaussian(double sigma) {
  const int reach = static_cast<int>(std::ceil(3 * sigma));
  std::vector<double> weights(reach + 1);
  double sum = 0;
  for (int i = 0; i <= reach; ++i) {
    weights[i] = sigma > 0 ? std::exp(-0.5 * i * i / (sigma * sigma)) : 1;
    sum += i == 0 ? weights[i] : 2 * weights[i];
  }
  for (double& w : weights) w /= sum;
  return weights;
}

/// One pass of the separable filter along x or y; beyond the border the border's value holds.
std::vector<double> smoothed(const std::vector<double>& in, int width, int height, bool along_x,
                             const std::vector<double>& weights) {
  std::vector<double> out(in.size());
  const int reach = static_cast<int>(weights.size()) - 1;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      double sum = 0;
      for (int k = -reach; k <= reach; ++k) {
        const int sx = along_x ? std::clamp(x + k, 0, width - 1) : x;
        const int sy = along_x ? y : std::clamp(y + k, 0, height - 1);
        sum += weights[std::abs(k)] * in[static_cast<std::size_t>(sy) * width + sx];
      }
      out[static_cast<std::size_t>(y) * width + x] = sum;
    }
  return out;
}

/// The value of `key` in one entry of the list: the words between "[key]" and the next "[".
std::string list_value(const std::string& entry, const std::string& key) {
  const std::size_t at = entry.find("[" + key + "]");
  if (at == std::string::npos) return {};
  const std::size_t begin = at + key.size() + 2;
  const std::size_t end = entry.find('[', begin);
  return entry.substr(begin, end == std::string::npos ? end : end - begin);
}

std::string first_word(const std::string& text) {
  std::istringstream in(text);
  std::string word;
  in >> word;
  return word;
}

/// Samples that a tile's mesh covers.
struct Tile {
  int first_row, last_row, first_column, last_column;
};

Tile tile_of(const layers::Mesh& mesh, const layers::HeightField& field) {
  const auto sample = [](float share, int samples) {
    return static_cast<int>(std::lround(share * static_cast<float>(samples - 1)));
  };
  const layers::vec2 first = mesh.uvs.front(), last = mesh.uvs.back();
  return {sample(first.y, field.rows), sample(last.y, field.rows), sample(first.x, field.columns),
          sample(last.x, field.columns)};
}

/// Texture coordinates over the tile's own texture instead of over the whole field.
void remap(layers::Mesh& mesh, const layers::HeightField& field, const GroundWindow& window) {
  for (layers::vec2& uv : mesh.uvs) {
    uv.x = (uv.x * static_cast<float>(field.columns - 1) - static_cast<float>(window.first_column)) /
           static_cast<float>(window.columns);
    uv.y = (uv.y * static_cast<float>(field.rows - 1) - static_cast<float>(window.first_row)) /
           static_cast<float>(window.rows);
  }
}

GroundWindow window_of(const Tile& tile) {
  GroundWindow window;
  window.first_column = tile.first_column - kTextureMargin;
  window.first_row = tile.first_row - kTextureMargin;
  window.columns = tile.last_column - tile.first_column + 2 * kTextureMargin;
  window.rows = tile.last_row - tile.first_row + 2 * kTextureMargin;
  return window;
}

/// How the sequence cuts it; never into more tiles than there are cells.
layers::TerrainOptions cut_of(const TerrainContent& content, const layers::HeightField& field) {
  const auto cells = [&](int samples) { return (samples - 2) / content.every + 1; };
  layers::TerrainOptions options;
  options.every = content.every;
  options.cells_per_segment = (cells(field.rows) - 1) / content.segments + 1;
  options.seam_cells = content.seam_cells;
  options.across = std::min(content.across, cells(field.columns));
  return options;
}

}  // namespace

std::vector<GroundClass> read_ground_classes(const std::string& list_file) {
  std::ifstream in(list_file);
  if (!in) throw InputError("cannot be read", list_file);
  std::string text, line;
  while (std::getline(in, line)) text += line.substr(0, line.find('#')) + "\n";
  const auto folder = std::filesystem::path(list_file).parent_path();
  std::vector<GroundClass> classes;
  std::istringstream entries(text);
  for (std::string entry; std::getline(entries, entry, '*');) {
    const std::string texture = first_word(list_value(entry, "texture"));
    std::istringstream color(list_value(entry, "col"));
    GroundClass ground;
    if (texture.empty() || !(color >> ground.rgb[0] >> ground.rgb[1] >> ground.rgb[2])) continue;
    const auto file = folder / texture;
    ground.texture_file = file.has_extension() ? file.string() : file.string() + ".png";
    classes.push_back(ground);
  }
  if (classes.empty())
    throw InputError("lists no ground class, rule: entries with [texture] and [col]", list_file);
  return classes;
}

layers::HeightField read_height_field(const TerrainContent& content) {
  const layers::Texture grey = read_texture(content.heights_file);
  if (grey.width < 2 || grey.height - content.first_row < 2)
    throw InputError("height map of " + std::to_string(grey.width) + " × " + std::to_string(grey.height) +
                         " from row " + std::to_string(content.first_row) + ", rule: at least 2 × 2",
                     content.heights_file);
  std::vector<double> heights(static_cast<std::size_t>(grey.width) * grey.height);
  for (std::size_t i = 0; i < heights.size(); ++i)
    heights[i] = content.low_m + (content.high_m - content.low_m) * grey.rgba[4 * i] / 255.0;
  const std::vector<double> weights = half_gaussian(content.smooth_cells);
  for (const bool along_x : {true, false})
    heights = smoothed(heights, grey.width, grey.height, along_x, weights);
  layers::HeightField field;
  field.columns = grey.width;
  field.rows = grey.height - content.first_row;
  field.cell_x_m = field.cell_z_m = static_cast<float>(content.cell_m);
  const std::ptrdiff_t left_out = static_cast<std::ptrdiff_t>(content.first_row) * grey.width;
  field.heights_m.assign(heights.begin() + left_out, heights.end());
  return field;
}

double ground_height(const layers::HeightField& field, double x_m, double z_m) {
  const double column =
      std::clamp(x_m / field.cell_x_m + (field.columns - 1) / 2.0, 0.0, field.columns - 1.0);
  const double row = std::clamp(-z_m / field.cell_z_m, 0.0, field.rows - 1.0);
  const int c = std::min(static_cast<int>(column), field.columns - 2),
            r = std::min(static_cast<int>(row), field.rows - 2);
  const double fc = column - c, fr = row - r;
  const auto h = [&](int dc, int dr) {
    return double{field.heights_m[static_cast<std::size_t>(r + dr) * field.columns + c + dc]};
  };
  return (1 - fr) * ((1 - fc) * h(0, 0) + fc * h(1, 0)) + fr * ((1 - fc) * h(0, 1) + fc * h(1, 1));
}

void add_terrain(layers::Scene& scene, const TerrainContent& content) {
  const layers::HeightField field = read_height_field(content);
  const int node = static_cast<int>(scene.nodes.size());
  scene.nodes.push_back({content.name, -1, {}});
  std::vector<layers::Mesh> meshes = layers::terrain_segments(field, cut_of(content, field));
  std::vector<GroundWindow> windows;
  for (layers::Mesh& mesh : meshes) {
    mesh.name = content.name + "/" + std::to_string(windows.size());
    windows.push_back(window_of(tile_of(mesh, field)));
    remap(mesh, field, windows.back());
  }
  std::vector<layers::Texture> textures = painted_ground(content, field, windows);
  for (std::size_t k = 0; k < meshes.size(); ++k) {
    layers::Mesh& mesh = meshes[k];
    layers::Material material;
    material.name = mesh.name;
    if (!textures.empty()) {
      material.base_color = layers::vec3(1);
      material.texture = static_cast<int>(scene.textures.size());
      scene.textures.push_back(std::move(textures[k]));
      scene.textures.back().name = mesh.name;
    }
    scene.parts.push_back({mesh.name, node, static_cast<int>(scene.meshes.size()),
                           static_cast<int>(scene.materials.size()), -1});
    scene.materials.push_back(std::move(material));
    scene.meshes.push_back(std::move(mesh));
  }
}

}  // namespace talisman::sequences
