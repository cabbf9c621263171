// SPDX-License-Identifier: Apache-2.0
#pragma once

/// From a glTF 2.0 file to an ImportedModel. Each step is a file of its own:
///
///   gltf_nodes      the tree of the default scene, cameras, layer tags, parts
///   gltf_meshes     primitives → Mesh: triangles, strips, fans; skins; morph targets
///   gltf_tangents   frames of normal maps: those of the file, or made from the coordinates
///   gltf_materials  materials, textures, samplers
///   gltf_motion     the first animation
///   gltf_lights     KHR_lights_punctual, and the exposure that brings lux and candela to 0 … 1
///
/// What the file has and a picture will lack is collected by kind and said once (`lacks`).

#include <map>
#include <set>
#include <string>
#include <vector>

#include "sequences/import/gltf_accessors.h"
#include "sequences/import/gltf_json.h"
#include "sequences/import/model_import.h"

namespace talisman::sequences {

/// Where the nodes of the scene carry a glTF node: `outer` has its place below the parent, `inner` is what its
/// children, parts, camera and light follow. They differ where a matrix shears: then it is a product of two.
struct GltfNode {
  int outer = -1, inner = -1;
  std::string path;  ///< unique
};

/// The texture coordinates that a texture is looked up by.
struct GltfCoordinates {
  int set = 0;
  double offset[2] = {0, 0}, scale[2] = {1, 1}, rotation_rad = 0;
  bool operator==(const GltfCoordinates&) const = default;
  /// Do u and v grow in other directions than those of the set?
  bool turned() const { return rotation_rad != 0 || !(scale[0] > 0 && scale[1] > 0); }
};

struct GltfMaterial {
  GltfCoordinates base, emissive, normal;
  bool has_base_map = false, has_emissive_map = false, has_normal_map = false;
  bool is_opaque = true;  ///< its alpha mode asks for no alpha
};

struct GltfImport {
  explicit GltfImport(GltfFile from) : file(std::move(from)) {}
  GltfFile file;
  ImportedModel model;
  std::map<int, GltfNode> nodes;                   ///< by glTF index: those of the scene that is drawn
  std::vector<GltfMaterial> materials;             ///< of the scene's materials, and as last the default one
  std::set<int> morph_animated;                    ///< glTF nodes whose weights an animation moves
  std::vector<std::pair<int, int>> skinned_parts;  ///< part, glTF skin
  std::map<std::string, std::vector<std::string>> lacking;  ///< what is not drawn → whose

  /// Primitives are read once for all nodes that show them alike.
  struct MeshKey {
    int mesh, primitive, node;    ///< node: -1 unless its weights are animated
    std::vector<double> weights;  ///< morph weights
    auto operator<=>(const MeshKey&) const = default;
  };
  std::map<MeshKey, int> meshes;
  template <typename Make>
  int mesh_of(MeshKey key, const Make& make) {
    if (!morph_animated.contains(key.node)) key.node = -1;
    if (const auto found = meshes.find(key); found != meshes.end()) return found->second;
    return meshes[key] = make();
  }

  void warn(const std::string& text) { model.warnings.push_back(text); }
  /// "points are not drawn: 'hull', 'wing'". Without a name: the sentence alone.
  void lacks(const std::string& what, const std::string& whose = {});
};

/// Has the file an extension of glTF, and not the content of glTF 1?
bool is_gltf2(const std::string& path);

/// Reads the file. Throws InputError without the file's name.
ImportedModel read_gltf(const ModelPlace& place);

void import_gltf_materials(GltfImport& import);
void find_animated_morphs(GltfImport& import);
void import_gltf_nodes(GltfImport& import);
void import_gltf_motion(GltfImport& import);
void import_gltf_lights(GltfImport& import);

/// When positions, normals and the file's own tangents are final: gives a mesh with a normal map tangents, made from its
/// coordinates where the file has none. Returns what cannot be drawn, for `lacks`; empty: all can.
std::string finish_gltf_tangents(const GltfMaterial& maps, layers::Mesh& mesh);

/// The meshes of a node as parts; called for each node, in the order of the tree.
void import_gltf_parts(GltfImport& import, int node);
/// When all nodes are there: parts that have a skin get it.
void import_gltf_skins(GltfImport& import);

}  // namespace talisman::sequences
