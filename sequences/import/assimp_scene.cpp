// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/assimp_scene.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/version.h>
#include <assimp/Importer.hpp>

#include <glm/gtc/matrix_transform.hpp>

#include "sequences/import/file_frame.h"
#include "sequences/import/limits.h"
#include "sequences/import/lower_case.h"
#include "sequences/import/recorded_files.h"
#include "sequences/import/surfaces/unit_normals.h"
#include "sequences/import/wide_text.h"
#include "sequences/pictures/srgb.h"

namespace talisman::sequences {

namespace {

std::string text(const aiString& s) { return std::string(s.C_Str()); }

layers::dmat4 to_matrix(const aiMatrix4x4& m) {
  return {m.a1, m.b1, m.c1, m.d1, m.a2, m.b2, m.c2, m.d2, m.a3, m.b3, m.c3, m.d3, m.a4, m.b4, m.c4, m.d4};
}

// --- Nodes ---

/// T · R · S nearest to a matrix; `sheared` says whether something was lost.
layers::Transform decomposed(const layers::dmat4& m, bool& sheared) {
  layers::Transform t;
  t.translation = layers::dvec3(m[3]);
  layers::dvec3 axis[3] = {layers::dvec3(m[0]), layers::dvec3(m[1]), layers::dvec3(m[2])};
  t.scale = {glm::length(axis[0]), glm::length(axis[1]), glm::length(axis[2])};
  if (!(t.scale.x > 0 && t.scale.y > 0 &&
        t.scale.z > 0)) {  // flattened: what is left has no rotation to speak of
    sheared = true;
    return t;
  }
  if (glm::determinant(glm::dmat3(m)) < 0) t.scale.x = -t.scale.x;
  for (int k = 0; k < 3; ++k) axis[k] /= t.scale[k];
  for (int k = 0; k < 3; ++k) sheared |= std::abs(glm::dot(axis[k], axis[(k + 1) % 3])) > 1e-3;
  t.rotation = glm::normalize(glm::quat_cast(glm::dmat3(axis[0], axis[1], axis[2])));
  return t;
}

void import_layer_tag(Import& import, const aiNode& node, int index) {
  aiString layer;
  if (!node.mMetaData) return;
  if (node.mMetaData->Get("layer", layer) && layer.length > 0)
    import.model.layer_tags.push_back({index, text(layer)});
}

void import_parts(Import& import, const aiNode& node, int index, const std::string& path) {
  for (unsigned k = 0; k < node.mNumMeshes; ++k) {
    layers::Part part;
    part.name = node.mNumMeshes > 1 ? path + "#" + std::to_string(k) : path;
    part.node = index;
    part.mesh = static_cast<int>(node.mMeshes[k]);
    if (node.mMeshes[k] >= import.from.mNumMeshes || !import.from.mMeshes[node.mMeshes[k]])
      throw InputError("node '" + path + "' uses mesh " + std::to_string(node.mMeshes[k]) + ", rule: below " +
                       std::to_string(import.from.mNumMeshes));
    part.material = static_cast<int>(import.from.mMeshes[node.mMeshes[k]]->mMaterialIndex);
    import.model.scene.parts.push_back(part);
  }
}

/// AC3D calls what has no name "ACWorld_0", "ACGroup_3" and so on, and other files say nothing.
bool tells_nothing(const std::string& name) {
  if (name.empty()) return true;
  const std::size_t digits = name.find_last_not_of("0123456789");
  if (name.rfind("AC", 0) != 0 || digits + 1 >= name.size() || digits < 3 || name[digits] != '_')
    return false;
  return std::all_of(name.begin() + 2, name.begin() + static_cast<std::ptrdiff_t>(digits),
                     [](unsigned char c) { return std::isalpha(c) != 0; });
}

/// The node's name; else its mesh's, or of the root the file's.
std::string telling_name(const Import& import, const aiNode& node) {
  std::string own = text(node.mName);
  if (!tells_nothing(own)) return own;
  if (node.mNumMeshes > 0 && node.mMeshes[0] < import.from.mNumMeshes &&
      import.from.mMeshes[node.mMeshes[0]]) {
    std::string mesh = text(import.from.mMeshes[node.mMeshes[0]]->mName);
    if (!tells_nothing(mesh)) return mesh;
  }
  return node.mParent ? own : std::filesystem::path(import.place.path).stem().string();
}

void import_nodes(Import& import, const aiNode* node, int parent, const std::string& parent_path, int depth) {
  if (!node) return import.warn("a node is missing in the file's tree");
  if (depth > kMaxNodeDepth)
    throw InputError("nodes are nested deeper than " + std::to_string(kMaxNodeDepth));
  auto& nodes = import.model.scene.nodes;
  const int index = static_cast<int>(nodes.size());
  const std::string name = telling_name(import, *node);
  const std::string path = parent_path.empty() ? name : parent_path + "/" + name;
  bool sheared = false;
  nodes.push_back({name, parent, decomposed(to_matrix(node->mTransformation), sheared)});
  if (sheared) import.warn("node '" + path + "' is sheared or flat; only its scale is kept");
  import.node_of[node] = index;
  import.node_named.emplace(text(node->mName), index);
  import_layer_tag(import, *node, index);
  import_parts(import, *node, index, path);
  for (unsigned k = 0; k < node->mNumChildren; ++k)
    import_nodes(import, node->mChildren[k], index, path, depth + 1);
}

// --- Meshes ---

layers::vec3 to_float3(const aiVector3D& v) { return {v.x, v.y, v.z}; }

/// The set of coordinates by which the colour map of the mesh is looked up.
unsigned coordinate_set(const Import& import, const aiMesh& mesh) {
  const aiScene& scene = import.from;
  if (mesh.mMaterialIndex >= scene.mNumMaterials || !scene.mMaterials[mesh.mMaterialIndex]) return 0;
  const aiMaterial& material = *scene.mMaterials[mesh.mMaterialIndex];
  int set = 0;
  if (const auto own = import.collada.find(material.GetName().C_Str()); own != import.collada.end())
    set = own->second.set;
  else
    material.Get(_AI_MATKEY_UVWSRC_BASE, color_map_of(material), 0, set);
  return set > 0 && mesh.HasTextureCoords(static_cast<unsigned>(set)) ? static_cast<unsigned>(set) : 0;
}

layers::Mesh import_mesh(const Import& import, const aiMesh& from) {
  layers::Mesh mesh;
  mesh.name = text(from.mName);
  const unsigned n = from.mVertices ? from.mNumVertices : 0;
  for (unsigned i = 0; i < n; ++i) mesh.positions.push_back(to_float3(from.mVertices[i]));
  if (from.HasNormals())
    for (unsigned i = 0; i < n; ++i) mesh.normals.push_back(to_float3(from.mNormals[i]));
  if (const unsigned set = coordinate_set(import, from); from.HasTextureCoords(set))
    for (unsigned i = 0; i < n; ++i)
      mesh.uvs.push_back({from.mTextureCoords[set][i].x, from.mTextureCoords[set][i].y});
  if (from.HasVertexColors(0))
    for (unsigned i = 0; i < n; ++i) {
      const aiColor4D& c = from.mColors[0][i];
      mesh.colors.push_back({linear_from_srgb(std::max(0.0f, c.r)), linear_from_srgb(std::max(0.0f, c.g)),
                             linear_from_srgb(std::max(0.0f, c.b))});
    }
  for (unsigned f = 0; f < from.mNumFaces; ++f)
    if (from.mFaces[f].mNumIndices == 3)
      mesh.indices.insert(mesh.indices.end(), from.mFaces[f].mIndices, from.mFaces[f].mIndices + 3);
  return mesh;
}

/// The four largest influences of each vertex.
class Influences {
 public:
  explicit Influences(std::size_t vertices)
      : joints_(vertices, glm::uvec4(0)), weights_(vertices, layers::vec4(0)) {}
  void add(unsigned vertex, unsigned joint, float weight) {
    if (vertex >= weights_.size() || !(weight > 0) || !std::isfinite(weight)) return;
    layers::vec4& w = weights_[vertex];
    int least = 0;
    for (int k = 1; k < 4; ++k)
      if (w[k] < w[least]) least = k;
    if (weight <= w[least]) return;
    w[least] = weight;
    joints_[vertex][least] = joint;
  }
  /// Weights sum to 1; a vertex that no bone holds follows `rest`.
  void finish(unsigned rest, layers::Mesh& mesh) {
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      const float sum = weights_[i].x + weights_[i].y + weights_[i].z + weights_[i].w;
      if (sum > 0) {
        weights_[i] /= sum;
      } else {
        weights_[i] = {1, 0, 0, 0};
        joints_[i] = glm::uvec4(rest, 0, 0, 0);
      }
    }
    mesh.joints = std::move(joints_);
    mesh.weights = std::move(weights_);
  }

