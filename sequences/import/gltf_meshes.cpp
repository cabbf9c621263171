// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>

#include <glm/geometric.hpp>

#include "sequences/files/number_text.h"
#include "sequences/import/gltf_compression.h"
#include "sequences/import/gltf_scene.h"
#include "sequences/import/surfaces/unit_normals.h"

namespace talisman::sequences {

namespace {

constexpr int kTriangles = 4, kStrip = 5, kFan = 6;

layers::vec3 vector_at(const Accessed& from, std::size_t i) {
  return {static_cast<float>(from.at(i, 0)), static_cast<float>(from.at(i, 1)),
          static_cast<float>(from.at(i, 2))};
}

std::vector<layers::vec3> vectors_of(GltfImport& import, int accessor, const char* what, std::size_t count) {
  const Accessed from = read_accessor(import.file, accessor, what, 3);
  if (count > 0 && from.count != count)
    throw InputError("glTF: " + std::string(what) + " has " + std::to_string(from.count) +
                     " elements, rule: as many as positions, " + std::to_string(count));
  std::vector<layers::vec3> vectors;
  for (std::size_t i = 0; i < from.count; ++i) vectors.push_back(vector_at(from, i));
  return vectors;
}

void check_count(const char* what, const Accessed& from, std::size_t vertices) {
  if (from.count == vertices) return;
  throw InputError("glTF: " + std::string(what) + " has " + std::to_string(from.count) +
                   " elements, rule: as many as positions, " + std::to_string(vertices));
}

/// u' = c sx u + s sy v + ox,  v' = -s sx u + c sy v + oy  (KHR_texture_transform).
std::vector<layers::vec2> coordinates(GltfImport& import, const Json& attributes, const GltfCoordinates& by,
                                      std::size_t vertices) {
  const std::string name = "TEXCOORD_" + std::to_string(by.set);
  const int accessor = index_of(attributes, name.c_str());
  if (accessor < 0) return {};
  const Accessed from = read_accessor(import.file, accessor, name.c_str(), 2);
  check_count(name.c_str(), from, vertices);
  const double c = std::cos(by.rotation_rad), s = std::sin(by.rotation_rad);
  std::vector<layers::vec2> uvs;
  for (std::size_t i = 0; i < vertices; ++i) {
    const double u = from.at(i, 0) * by.scale[0], v = from.at(i, 1) * by.scale[1];
    uvs.emplace_back(static_cast<float>(c * u + s * v + by.offset[0]),
                     static_cast<float>(-s * u + c * v + by.offset[1]));
  }
  return uvs;
}

void read_coordinates(GltfImport& import, const Json& attributes, const GltfMaterial& maps,
                      layers::Mesh& mesh) {
  const std::size_t n = mesh.positions.size();
  if (maps.has_base_map) mesh.uvs = coordinates(import, attributes, maps.base, n);
  if (maps.has_normal_map && !(maps.has_base_map && maps.normal == maps.base))
    mesh.normal_uvs = coordinates(import, attributes, maps.normal, n);
  if (!maps.has_emissive_map) return;
  if (!maps.has_base_map)
    mesh.uvs = coordinates(import, attributes, maps.emissive, n);
  else if (!(maps.emissive == maps.base))
    mesh.emissive_uvs = coordinates(import, attributes, maps.emissive, n);
}

void read_colors(GltfImport& import, const Json& attributes, bool opaque, layers::Mesh& mesh) {
  const int accessor = index_of(attributes, "COLOR_0");
  if (accessor < 0) return;
  const Accessed from = read_accessor(import.file, accessor, "COLOR_0", 3, 4);
  check_count("COLOR_0", from, mesh.positions.size());
  bool translucent = false;
  for (std::size_t i = 0; i < from.count; ++i) {
    mesh.colors.push_back(glm::max(vector_at(from, i), layers::vec3(0)));
    const double alpha = from.components == 4 ? std::clamp(from.at(i, 3), 0.0, 1.0) : 1;
    mesh.alphas.push_back(static_cast<float>(alpha));
    translucent |= alpha < 1;
  }
  if (opaque || !translucent) mesh.alphas.clear();
}

/// The four largest of all influences of each vertex, of every set JOINTS_n, WEIGHTS_n.
void read_influences(GltfImport& import, const Json& attributes, layers::Mesh& mesh) {
  const std::size_t n = mesh.positions.size();
  bool left_out = false;
  for (int set = 0; set < 16; ++set) {
    const std::string joints_name = "JOINTS_" + std::to_string(set),
                      weights_name = "WEIGHTS_" + std::to_string(set);
    const int joints_at = index_of(attributes, joints_name.c_str()),
              weights_at = index_of(attributes, weights_name.c_str());
    if (joints_at < 0 || weights_at < 0) break;
    const Accessed joints = read_accessor(import.file, joints_at, joints_name.c_str(), 4);
    const Accessed weights = read_accessor(import.file, weights_at, weights_name.c_str(), 4);
    check_count(joints_name.c_str(), joints, n);
    check_count(weights_name.c_str(), weights, n);
    mesh.joints.resize(n, glm::uvec4(0));
    mesh.weights.resize(n, layers::vec4(0));
    for (std::size_t i = 0; i < n; ++i)
      for (int k = 0; k < 4; ++k) {
        layers::vec4& own = mesh.weights[i];
        const int least = static_cast<int>(std::min_element(&own[0], &own[0] + 4) - &own[0]);
        const auto weight = static_cast<float>(weights.at(i, k));
        left_out |= std::min(weight, own[least]) > 0;
        if (!(weight > own[least])) continue;
        own[least] = weight;
        mesh.joints[i][least] = static_cast<unsigned>(joints.at(i, k));
      }
  }
  if (left_out) import.lacks("of more than four joints of a vertex the weakest are left out");
}

std::vector<std::uint32_t> read_indices(GltfImport& import, const Json& primitive, std::size_t vertices) {
  std::vector<std::uint32_t> indices;
  const int accessor = index_of(primitive, "indices");
  if (accessor < 0) {
    indices.resize(vertices);
    std::iota(indices.begin(), indices.end(), 0u);
    return indices;
  }
  const Accessed from = read_accessor(import.file, accessor, "indices", 1);
  for (const double value : from.values) {
    if (!(value >= 0 && value < static_cast<double>(vertices)))
      throw InputError("glTF: index " + std::to_string(static_cast<long long>(value)) + ", rule: below " +
                       std::to_string(vertices) + " vertices");
    indices.push_back(static_cast<std::uint32_t>(value));
  }
  return indices;
}

/// Of strips every second triangle is turned, of fans all share the first vertex (glTF 2.0, 3.7.2.1).
std::vector<std::uint32_t> triangles_of(int mode, const std::vector<std::uint32_t>& v) {
  if (mode == kTriangles) return {v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 3 * 3)};
  std::vector<std::uint32_t> triangles;
  for (std::size_t i = 0; i + 2 < v.size(); ++i) {
    if (mode == kStrip)
      triangles.insert(triangles.end(), {v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]});
    else
      triangles.insert(triangles.end(), {v[i + 1], v[i + 2], v[0]});
  }
  return triangles;
}

