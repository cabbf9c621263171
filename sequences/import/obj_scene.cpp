// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/obj_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <numeric>
#include <optional>
#include <unordered_map>

#include <glm/geometric.hpp>

#define TINYOBJLOADER_USE_DOUBLE
#include <tiny_obj_loader.h>

#include "sequences/import/assimp_scene.h"
#include "sequences/import/ear_clipping.h"
#include "sequences/import/lower_case.h"
#include "sequences/import/obj_libraries.h"
#include "sequences/import/obj_text.h"
#include "sequences/import/wide_text.h"
#include "sequences/pictures/srgb.h"

namespace talisman::sequences {

namespace {

using layers::dvec3;

/// Coordinates larger than this many sizes keep fewer than 13 bits for the size in a float.
constexpr double kFarAway = 2000;
constexpr const char* kNoName = "defaultobject";

/// What the geometry's reader does not say, and what only materials need.
struct ObjWords {
  std::vector<std::string> libraries;  ///< what is behind each "mtllib"
  std::vector<std::string> materials;  ///< in the order of their first use
  std::map<std::string, int> id_of;    ///< by the first word, as the geometry's reader has it
  bool has_smoothing = false;          ///< it says somewhere what is smooth, or that nothing is
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
void check_numbers(const std::string& line) {
  if (line.find_first_of("nNiI", line.find_first_of(" \t")) == std::string::npos) return;
  if (line.find_first_of(" \t") != std::string::npos)
    throw InputError("a mesh has '" + line.substr(0, 60) + "', rule: finite numbers");
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
  std::size_t faces = 0;
  bool has_curves = false;
  for (std::string line; std::getline(in, line);) {
    const std::size_t at = line.find_first_not_of(" \t");
    if (at == std::string::npos) continue;
    if (line[at] == 'v') check_numbers(line);
    if (line[at] == 'f') count_face(line, at + 1, faces, words);
    if (line[at] == 's' && line.find_first_of(" \t", at) == at + 1) words.has_smoothing = true;
    if (line[at] != 'f' && !has_curves) has_curves = is_curve(line, at);
    if (line[at] != 'm' && line[at] != 'u') continue;
    if (line.compare(at, 6, "mtllib") == 0) words.libraries.push_back(rest_of_line(line, at + 6));
    if (line.compare(at, 6, "usemtl") != 0) continue;
    const std::string name = rest_of_line(line, at + 6);
    const std::string first = name.substr(0, name.find_first_of(" \t"));
    if (words.id_of.emplace(first, static_cast<int>(words.materials.size())).second)
      words.materials.push_back(name);
  }
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

struct ObjContent {
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;  ///< of triangles
  bool has_groups = false;               ///< it says what is smooth: what is in no group is flat
};

dvec3 place_of(const tinyobj::attrib_t& attributes, int vertex) {
  const std::size_t at = 3 * static_cast<std::size_t>(vertex);
  return {attributes.vertices[at], attributes.vertices[at + 1], attributes.vertices[at + 2]};
}

void check_corners(const ObjContent& content) {
  const auto count = static_cast<int>(content.attributes.vertices.size() / 3);
  for (const tinyobj::shape_t& shape : content.shapes)
    for (const tinyobj::index_t& corner : shape.mesh.indices)
      if (corner.vertex_index < 0 || corner.vertex_index >= count)
        throw InputError("cannot be read as a model: a face names vertex " +
                         std::to_string(corner.vertex_index + 1) + ", rule: from 1 to " +
                         std::to_string(count));
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
                        false))
    throw InputError("cannot be read as a model: " + error.substr(0, error.find('\n')));
  check_corners(content);
  content.has_groups = words.has_smoothing;
  std::size_t face = 0;
  for (tinyobj::shape_t& shape : content.shapes) {
    const std::vector<std::size_t> counts = corner_counts(shape.mesh, face, words);
    face += counts.size();
    shape.mesh = in_triangles(std::move(shape.mesh), counts, content.attributes);
  }
  return content;
}

/// Materials as assimp has them: fills model.scene.materials and textures. The number of each of `words.materials`,
/// and last that of the default one.
std::vector<int> materials_of(ImportedModel& model, const ModelPlace& place, const ObjWords& words,
                              bool has_colors, FileUses& files) {
  const std::string color = has_colors ? " 1 1 1\n" : "\n";
  const ObjLibraries libraries(place, words.libraries, files);
  std::string text = libraries.lines() + "v 0 0 0" + color + "v 1 0 0" + color + "v 0 1 0" + color;
  text += "o m" + std::to_string(words.materials.size()) + "\nf 1 2 3\n";
  for (std::size_t k = 0; k < words.materials.size(); ++k)
    text += "o m" + std::to_string(k) + "\nusemtl " + words.materials[k] + "\nf 1 2 3\n";
  std::vector<int> numbers(words.materials.size() + 1, 0);
  ImportedModel looks = with_assimp_materials(place, text, files, [&](const aiScene& scene) {
    for (unsigned i = 0; i < scene.mRootNode->mNumChildren; ++i) {
      const aiNode& node = *scene.mRootNode->mChildren[i];
      const std::size_t k = std::strtoul(node.mName.C_Str() + 1, nullptr, 10);
      if (node.mNumMeshes > 0 && k < numbers.size())
        numbers[k] = static_cast<int>(scene.mMeshes[node.mMeshes[0]]->mMaterialIndex);
    }
  });
  model.scene.materials = std::move(looks.scene.materials);
  model.scene.textures = std::move(looks.scene.textures);
  model.warnings = libraries.missing();
  if (const std::string unknown = libraries.unknown(words.materials); !unknown.empty())
    model.warnings.push_back(unknown);
  model.warnings.insert(model.warnings.end(), looks.warnings.begin(), looks.warnings.end());
  return numbers;
}

/// The middle of all vertices, where they lie far from the file's origin; else zero.
dvec3 origin_of(const ObjContent& content) {
  dvec3 lo(HUGE_VAL), hi(-HUGE_VAL);
  const int count = static_cast<int>(content.attributes.vertices.size() / 3);
  for (int i = 0; i < count; ++i) {
    const dvec3 p = place_of(content.attributes, i);
    lo = glm::min(lo, p), hi = glm::max(hi, p);
  }
  const double size = glm::length(hi - lo), away = glm::length(glm::max(glm::abs(lo), glm::abs(hi)));
  return size > 0 && std::isfinite(away) && away > kFarAway * size ? glm::round(0.5 * (lo + hi)) : dvec3(0);
}

/// Normals of a file without any.
class SmoothNormals {
 public:
  explicit SmoothNormals(const ObjContent& content) : content_(content) {
    number_places();
    for (const tinyobj::shape_t& shape : content.shapes)
      for (std::size_t f = 0; 3 * f < shape.mesh.indices.size(); ++f) {
        const dvec3 n = flat(shape.mesh, f);
        for (std::size_t k = 0; k < 3; ++k) sum_at(shape.mesh, f, k) += n;
      }
  }
  layers::vec3 at(const tinyobj::mesh_t& mesh, std::size_t face, std::size_t corner) {
    const bool is_flat = content_.has_groups && mesh.smoothing_group_ids[face] == 0;
    const dvec3 n = is_flat ? flat(mesh, face) : sum_at(mesh, face, corner);
    const double length = glm::length(n);
    return length > 1e-12 ? layers::vec3(n / length) : layers::vec3(0, 1, 0);
  }

