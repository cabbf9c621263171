// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include <glm/geometric.hpp>
#include <opencv2/core.hpp>

#include "layers/layer.h"
#include "sequences/files/number_text.h"
#include "sequences/import/far_plane.h"
#include "sequences/import/gltf_scene.h"
#include "sequences/import/limits.h"
#include "sequences/import/lower_case.h"

namespace talisman::sequences {

namespace {

using layers::dmat3;
using layers::dmat4;
using layers::dvec3;

constexpr double kOrthogonal = 1e-6;  // cosine between axes that still counts as a right angle
/// An orthographic camera is drawn by a long lens: from this many radii of the scene away perspective moves
/// what is at its front by less than half a pixel of a thousand against what is at its back.
constexpr double kLongLens = 2000;
constexpr double kFarthest = 1e6;  ///< far plane of an infinite projection, in multiples of the near one

// --- Places

glm::dquat rotation_of(const dvec3& x, const dvec3& y, const dvec3& z) {
  return glm::normalize(glm::quat_cast(dmat3(x, y, z)));
}

dvec3 column(const cv::Matx33d& m, int k) { return {m(0, k), m(1, k), m(2, k)}; }

/// M = (T U Σ) · Vᵀ with rotations U and V: any matrix is two transforms, one below the other. A reflection goes
/// into Σ.
void split(const dmat4& matrix, layers::Transform& outer, layers::Transform& inner) {
  cv::Matx33d m, u, vt;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) m(r, c) = matrix[c][r];
  if (!cv::checkRange(m)) throw InputError("a matrix is not finite");
  cv::Matx31d s;
  cv::SVD::compute(m, s, u, vt, cv::SVD::FULL_UV);
  const cv::Matx33d v = vt.t();
  const double u_side = cv::determinant(u) < 0 ? -1 : 1, v_side = cv::determinant(v) < 0 ? -1 : 1;
  outer.translation = dvec3(matrix[3]);
  outer.rotation = rotation_of(column(u, 0), column(u, 1), u_side * column(u, 2));
  outer.scale = {s(0), s(1), u_side * v_side * s(2)};
  inner.rotation = glm::conjugate(rotation_of(column(v, 0), column(v, 1), v_side * column(v, 2)));
}

/// One transform, where the axes are at right angles; false where they are not, or one has no length.
bool single(const dmat4& matrix, layers::Transform& t) {
  dvec3 axis[3] = {dvec3(matrix[0]), dvec3(matrix[1]), dvec3(matrix[2])};
  for (int k = 0; k < 3; ++k) {
    t.scale[k] = glm::length(axis[k]);
    if (!(t.scale[k] > 0)) return false;
    axis[k] /= t.scale[k];
  }
  for (int k = 0; k < 3; ++k)
    if (std::abs(glm::dot(axis[k], axis[(k + 1) % 3])) > kOrthogonal) return false;
  if (glm::determinant(dmat3(axis[0], axis[1], axis[2])) < 0) t.scale.x = -t.scale.x, axis[0] = -axis[0];
  t.translation = dvec3(matrix[3]);
  t.rotation = rotation_of(axis[0], axis[1], axis[2]);
  return true;
}

layers::Transform parts_of_transform(const Json& node) {
  layers::Transform t;
  const auto place = numbers_of(node, "translation", 3, {0, 0, 0});
  const auto turn = numbers_of(node, "rotation", 4, {0, 0, 0, 1});
  const auto scale = numbers_of(node, "scale", 3, {1, 1, 1});
  t.translation = {place[0], place[1], place[2]};
  t.rotation = glm::dquat(turn[3], turn[0], turn[1], turn[2]);
  const double length = glm::length(t.rotation);
  t.rotation = length > 1e-12 ? t.rotation / length : glm::dquat(1, 0, 0, 0);
  t.scale = {scale[0], scale[1], scale[2]};
  return t;
}

// --- Names

/// What tells something about a node: its name, or that of what it carries.
std::string name_of(const GltfImport& import, const Json& node, int index) {
  std::string own = text_of(node, "name");
  if (!own.empty()) return own;
  for (const char* kind : {"mesh", "camera", "skin"}) {
    const int used = index_of(node, kind);
    if (used < 0) continue;
    const std::string plural = std::string(kind) + (std::string(kind) == "mesh" ? "es" : "s");
    std::string name = text_of(item_of(import.file, plural.c_str(), used), "name");
    if (!name.empty()) return name;
  }
  return "node " + std::to_string(index);
}

// --- The tree

class Tree {
 public:
  explicit Tree(GltfImport& import) : import_(import) {}

  void add(int index, int parent, const std::string& above, int depth) {
    if (depth > kMaxNodeDepth)
      throw InputError("nodes are nested deeper than " + std::to_string(kMaxNodeDepth));
    const Json& node = item_of(import_.file, "nodes", index);
    if (import_.nodes.contains(index))
      throw InputError("glTF: node " + std::to_string(index) +
                       " is in the scene twice, rule: the nodes are a tree");
    GltfNode& place = import_.nodes[index];
    const std::string name = name_of(import_, node, index);
    place.path = unused(above.empty() ? name : above + "/" + name);
    add_places(node, name, parent, place);
    if (const Json& extras = object_or_none(node); extras.contains("layer") && extras["layer"].is_string())
      import_.model.layer_tags.push_back({place.inner, extras["layer"].get<std::string>()});
    import_gltf_parts(import_, index);
    const GltfNode own = place;
    for (const Json& child : list_of(node, "children")) {
      if (!child.is_number_integer()) throw InputError("glTF: a child of a node is no whole number");
      add(child.get<int>(), own.inner, own.path, depth + 1);
    }
  }