void read_morphs(GltfImport& import, const Json& primitive, layers::Mesh& mesh) {
  const std::size_t n = mesh.positions.size();
  for (const Json& target : list_of(primitive, "targets")) {
    layers::MorphTarget morph;
    if (const int at = index_of(target, "POSITION"); at >= 0)
      morph.positions = vectors_of(import, at, "POSITION of a morph target", n);
    const int at = index_of(target, "NORMAL");
    if (at >= 0 && !mesh.normals.empty())
      morph.normals = vectors_of(import, at, "NORMAL of a morph target", n);
    mesh.morphs.push_back(std::move(morph));
    for (const auto& [name, accessor] : target.items())
      if (name.rfind("COLOR_", 0) == 0 || name.rfind("TEXCOORD_", 0) == 0)
        import.lacks("colours and texture coordinates of morph targets are not moved");
  }
}

/// Tangents without normals are to be ignored (glTF 2.0, 3.7.2.1); those of coordinates that a transform turns are other
/// ones.
void read_tangents(GltfImport& import, const Json& primitive, const GltfMaterial& maps, layers::Mesh& mesh) {
  const int accessor = index_of(object_of(primitive, "attributes"), "TANGENT");
  if (!maps.has_normal_map || accessor < 0 || mesh.normals.empty() || maps.normal.turned()) return;
  const Accessed from = read_accessor(import.file, accessor, "TANGENT", 4);
  check_count("TANGENT", from, mesh.positions.size());
  for (std::size_t i = 0; i < from.count; ++i)
    mesh.tangents.emplace_back(vector_at(from, i), static_cast<float>(from.at(i, 3)));
  const Json& targets = list_of(primitive, "targets");
  for (std::size_t k = 0; k < mesh.morphs.size(); ++k)
    if (const int at = index_of(targets[k], "TANGENT"); at >= 0)
      mesh.morphs[k].tangents = vectors_of(import, at, "TANGENT of a morph target", mesh.positions.size());
}