 private:
  struct Hash {
    std::size_t operator()(const dvec3& p) const {
      std::uint64_t hash = 0, bits = 0;
      for (int k = 0; k < 3; ++k) {
        std::memcpy(&bits, &p[k], sizeof bits);
        hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
      }
      return hash;
    }
  };

  /// Vertices at one place are one.
  void number_places() {
    std::unordered_map<dvec3, std::uint32_t, Hash> number_of;
    const int count = static_cast<int>(content_.attributes.vertices.size() / 3);
    number_of.reserve(static_cast<std::size_t>(count));
    place_.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i)
      place_.push_back(
          number_of.emplace(place_of(content_.attributes, i) + 0.0, number_of.size()).first->second);
    sums_.resize(number_of.size(), dvec3(0));
  }
  dvec3& sum_at(const tinyobj::mesh_t& mesh, std::size_t face, std::size_t corner) {
    const std::uint32_t place =
        place_[static_cast<std::size_t>(mesh.indices[3 * face + corner].vertex_index)];
    const std::uint64_t group = content_.has_groups ? mesh.smoothing_group_ids[face] : 0;
    return group == 0 ? sums_[place] : sums_of_groups_[group << 32 | place];
  }
  dvec3 flat(const tinyobj::mesh_t& mesh, std::size_t face) const {
    dvec3 p[3];
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = place_of(content_.attributes, mesh.indices[3 * face + k].vertex_index);
    const dvec3 n = glm::cross(p[1] - p[0], p[2] - p[0]);
    const double length = glm::length(n);
    return length > 0 ? n / length : dvec3(0);
  }

  const ObjContent& content_;
  std::vector<std::uint32_t> place_;
  std::vector<dvec3> sums_;  ///< by place, of what has no group
  std::unordered_map<std::uint64_t, dvec3> sums_of_groups_;
};

/// Every combination of place, coordinates and normal once, found by the place.
class MeshBuilder {
 public:
  MeshBuilder(const ObjContent& content, const dvec3& origin, SmoothNormals* smooth)
      : content_(content),
        origin_(origin),
        smooth_(smooth),
        first_(content.attributes.vertices.size() / 3, -1) {}

  layers::Mesh mesh_of(const tinyobj::mesh_t& from, int material) {
    layers::Mesh mesh;
    known_.clear(), used_.clear();
    has_uvs_ = false;
    for (std::size_t f = 0; 3 * f < from.indices.size(); ++f)
      if (from.material_ids[f] == material)
        for (std::size_t k = 0; k < 3; ++k) mesh.indices.push_back(vertex(from, f, k, mesh));
    for (const int place : used_) first_[static_cast<std::size_t>(place)] = -1;
    if (!has_uvs_) mesh.uvs.clear();
    return mesh;
  }