 private:
  std::vector<glm::uvec4> joints_;
  std::vector<layers::vec4> weights_;
};

/// The skin of a mesh with bones, for the parts that show it. Its last joint is the part's own node, at rest.
void import_skin(Import& import, int mesh_index) {
  const aiMesh& from = *import.from.mMeshes[mesh_index];
  layers::Scene& scene = import.model.scene;
  layers::Mesh& mesh = scene.meshes[mesh_index];
  layers::Skin skin;
  skin.name = text(from.mName);
  Influences influences(mesh.positions.size());
  for (unsigned b = 0; b < from.mNumBones; ++b) {
    const aiBone* bone = from.mBones[b];
    const auto joint = bone ? import.node_named.find(text(bone->mName)) : import.node_named.end();
    if (joint == import.node_named.end()) continue;
    for (unsigned w = 0; w < bone->mNumWeights; ++w)
      influences.add(bone->mWeights[w].mVertexId, static_cast<unsigned>(skin.joints.size()),
                     bone->mWeights[w].mWeight);
    skin.joints.push_back(joint->second);
    skin.joint_from_mesh.push_back(to_matrix(bone->mOffsetMatrix));
  }
  if (skin.joints.empty())
    return import.warn("mesh '" + skin.name + "' has bones without nodes; it stays rigid");
  influences.finish(static_cast<unsigned>(skin.joints.size()), mesh);
  skin.joint_from_mesh.push_back(layers::dmat4(1));
  for (layers::Part& part : scene.parts) {
    if (part.mesh != mesh_index) continue;
    part.skin = static_cast<int>(scene.skins.size());
    scene.skins.push_back(skin);
    scene.skins.back().joints.push_back(part.node);
  }
}

void import_meshes(Import& import) {
  std::size_t without_direction = 0;
  for (unsigned i = 0; i < import.from.mNumMeshes; ++i) {
    const aiMesh* mesh = import.from.mMeshes[i];
    import.model.scene.meshes.push_back(mesh ? import_mesh(import, *mesh) : layers::Mesh{});
    without_direction += make_unit_normals(import.model.scene.meshes.back());
    if (mesh && mesh->mNumBones > 0 && mesh->mBones) import_skin(import, static_cast<int>(i));
  }
  if (without_direction > 0)
    import.model.notes.push_back(std::to_string(without_direction) + " " + kWithoutDirection);
}

void drop_empty_parts(layers::Scene& scene) {
  std::erase_if(scene.parts,
                [&](const layers::Part& part) { return scene.meshes[part.mesh].indices.empty(); });
}

// --- The file ---

void set_options(Assimp::Importer& importer) {
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  importer.SetPropertyInteger(AI_CONFIG_PP_LBW_MAX_WEIGHTS, 4);
}

constexpr unsigned kSteps = aiProcess_Triangulate | aiProcess_JoinIdenticalVertices |
                            aiProcess_GenSmoothNormals | aiProcess_FlipUVs | aiProcess_SortByPType |
                            aiProcess_ValidateDataStructure | aiProcess_LimitBoneWeights |
                            aiProcess_GenUVCoords | aiProcess_TransformUVCoords;

/// What the loader found and the steps below take away, and what is not drawn at all.
std::vector<std::string> losses_of(const aiScene& scene) {
  std::set<std::string> losses;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    const aiMesh* mesh = scene.mMeshes[i];
    if (!mesh) continue;
    if (mesh->mPrimitiveTypes & aiPrimitiveType_POINT) losses.insert("points are not drawn");
    if (mesh->mPrimitiveTypes & aiPrimitiveType_LINE) losses.insert("lines are not drawn");
    if (mesh->mNumAnimMeshes > 0)
      losses.insert("morph targets of '" + text(mesh->mName) + "' are not played");
  }
  return {losses.begin(), losses.end()};
}

