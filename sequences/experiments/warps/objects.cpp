// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/warps/objects.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <sstream>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_inverse.hpp>

#include "layers/check.h"
#include "sequences/content/asset_paths.h"
#include "sequences/files/program_folder.h"
#include "sequences/import/model_import.h"

namespace talisman::sequences {
namespace {

using layers::dvec3;
using layers::Mesh;
using layers::vec2;
using layers::vec3;

constexpr double kFlat = 0.05;  // [LS97 4.2], footnote 6

// --- Meshes

/// A grid of cells × rows quadrilaterals over (u, v) in 0 … 1.
void add_grid(Mesh& mesh, int columns, int rows, const std::function<vec3(double, double)>& point) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const auto index = [&](int i, int j) { return first + static_cast<std::uint32_t>(j * (columns + 1) + i); };
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const double u = i / static_cast<double>(columns), v = j / static_cast<double>(rows);
      mesh.positions.push_back(point(u, v));
      mesh.uvs.emplace_back(static_cast<float>(u), static_cast<float>(v));
    }
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      for (const std::uint32_t k : {index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j),
                                    index(i + 1, j + 1), index(i, j + 1)})
        mesh.indices.push_back(k);
}

/// Means of the triangles' normals, weighted by area; a vertex without any keeps +y.
void add_smooth_normals(Mesh& mesh) {
  std::vector<dvec3> sums(mesh.positions.size(), dvec3(0));
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const std::array<std::uint32_t, 3> k{mesh.indices[t], mesh.indices[t + 1], mesh.indices[t + 2]};
    const dvec3 a = mesh.positions[k[0]], b = mesh.positions[k[1]], c = mesh.positions[k[2]];
    for (const std::uint32_t vertex : k) sums[vertex] += glm::cross(b - a, c - a);
  }
  mesh.normals.clear();
  for (const dvec3& sum : sums) {
    const double length = glm::length(sum);
    mesh.normals.push_back(length > 0 ? vec3(sum / length) : vec3(0, 1, 0));
  }
}

/// Centre of the bounding box to the origin, farthest vertex to 1 m.
void normalise(Mesh& mesh) {
  dvec3 lo(HUGE_VAL), hi(-HUGE_VAL);
  for (const vec3& p : mesh.positions) lo = glm::min(lo, dvec3(p)), hi = glm::max(hi, dvec3(p));
  const dvec3 centre = (lo + hi) / 2.0;
  double radius = 0;
  for (const vec3& p : mesh.positions) radius = std::fmax(radius, glm::length(dvec3(p) - centre));
  const double scale = radius > 0 ? 1 / radius : 1;
  for (vec3& p : mesh.positions) p = vec3((dvec3(p) - centre) * scale);
}

void flatten_along_z(Mesh& mesh) {
  for (vec3& p : mesh.positions) p.z *= static_cast<float>(kFlat);
  add_smooth_normals(mesh);
}

Mesh box() {
  Mesh mesh;
  const std::array<dvec3, 3> half{dvec3(1, 0, 0), dvec3(0, 0.75, 0), dvec3(0, 0, 0.6)};
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0})
      add_grid(mesh, 4, 4, [&](double u, double v) {
        const dvec3 across = side * (2 * u - 1) * half[(axis + 1) % 3],
                    up = (2 * v - 1) * half[(axis + 2) % 3];
        return vec3(side * half[axis] + across + up);
      });
  add_smooth_normals(mesh);
  return mesh;
}

/// A profile turned about y: foot, belly, neck and lip.
Mesh vase() {
  Mesh mesh;
  add_grid(mesh, 48, 32, [](double u, double v) {
    const double angle = -2 * std::numbers::pi * u,
                 radius = 0.32 + 0.2 * std::sin(2 * std::numbers::pi * v + 0.3) - 0.06 * v;
    return vec3(radius * std::cos(angle), 2 * v - 1, radius * std::sin(angle));
  });
  add_smooth_normals(mesh);
  return mesh;
}

// --- Files

[[noreturn]] void bad_patches(const std::string& file, const std::string& what) {
  throw InputError(what, file);
}

std::vector<dvec3> control_points(const std::string& file) {
  std::ifstream in(file);
  std::string header;
  if (!(in >> header)) bad_patches(file, "cannot be read, rule: BEZ patches as plain text");
  if (header != "BBP") bad_patches(file, "header '" + header + "', rule: BBP (bicubic patches in space)");
  std::vector<double> numbers;
  for (double v; in >> v;) {
    if (!std::isfinite(v)) bad_patches(file, "a coordinate is not finite");
    numbers.push_back(v);
  }
  if (!in.eof()) bad_patches(file, "number " + std::to_string(numbers.size() + 1) + " cannot be read");
  if (numbers.empty() || numbers.size() % 48 != 0)
    bad_patches(file,
                std::to_string(numbers.size()) + " coordinates, rule: 48 for each of 1 or more patches");
  std::vector<dvec3> points;
  for (std::size_t i = 0; i < numbers.size(); i += 3)
    points.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
  return points;
}

