// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/surfaces/ply_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "sequences/files/quoted.h"
#include "sequences/import/ear_clipping.h"
#include "sequences/import/lower_case.h"
#include "sequences/import/surfaces/bare_surface.h"
#include "sequences/import/surfaces/ply_file.h"
#include "sequences/pictures/srgb.h"

namespace talisman::sequences {

namespace {

using layers::dvec3;
using layers::vec2;
using layers::vec3;

/// The properties of a colour in an element; those of -1 are not there.
struct PlyColor {
  explicit PlyColor(const PlyElement& element)
      : element_(element),
        parts_{element.property({"red", "diffuse_red", "r"}),
               element.property({"green", "diffuse_green", "g"}),
               element.property({"blue", "diffuse_blue", "b"})},
        alpha_(element.property({"alpha", "diffuse_alpha", "a"})) {}
  bool is_there() const { return parts_[0] >= 0 && parts_[1] >= 0 && parts_[2] >= 0; }
  bool has_alpha() const { return is_there() && alpha_ >= 0; }
  vec3 linear(const PlyItems& item) const {
    vec3 color;
    for (int k = 0; k < 3; ++k)
      color[k] = linear_from_srgb(std::max(0.0f, share(item, parts_[static_cast<std::size_t>(k)])));
    return color;
  }
  float alpha(const PlyItems& item) const { return std::clamp(share(item, alpha_), 0.0f, 1.0f); }

 private:
  float share(const PlyItems& item, int property) const {
    const PlyType type = element_.properties[static_cast<std::size_t>(property)].type;
    const double most = type == PlyType::Float || type == PlyType::Double   ? 1
                        : type == PlyType::Int16 || type == PlyType::Uint16 ? 65535
                                                                            : 255;
    const auto value = static_cast<float>(item.value(property) / most);
    return std::isfinite(value) ? value : 0;
  }

  const PlyElement& element_;
  std::array<int, 3> parts_;
  int alpha_;
};

class PlyScene {
 public:
  PlyScene(const PlyFile& file, ImportedModel& model) : file_(file), model_(model) {
    const PlyElement* vertices = file.element("vertex");
    if (!vertices) throw InputError("cannot be read as a model: it has no element 'vertex'");
    read_vertices(*vertices);
    if (const PlyElement* faces = file.element("face")) read_faces(*faces);
    if (const PlyElement* strips = file.element("tristrips")) read_strips(*strips);
    if (out_.indices.empty() && !in_.positions.empty()) model.warnings.emplace_back("points are not drawn");
    name_what_is_left();
    settle_alpha();
  }
  BareSurface take() { return std::move(out_); }
  bool has_colors() const { return !out_.colors.empty(); }

 private:
  void read_vertices(const PlyElement& vertices) {
    const std::array<int, 3> place = {vertices.property({"x"}), vertices.property({"y"}),
                                      vertices.property({"z"})};
    const std::array<int, 3> normal = {vertices.property({"nx"}), vertices.property({"ny"}),
                                       vertices.property({"nz"})};
    const int u = vertices.property({"s", "u", "texture_u", "texcoord_u"}),
              v = vertices.property({"t", "v", "texture_v", "texcoord_v"});
    const PlyColor color(vertices);
    if (*std::min_element(place.begin(), place.end()) < 0)
      throw InputError("cannot be read as a model: its vertices have no x, y and z");
    const bool has_normals = *std::min_element(normal.begin(), normal.end()) >= 0;
    for (PlyItems item(vertices); item.next();) {
      in_.positions.emplace_back(item.value(place[0]), item.value(place[1]), item.value(place[2]));
      if (has_normals)
        in_.normals.emplace_back(item.value(normal[0]), item.value(normal[1]), item.value(normal[2]));
      if (u >= 0 && v >= 0) in_.uvs.emplace_back(item.value(u), 1 - item.value(v));
      if (color.is_there()) in_.colors.push_back(color.linear(item));
      if (color.has_alpha()) in_.alphas.push_back(color.alpha(item));
    }
  }

  /// Faces that have something of their own do not share vertices.
  void read_faces(const PlyElement& faces) {
    const int corners = faces.property({"vertex_indices", "vertex_index"});
    if (corners < 0 || !faces.properties[static_cast<std::size_t>(corners)].is_list) {
      if (faces.count > 0)
        throw InputError("cannot be read as a model: its faces have no list 'vertex_indices'");
      return;
    }
    const int uvs = faces.property({"texcoord"});
    const PlyColor color(faces);
    const bool apart = uvs >= 0 || color.is_there();
    if (!apart) begin_shared();
    std::size_t number = 0;
    std::vector<dvec3> places;
    for (PlyItems item(faces); item.next(); ++number) {
      const std::size_t n = item.length(corners);
      places.clear();
      for (std::size_t k = 0; k < n; ++k)
        places.push_back(in_.positions[vertex(item.entry(corners, k), "face", number)]);
      for (const std::array<int, 3>& triangle : triangulated(places))
        for (const int corner : triangle) {
          const auto k = static_cast<std::size_t>(corner);
          const std::size_t from = vertex(item.entry(corners, k), "face", number);
          if (!apart) {
            out_.indices.push_back(static_cast<std::uint32_t>(from));
            continue;
          }
          copy_vertex(from);
          if (uvs >= 0) set_coordinates(item, uvs, k, n);
          if (color.is_there()) set_color(color, item);
        }
    }
  }

