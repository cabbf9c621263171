// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/surfaces/obj_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numeric>

#include <glm/geometric.hpp>

#include "sequences/import/ear_clipping.h"
#include "sequences/import/lower_case.h"
#include "sequences/import/surfaces/bare_surface.h"
#include "sequences/import/surfaces/obj_faults.h"
#include "sequences/import/surfaces/obj_libraries.h"
#include "sequences/import/surfaces/obj_meshes.h"
#include "sequences/import/surfaces/obj_text.h"
#include "sequences/import/wide_text.h"

namespace talisman::sequences {

namespace {

using layers::dvec3;

constexpr const char* kNoName = "defaultobject";

/// What the geometry's reader does not say, and what only materials need.
struct ObjWords {
  std::vector<std::string> libraries;  ///< what is behind each "mtllib"
  std::vector<std::string> materials;  ///< in the order of their first use
  std::map<std::string, int> id_of;    ///< by the name as ObjText has it
  bool has_smoothing = false;          ///< it says somewhere what is smooth, or that nothing is
  std::vector<bool> has_color;         ///< by vertex; empty: none has one
  std::vector<std::string> losses;     ///< what it has and the picture has not
  std::map<std::size_t, std::size_t>
      large_faces;  ///< corners of those that have more than the reader can count
};

constexpr std::size_t kMostCounted = 255;

/// Corners of the face whose line goes on at `at`, counted up to `most`.
std::size_t corners_of(const std::string& line, std::size_t at, std::size_t most) {
  std::size_t corners = 0;
  while (corners < most && (at = line.find_first_not_of(" \t\r", at)) != std::string::npos) {
    ++corners;
    at = line.find_first_of(" \t\r", at);
  }
  return corners;
}

/// `faces` are those with three corners or more, as the geometry's reader numbers them.
void count_face(const std::string& line, std::size_t at, std::size_t& faces, ObjWords& words) {
  if (corners_of(line, at, 3) < 3) return;
  const bool may_be_large = line.size() - at > 2 * kMostCounted;
  const std::size_t corners = may_be_large ? corners_of(line, at, line.size()) : 0;
  if (corners > kMostCounted) words.large_faces.emplace(faces, corners);
  ++faces;
}

/// The geometry's reader takes what is no number for 0.
void check_numbers(const std::string& path, const std::string& line) {
  if (line.find_first_of("nNiI", line.find_first_of(" \t")) == std::string::npos) return;
  if (line.find_first_of(" \t") != std::string::npos)
    throw InputError(line_of(path, line) + "a mesh has '" + line.substr(0, 60) + "', rule: finite numbers");
}

/// x y z, perhaps a weight, and three of colour.
bool is_colored(const std::string& line, std::size_t at) {
  constexpr std::size_t kOfPlaceAndColor = 6;
  return corners_of(line, at, kOfPlaceAndColor) == kOfPlaceAndColor;
}

/// Free-form geometry.
bool is_curve(const std::string& line, std::size_t at) {
  const std::string word = line.substr(at, std::min(line.find_first_of(" \t", at), line.size()) - at);
  return word == "vp" || word == "curv" || word == "curv2" || word == "surf";
}

ObjWords words_of(const std::string& path) {
  ObjWords words;
  ObjText text(open_text(path));
  std::istream in(&text);
  std::size_t faces = 0, vertices = 0;
  bool has_curves = false;
  for (std::string line; std::getline(in, line);) {
    const std::size_t at = line.find_first_not_of(" \t");
    if (at == std::string::npos) continue;
    if (line[at] == 'v') check_numbers(path, line);
    if (line[at] == 'v' && (line[at + 1] == ' ' || line[at + 1] == '\t')) {
      if (is_colored(line, at + 1)) words.has_color.resize(vertices + 1), words.has_color[vertices] = true;
      ++vertices;
    }
    if (line[at] == 'f') count_face(line, at + 1, faces, words);
    if (line[at] == 's' && line.find_first_of(" \t", at) == at + 1) words.has_smoothing = true;
    if (line[at] != 'f' && !has_curves) has_curves = is_curve(line, at);
    if (line[at] != 'm' && line[at] != 'u') continue;
    if (line.compare(at, 6, "mtllib") == 0) words.libraries.push_back(rest_of_line(line, at + 6));
    if (line.compare(at, 6, "usemtl") != 0) continue;
    std::string name = rest_of_line(line, at + 6);
    if (!words.id_of.emplace(name, static_cast<int>(words.materials.size())).second) continue;
    std::replace(name.begin(), name.end(), kKeptSpace, ' ');
    words.materials.push_back(name);
  }
  if (!words.has_color.empty()) words.has_color.resize(vertices);
  if (has_curves) words.losses.emplace_back("curves and surfaces are not drawn");
  return words;
}

/// Gives every material that is used its number, whatever its library says. It is asked at the first "mtllib", which
/// therefore is put before all else.
class NumberMaterials : public tinyobj::MaterialReader {
 public:
  explicit NumberMaterials(const ObjWords& words) : words_(words) {}
  bool operator()(const std::string&, std::vector<tinyobj::material_t>*, std::map<std::string, int>* ids,
                  std::string*, std::string*) override {
    *ids = words_.id_of;
    return true;
  }