/// Weights that nothing moves are added once and for all.
void bake_morphs(const std::vector<double>& weights, layers::Mesh& mesh) {
  for (std::size_t k = 0; k < mesh.morphs.size() && k < weights.size(); ++k) {
    const auto weight = static_cast<float>(weights[k]);
    const layers::MorphTarget& morph = mesh.morphs[k];
    for (std::size_t i = 0; i < morph.positions.size(); ++i) mesh.positions[i] += weight * morph.positions[i];
    for (std::size_t i = 0; i < morph.normals.size(); ++i) mesh.normals[i] += weight * morph.normals[i];
    for (std::size_t i = 0; i < morph.tangents.size(); ++i)
      mesh.tangents[i] += layers::vec4(weight * morph.tangents[i], 0);
  }
  mesh.morphs.clear();
}

/// -1: those of the default material, which is the last.
const GltfMaterial& maps_of(const GltfImport& import, int material) {
  return material >= 0 ? import.materials[static_cast<std::size_t>(material)] : import.materials.back();
}

/// All attributes of a primitive have one count (glTF 2.0, 3.7.2.1), those that are not drawn, too.
void check_counts(const GltfImport& import, const Json& attributes, const std::string& mesh) {
  const auto count_of = [&](int accessor) {
    return number_of(item_of(import.file, "accessors", accessor), "count", 0);
  };
  const double vertices = count_of(index_of(attributes, "POSITION"));
  for (const auto& [name, accessor] : attributes.items()) {
    const int index = index_of(attributes, name.c_str());
    if (index < 0 || count_of(index) == vertices) continue;
    throw InputError("glTF: " + name + " of mesh '" + mesh + "' has " + formatted("%.0f", count_of(index)) +
                     " elements, rule: as many as POSITION, " + formatted("%.0f", vertices));
  }
}

layers::Mesh read_primitive(GltfImport& import, const Json& primitive, int material) {
  const Json& attributes = object_of(primitive, "attributes");
  layers::Mesh mesh;
  const int positions = index_of(attributes, "POSITION");
  if (positions < 0) return mesh;
  mesh.positions = vectors_of(import, positions, "POSITION", 0);
  const std::size_t n = mesh.positions.size();
  if (const int normals = index_of(attributes, "NORMAL"); normals >= 0 && n > 0)
    mesh.normals = vectors_of(import, normals, "NORMAL", n);
  const std::size_t last = import.materials.size() - 1;
  const GltfMaterial& maps = maps_of(import, material);
  const layers::Material& look =
      import.model.scene.materials[material >= 0 ? static_cast<std::size_t>(material) : last];
  const bool opaque = look.opacity == 1 && look.alpha_cutoff == 0 && maps.is_opaque;
  read_coordinates(import, attributes, maps, mesh);
  read_colors(import, attributes, opaque, mesh);
  read_influences(import, attributes, mesh);
  read_morphs(import, primitive, mesh);
  read_tangents(import, primitive, maps, mesh);
  return mesh;
}

std::vector<std::uint32_t> indices_of(GltfImport& import, const Json& primitive, std::size_t vertices) {
  const int mode = index_of(primitive, "mode");
  return triangles_of(mode < 0 ? kTriangles : mode, read_indices(import, primitive, vertices));
}

/// The mesh of a primitive, compressed or not.
layers::Mesh mesh_of_primitive(GltfImport& import, const Json& primitive, int material) {
  const Json* draco = extension_of(primitive, "KHR_draco_mesh_compression");
  if (!draco) {
    layers::Mesh mesh = read_primitive(import, primitive, material);
    mesh.indices = indices_of(import, primitive, mesh.positions.size());
    return mesh;
  }
  DracoMesh decoded = decoded_draco(import.file, primitive, *draco);
  import.file.decoded = std::move(decoded.accessors);
  layers::Mesh mesh = read_primitive(import, primitive, material);
  import.file.decoded.clear();
  for (const std::uint32_t index : decoded.indices)
    if (index >= mesh.positions.size())
      throw InputError("KHR_draco_mesh_compression: has no positions for its triangles");
  mesh.indices = std::move(decoded.indices);
  return mesh;
}

std::vector<double> weights_of(const Json& object) {
  std::vector<double> weights;
  for (const Json& value : list_of(object, "weights"))
    weights.push_back(value.is_number() ? value.get<double>() : 0.0);
  return weights;
}

int material_of(const GltfImport& import, const Json& primitive) {
  const int material = index_of(primitive, "material");
  if (material >= 0) item_of(import.file, "materials", material);  // is it there?
  return material;
}