  void read_strips(const PlyElement& strips) {
    const int corners = strips.property({"vertex_indices", "vertex_index"});
    if (corners < 0) return;
    if (out_.positions.empty()) begin_shared();
    std::size_t number = 0;
    for (PlyItems item(strips); item.next(); ++number) {
      std::vector<std::uint32_t> run;
      for (std::size_t k = 0; k < item.length(corners); ++k) {
        const double index = item.entry(corners, k);
        if (index < 0) {
          run.clear();
          continue;
        }
        run.push_back(static_cast<std::uint32_t>(vertex(index, "tristrips", number)));
        const std::size_t m = run.size();
        if (m < 3) continue;
        const bool odd = m % 2 == 0;  // every second triangle is turned
        out_.indices.insert(out_.indices.end(),
                            {run[m - 3], run[odd ? m - 1 : m - 2], run[odd ? m - 2 : m - 1]});
      }
    }
  }

  void begin_shared() { out_ = in_; }

  std::size_t vertex(double index, const char* element, std::size_t item) const {
    if (index >= 0 && index < static_cast<double>(in_.positions.size()))
      return static_cast<std::size_t>(index);
    throw InputError("cannot be read as a model: " + std::string(element) + " " + std::to_string(item) +
                     " names vertex " + std::to_string(static_cast<long long>(index)) +
                     ", rule: from 0, below " + std::to_string(in_.positions.size()));
  }

  void copy_vertex(std::size_t from) {
    out_.indices.push_back(static_cast<std::uint32_t>(out_.positions.size()));
    out_.positions.push_back(in_.positions[from]);
    if (!in_.normals.empty()) out_.normals.push_back(in_.normals[from]);
    if (!in_.uvs.empty()) out_.uvs.push_back(in_.uvs[from]);
    if (!in_.colors.empty()) out_.colors.push_back(in_.colors[from]);
    if (!in_.alphas.empty()) out_.alphas.push_back(in_.alphas[from]);
  }

  void set_coordinates(const PlyItems& item, int uvs, std::size_t corner, std::size_t corners) {
    out_.uvs.resize(out_.positions.size(), vec2(0));
    if (item.length(uvs) == 2 * corners)
      out_.uvs.back() = {item.entry(uvs, 2 * corner), 1 - item.entry(uvs, 2 * corner + 1)};
  }

  void set_color(const PlyColor& color, const PlyItems& item) {
    out_.colors.resize(out_.positions.size(), vec3(1));
    out_.colors.back() = color.linear(item);
    if (!color.has_alpha()) return;
    out_.alphas.resize(out_.positions.size(), 1);
    out_.alphas.back() = color.alpha(item);
  }

  void name_what_is_left() {
    std::vector<std::string> names;
    for (const PlyElement& element : file_.elements) {
      if (element.count == 0 || element.name == "vertex" || element.name == "face" ||
          element.name == "tristrips")
        continue;
      if (element.name == "edge")
        model_.warnings.emplace_back("lines are not drawn");
      else
        names.push_back(element.name);
    }
    if (!names.empty())
      model_.warnings.push_back(std::string(names.size() == 1 ? "element " : "elements ") + quoted(names) +
                                (names.size() == 1 ? " is" : " are") + " not drawn");
  }

  void settle_alpha() {
    std::vector<float>& alphas = out_.alphas;
    if (alphas.empty()) return;
    const auto [least, most] = std::minmax_element(alphas.begin(), alphas.end());
    if (*most == 0) model_.warnings.emplace_back("every vertex is clear (alpha 0): alpha is left out");
    if (*most == 0 || *least == 1) alphas.clear();
  }

  const PlyFile& file_;
  ImportedModel& model_;
  BareSurface in_, out_;
};

}  // namespace

bool is_ply(const std::string& path) { return lower_extension(path) == ".ply"; }

ImportedModel read_ply(const ModelPlace& place) {
  FileUses files;
  files.add_code();
  files.look_for(place.path);
  const PlyFile file = read_ply_file(place.path);
  ImportedModel model;
  PlyScene scene(file, model);
  layers::Material look = bare_look();
  if (!file.pictures.empty()) {
    try {
      layers::Texture picture = read_named_texture(place, file.pictures[0], files);
      if (std::string loss = without_empty_alpha(picture); !loss.empty()) model.warnings.push_back(loss);
      model.scene.textures.push_back(std::move(picture));
      look.texture = 0;
    } catch (const InputError& e) {
      model.warnings.push_back(missing_texture(file.pictures[0], e.what()));
    }
    if (file.pictures.size() > 1)
      model.warnings.push_back("of " + std::to_string(file.pictures.size()) +
                               " pictures only the first is drawn");
  }
  if (scene.has_colors() || look.texture >= 0) look.base_color = vec3(1);
  add_surfaces(place, {scene.take()}, look, model.scene);
  model.files = files.take();
  return model;
}

}  // namespace talisman::sequences