 private:
  struct Known {
    int uv = -1;
    layers::vec3 normal{0};
    std::uint32_t vertex = 0;
    int next = -1;
  };

  layers::vec3 normal_of(const tinyobj::mesh_t& from, std::size_t f, std::size_t k) const {
    const int index = from.indices[3 * f + k].normal_index;
    const auto& n = content_.attributes.normals;
    const std::size_t at = 3 * static_cast<std::size_t>(std::max(index, 0));
    if (smooth_ || index < 0 || at + 2 >= n.size())
      return smooth_ ? smooth_->at(from, f, k) : layers::vec3(0, 1, 0);
    const dvec3 normal(n[at], n[at + 1], n[at + 2]);
    const double length = glm::length(normal);
    return length > 1e-12 && std::isfinite(length) ? layers::vec3(normal / length) : layers::vec3(0, 1, 0);
  }

  std::uint32_t vertex(const tinyobj::mesh_t& from, std::size_t f, std::size_t k, layers::Mesh& mesh) {
    const tinyobj::index_t& corner = from.indices[3 * f + k];
    const auto place = static_cast<std::size_t>(corner.vertex_index);
    const layers::vec3 normal = normal_of(from, f, k);
    for (int at = first_[place]; at >= 0; at = known_[static_cast<std::size_t>(at)].next) {
      const Known& known = known_[static_cast<std::size_t>(at)];
      if (known.uv == corner.texcoord_index && known.normal == normal) return known.vertex;
    }
    if (first_[place] < 0) used_.push_back(corner.vertex_index);
    const auto number = static_cast<std::uint32_t>(mesh.positions.size());
    known_.push_back({corner.texcoord_index, normal, number, first_[place]});
    first_[place] = static_cast<int>(known_.size()) - 1;
    add_vertex(corner, normal, mesh);
    return number;
  }

  void add_vertex(const tinyobj::index_t& corner, const layers::vec3& normal, layers::Mesh& mesh) {
    mesh.positions.emplace_back(place_of(content_.attributes, corner.vertex_index) - origin_);
    mesh.normals.push_back(normal);
    const auto& uv = content_.attributes.texcoords;
    const std::size_t at = 2 * static_cast<std::size_t>(std::max(corner.texcoord_index, 0));
    const bool has_uv = corner.texcoord_index >= 0 && at + 1 < uv.size();
    has_uvs_ |= has_uv;
    mesh.uvs.emplace_back(has_uv ? uv[at] : 0, has_uv ? 1 - uv[at + 1] : 0);
    const auto& c = content_.attributes.colors;
    const std::size_t color = 3 * static_cast<std::size_t>(corner.vertex_index);
    if (color + 2 >= c.size()) return;
    mesh.colors.push_back({});
    for (int k = 0; k < 3; ++k)
      mesh.colors.back()[k] =
          linear_from_srgb(static_cast<float>(std::max(0.0, c[color + static_cast<std::size_t>(k)])));
  }

  const ObjContent& content_;
  dvec3 origin_;
  SmoothNormals* smooth_;
  std::vector<int> first_;  ///< by place: the last of its combinations; -1: none
  std::vector<Known> known_;
  std::vector<int> used_;
  bool has_uvs_ = false;
};

void add_shape(layers::Scene& scene, const tinyobj::shape_t& shape, const std::vector<int>& numbers, int root,
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
    part.material = used[k] < 0 ? numbers.back() : numbers[static_cast<std::size_t>(used[k])];
    scene.meshes.push_back(builder.mesh_of(shape.mesh, used[k]));
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
  std::vector<std::string> losses = std::move(model.warnings);
  losses.insert(losses.end(), words.losses.begin(), words.losses.end());
  const std::vector<int> numbers =
      materials_of(model, place, words, !content.attributes.colors.empty(), files);
  model.warnings.insert(model.warnings.begin(), losses.begin(), losses.end());
  const std::filesystem::path file(place.path);
  const dvec3 origin = origin_of(content);
  layers::Scene& scene = model.scene;
  if (origin != dvec3(0)) scene.nodes.push_back({file.stem().string(), -1, {origin}});
  scene.nodes.push_back({file.filename().string(), static_cast<int>(scene.nodes.size()) - 1, {}});
  std::optional<SmoothNormals> smooth;
  if (content.attributes.normals.empty()) smooth.emplace(content);
  MeshBuilder builder(content, origin, smooth ? &*smooth : nullptr);
  const int root = static_cast<int>(scene.nodes.size()) - 1;
  for (const tinyobj::shape_t& shape : content.shapes) add_shape(scene, shape, numbers, root, builder);
  if (scene.parts.empty()) throw InputError("has no triangles, rule: a model has at least one");
  model.files = files.take();
  return model;
}

}  // namespace talisman::sequences
