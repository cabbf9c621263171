// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/ground.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "sequences/content/ground_texture.h"
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

/// Rows of samples that a segment's mesh covers.
struct Rows {
  int first, last;
};

Rows rows_of(const layers::Mesh& mesh, const layers::HeightField& field) {
  const auto row = [&](const layers::vec2& uv) {
    return static_cast<int>(std::lround(uv.y * (field.rows - 1)));
  };
  return {row(mesh.uvs.front()), row(mesh.uvs.back())};
}

/// Texture coordinates over the segment's own texture instead of over the whole field.
void remap(layers::Mesh& mesh, const layers::HeightField& field, Rows rows) {
  const float columns = static_cast<float>(field.columns - 1 + 2 * kTextureMargin);
  const float length = static_cast<float>(rows.last - rows.first + 2 * kTextureMargin);
  for (layers::vec2& uv : mesh.uvs) {
    uv.x = (uv.x * static_cast<float>(field.columns - 1) + kTextureMargin) / columns;
    uv.y = (uv.y * static_cast<float>(field.rows - 1) - static_cast<float>(rows.first - kTextureMargin)) /
           length;
  }
}

layers::Texture bake_segment(const GroundPainter& painter, const TerrainContent& content,
                             const layers::HeightField& field, Rows rows) {
  GroundWindow window;
  window.first_column = -kTextureMargin;
  window.first_row = rows.first - kTextureMargin;
  window.columns = field.columns - 1 + 2 * kTextureMargin;
  window.rows = rows.last - rows.first + 2 * kTextureMargin;
  return painter.bake(window, content.texels_per_cell);
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
  layers::TerrainOptions options;
  options.cells_per_segment = (field.rows - 2) / content.segments + 1;
  options.seam_cells = content.seam_cells;
  const GroundPainter painter(content, field);
  int k = 0;
  for (layers::Mesh& mesh : layers::terrain_segments(field, options)) {
    mesh.name = content.name + "/" + std::to_string(k++);
    const Rows rows = rows_of(mesh, field);
    remap(mesh, field, rows);
    layers::Material material;
    material.name = mesh.name;
    if (painter.has_textures()) {
      material.base_color = layers::vec3(1);
      material.texture = static_cast<int>(scene.textures.size());
      scene.textures.push_back(bake_segment(painter, content, field, rows));
      scene.textures.back().name = mesh.name;
    }
    scene.parts.push_back({mesh.name, node, static_cast<int>(scene.meshes.size()),
                           static_cast<int>(scene.materials.size()), -1});
    scene.materials.push_back(std::move(material));
    scene.meshes.push_back(std::move(mesh));
  }
}

}  // namespace talisman::sequences