/// The mesh of one primitive of a node in the scene; -1: it shows no triangle.
int add_primitive(GltfImport& import, const Json& primitive, const std::string& name, int node,
                  const std::vector<double>& weights) {
  const int given = index_of(primitive, "mode"), mode = given < 0 ? kTriangles : given;
  if (mode < kTriangles || mode > kFan) {
    import.lacks(mode == 0 ? "points are not drawn" : "lines are not drawn", name);
    return -1;
  }
  const Json& attributes = object_of(primitive, "attributes");
  if (index_of(attributes, "POSITION") >= 0 && !extension_of(primitive, "KHR_draco_mesh_compression"))
    check_counts(import, attributes, name);  // the decoder of the other kind has its own
  layers::Mesh mesh = mesh_of_primitive(import, primitive, material_of(import, primitive));
  if (mesh.indices.empty()) return -1;
  mesh.name = name;
  if (!import.morph_animated.contains(node)) bake_morphs(weights, mesh);
  if (make_unit_normals(mesh) > 0) import.lacks(kWithoutDirection, mesh.name);
  if (const std::string lacking = finish_gltf_tangents(maps_of(import, material_of(import, primitive)), mesh);
      !lacking.empty())
    import.lacks(lacking, mesh.name);
  import.model.scene.meshes.push_back(std::move(mesh));
  return static_cast<int>(import.model.scene.meshes.size()) - 1;
}

layers::dmat4 matrix_at(const Accessed& from, std::size_t i) {
  layers::dmat4 matrix;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) matrix[column][row] = from.at(i, 4 * column + row);
  return matrix;
}

/// Empty where a joint is not in the scene.
layers::Skin read_skin(GltfImport& import, int index) {
  const Json& from = item_of(import.file, "skins", index);
  layers::Skin skin;
  skin.name = text_of(from, "name", "skin " + std::to_string(index));
  for (const Json& joint : list_of(from, "joints")) {
    const auto node = joint.is_number_integer() ? import.nodes.find(joint.get<int>()) : import.nodes.end();
    if (node == import.nodes.end()) return {};
    skin.joints.push_back(node->second.inner);
  }
  const int matrices = index_of(from, "inverseBindMatrices");
  skin.joint_from_mesh.resize(skin.joints.size(), layers::dmat4(1.0));  // absent: identity
  if (matrices < 0) return skin;
  const Accessed inverse = read_accessor(import.file, matrices, "inverseBindMatrices", 16);
  if (inverse.count < skin.joints.size())
    throw InputError("glTF: skin '" + skin.name + "' has " + std::to_string(inverse.count) +
                     " inverse bind matrices, rule: one per joint, " + std::to_string(skin.joints.size()));
  for (std::size_t i = 0; i < skin.joints.size(); ++i) skin.joint_from_mesh[i] = matrix_at(inverse, i);
  return skin;
}

}  // namespace

void import_gltf_parts(GltfImport& import, int node) {
  const Json& from = item_of(import.file, "nodes", node);
  const int index = index_of(from, "mesh");
  if (index < 0) return;
  const Json& mesh = item_of(import.file, "meshes", index);
  const Json& primitives = list_of(mesh, "primitives");
  const GltfNode& place = import.nodes.at(node);
  std::vector<double> weights = weights_of(from);
  if (weights.empty()) weights = weights_of(mesh);
  import.model.scene.nodes[place.inner].morph_weights = weights;
  const std::string name = text_of(mesh, "name", "mesh " + std::to_string(index));
  layers::Scene& scene = import.model.scene;
  for (std::size_t k = 0; k < primitives.size(); ++k) {
    const int found = import.mesh_of({index, static_cast<int>(k), node, weights}, [&] {
      return add_primitive(import, primitives[k], name, node, weights);
    });
    if (found < 0) continue;
    const int material = index_of(primitives[k], "material");
    layers::Part part;
    part.name = primitives.size() > 1 ? place.path + "#" + std::to_string(k) : place.path;
    part.node = place.inner;
    part.mesh = found;
    part.material = material >= 0 ? material : static_cast<int>(scene.materials.size()) - 1;
    scene.parts.push_back(part);
    if (const int skin = index_of(from, "skin"); skin >= 0)
      import.skinned_parts.emplace_back(static_cast<int>(scene.parts.size()) - 1, skin);
  }
}

void import_gltf_skins(GltfImport& import) {
  std::map<int, int> skin_of;
  layers::Scene& scene = import.model.scene;
  for (const auto& [part, index] : import.skinned_parts) {
    if (scene.meshes[scene.parts[part].mesh].joints.empty()) continue;
    const auto [entry, is_new] = skin_of.emplace(index, -1);
    if (is_new) {
      layers::Skin skin = read_skin(import, index);
      if (!skin.joints.empty()) {
        entry->second = static_cast<int>(scene.skins.size());
        scene.skins.push_back(std::move(skin));
      } else {
        import.warn("skin " + std::to_string(index) +
                    " has joints outside the scene; what it moves stays rigid");
      }
    }
    scene.parts[part].skin = entry->second;
  }
}

}  // namespace talisman::sequences