 private:
  static const Json& object_or_none(const Json& node) {
    static const Json kNone = Json::object();
    const auto extras = node.find("extras");
    return extras != node.end() && extras->is_object() ? *extras : kNone;
  }

  std::string unused(const std::string& path) {
    std::string name = path;
    for (int k = 2; !used_.insert(name).second; ++k) name = path + "#" + std::to_string(k);
    return name;
  }

  int push(const std::string& name, int parent, const layers::Transform& local) {
    import_.model.scene.nodes.push_back({name, parent, local});
    return static_cast<int>(import_.model.scene.nodes.size()) - 1;
  }

  void add_places(const Json& node, const std::string& name, int parent, GltfNode& place) {
    const auto given = numbers_of(node, "matrix", 16, {});
    layers::Transform outer = parts_of_transform(node), inner;
    dmat4 matrix(1.0);
    for (std::size_t k = 0; k < given.size(); ++k)
      matrix[static_cast<int>(k / 4)][static_cast<int>(k % 4)] = given[k];
    const bool whole = given.empty() || single(matrix, outer);
    if (!whole) split(matrix, outer = {}, inner = {});
    place.outer = place.inner = push(name, parent, outer);
    if (!whole) place.inner = push(name, place.outer, inner);
  }

  GltfImport& import_;
  std::set<std::string> used_;
};

std::vector<int> roots_of(GltfImport& import) {
  std::vector<int> roots;
  const Json& scenes = list_of(import.file.json, "scenes");
  if (!scenes.empty()) {
    const int chosen = std::max(0, index_of(import.file.json, "scene"));
    const Json& scene = item_of(import.file, "scenes", chosen);
    for (const Json& node : list_of(scene, "nodes"))
      if (node.is_number_integer()) roots.push_back(node.get<int>());
    if (scenes.size() > 1)
      import.warn(std::to_string(scenes.size()) + " scenes; only '" +
                  text_of(scene, "name", "scene " + std::to_string(chosen)) + "' is drawn");
    return roots;
  }
  const Json& nodes = list_of(import.file.json, "nodes");
  std::vector<bool> is_child(nodes.size(), false);
  for (const Json& node : nodes)
    for (const Json& child : list_of(node, "children"))
      if (child.is_number_unsigned() && child.get<std::size_t>() < nodes.size())
        is_child[child.get<std::size_t>()] = true;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (!is_child[i]) roots.push_back(static_cast<int>(i));
  return roots;
}

// --- Cameras

[[noreturn]] void refuse_lens(const layers::Camera& camera, const std::string& key, double value,
                              const std::string& rule) {
  throw InputError("glTF: camera '" + camera.name + "' has " + key + " " + formatted("%g", value) +
                   ", rule: " + rule);
}

/// glTF 2.0, 5.13: zfar, where it is there, is greater than znear.
void check_planes(const Json& lens, double least_near, bool near_may_be_least, const layers::Camera& camera) {
  const double znear = number_of(lens, "znear", HUGE_VAL), zfar = number_of(lens, "zfar", HUGE_VAL);
  if (!(znear > least_near || (near_may_be_least && znear == least_near)))
    refuse_lens(camera, "znear", znear, near_may_be_least ? "at least 0" : "above 0");
  if (lens.contains("zfar") && lens.contains("znear") && !(zfar > znear))
    refuse_lens(camera, "zfar", zfar, "greater than znear, " + formatted("%g", znear));
}

void set_perspective(GltfImport& import, const Json& lens, layers::Camera& camera) {
  constexpr double kDefaultNear = 0.1;
  check_planes(lens, 0, false, camera);
  const double fov = number_of(lens, "yfov", camera.fov_y_rad);
  if (!(fov > 0 && fov < std::numbers::pi)) refuse_lens(camera, "yfov", fov, "above 0 and below pi");
  if (!lens.contains("yfov")) import.warn("camera '" + camera.name + "' has no yfov; 0.9 is taken");
  camera.fov_y_rad = fov;
  camera.near_m = number_of(lens, "znear", kDefaultNear);
  camera.far_m = number_of(lens, "zfar", 0);
  if (!(camera.far_m > camera.near_m)) camera.far_m = kFarthest * camera.near_m;
  if (!lens.contains("zfar")) return;
  if (const std::string cut = beyond_far_plane(import.model.scene, camera); !cut.empty()) import.warn(cut);
}

void check_rectangle(const Json& lens, const layers::Camera& camera) {
  check_planes(lens, 0, true, camera);
  for (const char* side : {"xmag", "ymag"})
    if (number_of(lens, side, 1) == 0) refuse_lens(camera, side, 0, "not 0");
}

layers::WorldBounds bounds_of(const layers::Scene& scene) {
  layers::WorldBounds bounds;
  const layers::SceneFrame frame = scene.at(0);
  for (const layers::Part& part : scene.parts)
    for (const dvec3& p : layers::world_positions(frame, part)) {
      bounds.lo = glm::min(bounds.lo, p);
      bounds.hi = glm::max(bounds.hi, p);
    }
  return bounds;
}

/// Stands far behind the camera and sees its rectangle at the distance of the middle of the scene.
void set_long_lens(GltfImport& import, const Json& lens, layers::Camera& camera) {
  check_rectangle(lens, camera);
  layers::Scene& scene = import.model.scene;
  const layers::WorldBounds bounds = bounds_of(scene);
  const dvec3 middle = bounds.empty() ? dvec3(0) : 0.5 * (bounds.lo + bounds.hi);
  const double radius = bounds.empty() ? 1 : std::max(1e-6, 0.5 * glm::length(bounds.hi - bounds.lo));
  const dmat4 world = scene.at(0).world_from_node[static_cast<std::size_t>(camera.node)];
  const double ahead = -glm::dot(dvec3(world[2]) / glm::length(dvec3(world[2])), middle - dvec3(world[3]));
  const double back = kLongLens * std::max(radius, std::abs(number_of(lens, "ymag", 1)));
  layers::Node view;
  view.name = scene.nodes[static_cast<std::size_t>(camera.node)].name;
  view.parent = camera.node;
  view.local.translation = {0, 0, (back - ahead) / glm::length(dvec3(world[2]))};
  scene.nodes.push_back(view);
  camera.node = static_cast<int>(scene.nodes.size()) - 1;
  camera.fov_y_rad = 2 * std::atan(std::abs(number_of(lens, "ymag", 1)) / back);
  const double moved = back - ahead;
  camera.near_m = std::max(moved + number_of(lens, "znear", 0), 1e-3 * back);
  camera.far_m = std::max(moved + number_of(lens, "zfar", 0), camera.near_m + 4 * radius);
  import.model.notes.push_back("the orthographic camera '" + camera.name + "' is drawn by a lens of " +
                               std::to_string(static_cast<int>(kLongLens)) + " scene radii");
}

void import_camera(GltfImport& import, int index, const GltfNode& place) {
  const Json& from = item_of(import.file, "cameras", index);
  layers::Camera camera;
  camera.name = text_of(from, "name", place.path);
  camera.node = place.inner;
  const std::string type = text_of(from, "type");
  if (type == "orthographic") {
    set_long_lens(import, object_of(from, "orthographic"), camera);
  } else {
    set_perspective(import, object_of(from, "perspective"), camera);
  }
  import.model.scene.cameras.push_back(camera);
}

void warn_of_lacks(GltfImport& import) {
  constexpr std::size_t kNamed = 3;
  for (const auto& [what, whose] : import.lacking) {
    std::string text = what;
    for (std::size_t k = 0; k < std::min(kNamed, whose.size()); ++k)
      text += (k == 0 ? ": '" : ", '") + whose[k] + "'";
    if (whose.size() > kNamed) text += " and " + std::to_string(whose.size() - kNamed) + " more";
    import.warn(text);
  }
}

}  // namespace