 private:
  const ObjWords& words_;
};

[[noreturn]] void refuse_faces(const std::string& path, const std::string& otherwise) {
  const std::string face = bad_face(path);
  throw InputError("cannot be read as a model: " + (face.empty() ? otherwise : face));
}

void check_corners(const std::string& path, const ObjContent& content) {
  const auto count = static_cast<int>(content.attributes.vertices.size() / 3);
  for (const tinyobj::shape_t& shape : content.shapes)
    for (const tinyobj::index_t& corner : shape.mesh.indices)
      if (corner.vertex_index < 0 || corner.vertex_index >= count)
        refuse_faces(path, "a face names vertex " + std::to_string(corner.vertex_index + 1) +
                               ", rule: from 1 to " + std::to_string(count));
}

/// Corners of each face of a shape, whose first is the `face`th of the file.
std::vector<std::size_t> corner_counts(const tinyobj::mesh_t& polygons, std::size_t face,
                                       const ObjWords& words) {
  std::vector<std::size_t> counts(polygons.num_face_vertices.begin(), polygons.num_face_vertices.end());
  for (auto large = words.large_faces.lower_bound(face); large != words.large_faces.end(); ++large)
    if (large->first - face < counts.size()) counts[large->first - face] = large->second;
  if (std::accumulate(counts.begin(), counts.end(), std::size_t{0}) != polygons.indices.size())
    throw InputError("cannot be read as a model: the corners of its faces cannot be told apart");
  return counts;
}

/// Polygons cut.
tinyobj::mesh_t in_triangles(tinyobj::mesh_t polygons, const std::vector<std::size_t>& counts,
                             const tinyobj::attrib_t& attributes) {
  if (std::all_of(counts.begin(), counts.end(), [](std::size_t n) { return n == 3; })) return polygons;
  tinyobj::mesh_t mesh;
  mesh.indices.reserve(polygons.indices.size());
  std::vector<dvec3> places;
  std::size_t first = 0;
  for (std::size_t f = 0; f < counts.size(); ++f) {
    const tinyobj::index_t* corners = &polygons.indices[first];
    first += counts[f];
    places.clear();
    for (std::size_t k = 0; k < counts[f]; ++k)
      places.push_back(place_of(attributes, corners[k].vertex_index));
    for (const std::array<int, 3>& triangle : triangulated(places)) {
      for (const int k : triangle) mesh.indices.push_back(corners[k]);
      mesh.material_ids.push_back(polygons.material_ids[f]);
      mesh.smoothing_group_ids.push_back(polygons.smoothing_group_ids[f]);
    }
  }
  return mesh;
}

ObjContent content_of(const std::string& path, const ObjWords& words) {
  ObjContent content;
  auto file = open_text(path);
  if (!*file) throw InputError("cannot be opened");
  ObjText text(std::move(file), "mtllib -");
  std::istream in(&text);
  NumberMaterials numbers(words);
  std::vector<tinyobj::material_t> unused;
  std::string warning, error;
  if (!tinyobj::LoadObj(&content.attributes, &content.shapes, &unused, &warning, &error, &in, &numbers, false,
                        !words.has_color.empty()))
    refuse_faces(path, error.substr(0, error.find('\n')));
  check_corners(path, content);
  content.has_groups = words.has_smoothing;
  content.has_color = words.has_color;
  std::size_t face = 0;
  for (tinyobj::shape_t& shape : content.shapes) {
    const std::vector<std::size_t> counts = corner_counts(shape.mesh, face, words);
    face += counts.size();
    shape.mesh = in_triangles(std::move(shape.mesh), counts, content.attributes);
  }
  return content;
}

/// The looks of `words.materials`, and last of what has none.
class Looks {
 public:
  Looks(ImportedModel& model, const ModelPlace& place, const ObjWords& words, bool has_colors,
        FileUses& files)
      : model_(model), place_(place), files_(files) {
    const ObjLibraries libraries(place, words.libraries, files);
    model.warnings.insert(model.warnings.end(), libraries.missing().begin(), libraries.missing().end());
    if (const std::string unknown = libraries.unknown(words.materials); !unknown.empty())
      model.warnings.push_back(unknown);
    for (const std::string& name : words.materials) {
      const ObjMaterial* found = libraries.find(name);
      ObjMaterial material = found ? *found : default_obj_material();
      material.look.name = name;
      add(material);
    }
    ObjMaterial none = default_obj_material();
    if (has_colors) none.look.base_color = layers::vec3(1);  // those of the vertices are meant alone
    add(none);
  }
  /// -1: the last.
  int number(int id) const { return id < 0 ? static_cast<int>(placings_.size()) - 1 : id; }
  const MapPlacing& placing(int id) const { return placings_[static_cast<std::size_t>(number(id))]; }