std::array<double, 4> bernstein(double t) {
  const double s = 1 - t;
  return {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
}

/// All parts of a model as one mesh, as they are at time 0, without their materials.
Mesh flattened(const layers::Scene& scene) {
  Mesh mesh;
  const layers::SceneFrame frame = scene.at(0);
  for (const layers::Part& part : scene.parts) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const dvec3& p : layers::world_positions(frame, part)) mesh.positions.emplace_back(p);
    for (const std::uint32_t index : scene.meshes[part.mesh].indices) mesh.indices.push_back(first + index);
  }
  add_smooth_normals(mesh);
  return mesh;
}

Mesh read_mesh(const std::string& file) {
  Mesh mesh = std::filesystem::path(file).extension() == ".bez" ? read_bezier_patches(file)
                                                                : flattened(import_model(file).scene);
  if (mesh.indices.empty()) throw InputError("has no triangles", file);
  normalise(mesh);
  return mesh;
}

struct ShippedObject {
  const char* name;
  const char* title;
  const char* asset;  ///< empty: built in
  Mesh (*build)();
  bool flat;
};

constexpr std::array kShipped = {
    ShippedObject{"teapot", "teapot", "geomview:/usr/share/geomview/geom/teapot.bez", nullptr, false},
    ShippedObject{"flat-teapot", "flat teapot", "geomview:/usr/share/geomview/geom/teapot.bez", nullptr,
                  true},
    ShippedObject{"bunny", "bunny", "glmark2-data:/usr/share/glmark2/models/bunny.obj", nullptr, false},
    ShippedObject{"asteroid", "asteroid", "glmark2-data:/usr/share/glmark2/models/asteroid-low.3ds", nullptr,
                  false},
    ShippedObject{"fighter", "fighter", "gl-117-data:/usr/share/games/gl-117/models/gl-14.3ds", nullptr,
                  false},
    ShippedObject{"vase", "vase", "", vase, false},
    ShippedObject{"box", "box", "", box, false},
    ShippedObject{"flat-box", "flat box", "", box, true},
};

const ShippedObject* find_shipped(const std::string& name) {
  for (const ShippedObject& object : kShipped)
    if (name == object.name) return &object;
  return nullptr;
}

std::string file_of(const ShippedObject& object) {
  try {
    return resolve_asset(object.asset, data_folder() + "/sequences/warps/packages");
  } catch (const InputError&) {
    throw InputError("object '" + std::string(object.name) + "': " + object.asset +
                     " is not there, rule: content is fetched first, by " + fetch_command("warps"));
  }
}

WarpObject load_shipped(const ShippedObject& shipped) {
  WarpObject object{shipped.name, shipped.title, {}};
  object.mesh = shipped.build ? shipped.build() : read_mesh(file_of(shipped));
  normalise(object.mesh);
  if (shipped.flat) flatten_along_z(object.mesh);
  object.mesh.name = shipped.name;
  return object;
}

// --- Motions

using Rotations = layers::Keys<glm::dquat>;

glm::dquat turn(const dvec3& axis, double degrees) {
  return glm::angleAxis(degrees * std::numbers::pi / 180, glm::normalize(axis));
}

layers::Track keyed(int node, layers::Keys<dvec3> translation, Rotations rotation) {
  return {node, layers::TransformTrack{std::move(translation), std::move(rotation), {}, false}};
}

/// Turning by 72° about an axis that is none of the object's own, so that the turn has parts in and out of
/// the display, while crossing the display and coming nearer.
WarpMotion rotate_translate() {
  const dvec3 axis(1, 1, 1);
  return {"rotate-translate",
          "rotating and translating",
          {keyed(kObjectNode,
                 {{0, 5, 10},
                  {{-1.1, 0.5, -7}, {0.1, -0.2, -5.5}, {0.7, 0.1, -4.5}},
                  layers::Interpolation::CatmullRom},
                 {{0, 5, 10},
                  {turn(axis, -36), glm::dquat(1, 0, 0, 0), turn(axis, 36)},
                  layers::Interpolation::Linear})}};
}

WarpMotion head_turn() {
  const dvec3 up(0, 1, 0);
  return {"head-turn",
          "head turning, object at rest",
          {keyed(kCameraNode, {},
                 {{0, 5, 10},
                  {turn(up, -9), turn(dvec3(1, 0, 0), 4), turn(up, 9)},
                  layers::Interpolation::Linear})}};
}