void GltfImport::lacks(const std::string& what, const std::string& whose) {
  std::vector<std::string>& names = lacking[what];
  if (!whose.empty() && std::find(names.begin(), names.end(), whose) == names.end()) names.push_back(whose);
}

void import_gltf_nodes(GltfImport& import) {
  Tree tree(import);
  for (const int root : roots_of(import)) tree.add(root, -1, "", 0);
}

bool is_gltf2(const std::string& path) {
  const std::string extension = lower_extension(path);
  if (extension != ".gltf" && extension != ".glb" && extension != ".vrm") return false;
  return !is_gltf1(path);
}

ImportedModel read_gltf(const ModelPlace& place) {
  GltfImport import(read_gltf_file(place));
  import.file.uses.add_code();
  for (const std::string& name : gltf_extensions_not_read(import.file))
    import.warn("extension " + name + " is not drawn");
  import_gltf_materials(import);
  find_animated_morphs(import);
  import_gltf_nodes(import);
  import_gltf_skins(import);
  if (import.model.scene.parts.empty()) {
    const bool other =
        import.lacking.contains("points are not drawn") || import.lacking.contains("lines are not drawn");
    throw InputError(std::string("has no triangles") + (other ? ", only points or lines" : "") +
                     ", rule: a model has at least one");
  }
  import_gltf_motion(import);
  if (const std::string defect = layers::first_defect(import.model.scene); !defect.empty())
    throw InputError(defect);
  import_gltf_lights(import);
  for (const auto& [index, place] : std::map<int, GltfNode>(import.nodes))
    if (const int camera = index_of(item_of(import.file, "nodes", index), "camera"); camera >= 0)
      import_camera(import, camera, place);
  warn_of_lacks(import);
  import.model.files = import.file.uses.take();
  return std::move(import.model);
}

}  // namespace talisman::sequences