 private:
  void add(const ObjMaterial& from) {
    layers::Material look = from.look;
    if (!from.map.empty()) look.texture = texture(from.map, from.placing.clamped);
    model_.scene.materials.push_back(look);
    placings_.push_back(from.placing);
    for (const std::string& loss : from.losses)
      if (std::find(model_.warnings.begin(), model_.warnings.end(), loss) == model_.warnings.end())
        model_.warnings.push_back(loss);
  }

  int texture(const std::string& written, bool clamped) {
    const auto [entry, is_new] = texture_of_.emplace(std::pair(written, clamped), -1);
    if (!is_new) return entry->second;
    try {
      layers::Texture texture = read_named_texture(place_, written, files_);
      if (std::string loss = without_empty_alpha(texture); !loss.empty()) model_.warnings.push_back(loss);
      if (clamped) texture.wrap_u = texture.wrap_v = layers::Wrap::Clamp;
      model_.scene.textures.push_back(std::move(texture));
      entry->second = static_cast<int>(model_.scene.textures.size()) - 1;
    } catch (const InputError& e) {
      model_.warnings.push_back(missing_texture(written, e.what()));
    }
    return entry->second;
  }

  ImportedModel& model_;
  const ModelPlace& place_;
  FileUses& files_;
  std::vector<MapPlacing> placings_;
  std::map<std::pair<std::string, bool>, int> texture_of_;
};

/// The middle of all vertices, where they lie far from the file's origin; else zero.
dvec3 origin_of(const ObjContent& content) {
  dvec3 lo(HUGE_VAL), hi(-HUGE_VAL);
  const int count = static_cast<int>(content.attributes.vertices.size() / 3);
  for (int i = 0; i < count; ++i) {
    const dvec3 p = place_of(content.attributes, i);
    lo = glm::min(lo, p), hi = glm::max(hi, p);
  }
  return local_origin(lo, hi);
}

void add_shape(layers::Scene& scene, const tinyobj::shape_t& shape, const Looks& looks, int root,
               MeshBuilder& builder) {
  std::vector<int> used = shape.mesh.material_ids;
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  if (used.empty()) return;
  const std::string name = shape.name.empty() ? kNoName : shape.name;
  const std::string path = scene.nodes[static_cast<std::size_t>(root)].name + "/" + name;
  scene.nodes.push_back({name, root, {}});
  for (std::size_t k = 0; k < used.size(); ++k) {
    layers::Part part;
    part.name = used.size() > 1 ? path + "#" + std::to_string(k) : path;
    part.node = static_cast<int>(scene.nodes.size()) - 1;
    part.mesh = static_cast<int>(scene.meshes.size());
    part.material = looks.number(used[k]);
    scene.meshes.push_back(builder.mesh_of(shape.mesh, used[k], looks.placing(used[k])));
    scene.meshes.back().name = name;
    scene.parts.push_back(part);
  }
}

void warn_of_losses(const ObjContent& content, ImportedModel& model) {
  bool lines = false, points = false;
  for (const tinyobj::shape_t& shape : content.shapes)
    lines |= !shape.lines.indices.empty(), points |= !shape.points.indices.empty();
  if (lines) model.warnings.push_back("lines are not drawn");
  if (points) model.warnings.push_back("points are not drawn");
}

}  // namespace

bool is_obj(const std::string& path) { return lower_extension(path) == ".obj"; }

ImportedModel read_obj(const ModelPlace& place) {
  FileUses files;
  files.add_code();
  files.look_for(place.path);
  const ObjWords words = words_of(place.path);
  const ObjContent content = content_of(place.path, words);
  ImportedModel model;
  warn_of_losses(content, model);
  model.warnings.insert(model.warnings.end(), words.losses.begin(), words.losses.end());
  const Looks looks(model, place, words, !content.has_color.empty(), files);
  const std::filesystem::path file(place.path);
  const dvec3 origin = origin_of(content);
  layers::Scene& scene = model.scene;
  if (origin != dvec3(0)) scene.nodes.push_back({file.stem().string(), -1, {origin}});
  scene.nodes.push_back({file.filename().string(), static_cast<int>(scene.nodes.size()) - 1, {}});
  MeshBuilder builder(content, origin);
  const int root = static_cast<int>(scene.nodes.size()) - 1;
  for (const tinyobj::shape_t& shape : content.shapes) add_shape(scene, shape, looks, root, builder);
  if (scene.parts.empty()) throw InputError("has no triangles, rule: a model has at least one");
  for (const std::string& loss : builder.losses()) model.warnings.push_back(loss);
  model.files = files.take();
  return model;
}

}  // namespace talisman::sequences