/// All nodes below one that turns and scales the file's axes and units to ours; nothing where they are ours.
int import_frame(Import& import, const FileFrame& frame) {
  const layers::Transform own;
  if (frame.transform.rotation == own.rotation && frame.transform.scale == own.scale &&
      frame.transform.translation == own.translation)
    return -1;
  import.model.scene.nodes.push_back(
      {std::filesystem::path(import.place.path).stem().string(), -1, frame.transform});
  return 0;
}

/// Of formats that assimp lists and cannot read, whatever the file; empty of others.
std::string weakness_of_reader(const std::string& path) {
  const std::string extension = lower_extension(path);
  if (extension != ".irr" && extension != ".irrmesh") return {};
  return "; assimp " + std::to_string(aiGetVersionMajor()) + "." + std::to_string(aiGetVersionMinor()) +
         " finds no mesh in files of Irrlicht";
}

const aiScene* read_file(Assimp::Importer& importer, const std::string& path,
                         std::vector<std::string>& losses) {
  const aiScene* from = importer.ReadFile(path, 0);
  if (from) losses = losses_of(*from);
  if (from) from = importer.ApplyPostProcessing(kSteps);
  if (from && from->mRootNode) return from;
  const std::string why = importer.GetErrorString();
  throw InputError("cannot be read as a model: " + (why.empty() ? "no reader takes it" : why) +
                   weakness_of_reader(path));
}

}  // namespace

ImportedModel read_with_assimp(const ModelPlace& place) {
  FileUses files;
  files.add_code();
  Assimp::Importer importer;
  set_options(importer);
  importer.SetIOHandler(new RecordedFiles(place, files));  // it belongs to the importer
  std::vector<std::string> losses;
  const aiScene* from = read_file(importer, place.path, losses);
  Import import(*from, place, files);
  import.model.warnings = losses;
  if (lower_extension(place.path) == ".dae")
    import.collada = collada_maps(std::string{std::istreambuf_iterator<char>(*open_text(place.path)), {}});
  import_nodes(import, from->mRootNode, import_frame(import, file_frame(*from)), "", 0);
  import_materials(import);
  import_meshes(import);
  drop_empty_parts(import.model.scene);
  import_motion(import);
  import_lights(import);
  import_cameras(import);
  if (import.model.scene.parts.empty())
    throw InputError("has no triangles, rule: a model has at least one" + weakness_of_reader(place.path));
  import.model.files = files.take();
  return std::move(import.model);
}

}  // namespace talisman::sequences