WarpMotion translate() {
  return {"translate",
          "translating without rotation",
          {keyed(kObjectNode,
                 {{0, 5, 10},
                  {{-1.2, 0.5, -8}, {0.1, -0.3, -6}, {0.7, 0.2, -4.5}},
                  layers::Interpolation::CatmullRom},
                 {})}};
}

WarpMotion spin(int axis, int degrees_per_s) {
  dvec3 direction(0);
  direction[axis] = 1;
  const std::string letter(1, "xyz"[axis]), rate = std::to_string(degrees_per_s);
  return {"spin-" + letter + "-" + rate,
          "rotating about " + letter + " at " + rate + " degrees per second",
          {{kObjectNode, layers::SpinTrack{direction, degrees_per_s * std::numbers::pi / 180}}}};
}

/// sRGB checkers of 8 × 8 fields: detail on which an error of a pixel can be seen.
layers::Texture checkers() {
  constexpr int kFields = 8, kTexels = 8, kSide = kFields * kTexels;
  layers::Texture texture{"checkers", kSide, kSide, {}, false};
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const std::uint8_t grey = (x / kTexels + y / kTexels) % 2 ? 235 : 90;
      texture.rgba.insert(texture.rgba.end(), {grey, grey, grey, 255});
    }
  return texture;
}

void add_lights(layers::Scene& scene) {
  layers::Light ambient, sun;
  ambient.name = "ambient";
  ambient.kind = layers::Light::Kind::Ambient;
  ambient.color = vec3(0.25f);
  sun.name = "sun";
  sun.direction = {-0.4, -0.7, -0.6};
  sun.color = vec3(0.8f);
  scene.lights = {ambient, sun};
}

}  // namespace

std::vector<std::string> warp_object_names() {
  std::vector<std::string> names;
  for (const ShippedObject& object : kShipped) names.emplace_back(object.name);
  return names;
}

WarpObject load_warp_object(const std::string& name_or_file) {
  if (const ShippedObject* shipped = find_shipped(name_or_file)) return load_shipped(*shipped);
  std::error_code error;
  if (std::filesystem::is_regular_file(name_or_file, error)) {
    const std::string stem = std::filesystem::path(name_or_file).stem().string();
    return {stem, stem, read_mesh(name_or_file)};
  }
  std::string known;
  for (const std::string& name : warp_object_names()) known += " " + name;
  throw InputError("object '" + name_or_file + "', rule: a file, or one of" + known);
}

std::vector<WarpObject> load_warp_objects(std::vector<MissingObject>& missing) {
  std::vector<WarpObject> objects;
  for (const ShippedObject& shipped : kShipped) {
    try {
      objects.push_back(load_shipped(shipped));
    } catch (const InputError& error) {
      missing.push_back({shipped.name, error.what()});
    }
  }
  return objects;
}

Mesh read_bezier_patches(const std::string& file, int cells) {
  TALISMAN_CHECK_GE(cells, 1);
  const std::vector<dvec3> control = control_points(file);
  Mesh mesh;
  for (std::size_t patch = 0; patch < control.size(); patch += 16)
    add_grid(mesh, cells, cells, [&](double u, double v) {
      const auto a = bernstein(u), b = bernstein(v);
      dvec3 p(0);
      for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) p += a[i] * b[j] * control[patch + 4 * j + i];
      return vec3(static_cast<float>(p.x), static_cast<float>(p.z), static_cast<float>(-p.y));
    });
  add_smooth_normals(mesh);
  return mesh;
}

std::vector<WarpMotion> warp_motions() {
  std::vector<WarpMotion> motions{rotate_translate(), head_turn(), translate()};
  for (int axis = 0; axis < 3; ++axis)
    for (const int degrees_per_s : {5, 20, 80}) motions.push_back(spin(axis, degrees_per_s));
  return motions;
}

layers::Scene stage(const WarpObject& object, const WarpMotion& motion) {
  layers::Scene scene;
  scene.background = vec3(0.12f, 0.15f, 0.2f);
  scene.nodes = {{"camera", -1, {}}, {"object", -1, {{0, 0, -5}, {1, 0, 0, 0}, {1, 1, 1}}}};
  scene.cameras = {{"camera", kCameraNode, std::numbers::pi / 4, 0.05, 100}};
  scene.tracks = motion.tracks;
  scene.meshes = {object.mesh};
  layers::Material material;
  material.name = "object";
  material.base_color = vec3(0.8f, 0.72f, 0.6f);
  material.two_sided = true;
  if (!object.mesh.uvs.empty()) {
    scene.textures = {checkers()};
    material.texture = 0;
  }
  scene.materials = {material};
  scene.parts = {{"object", kObjectNode, 0, 0, -1}};
  add_lights(scene);
  return scene;
}

}  // namespace talisman::sequences
