// SPDX-License-Identifier: Apache-2.0
#include "tests/support/scenes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <variant>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "layers/check.h"

namespace talisman::tests {

using namespace layers;

namespace {

constexpr double kHalfTurn_rad = std::numbers::pi;

void add_cell(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
}

/// Position on the bumpy sphere; periodic in `longitude`, smooth at the poles (the bumps fade with sin²
/// there).
dvec3 sphere_point(double latitude, double longitude, double radius_m, double bumps_m) {
  const double s = std::sin(latitude);
  const double bump = s * s * (std::sin(7 * latitude) + std::sin(6 * longitude)) / 2;
  const dvec3 out{s * std::sin(longitude), std::cos(latitude), s * std::cos(longitude)};
  return (radius_m + bumps_m * bump) * out;
}

dvec3 sphere_normal(double latitude, double longitude, double radius_m, double bumps_m) {
  const double h = 1e-5;
  const auto at = [&](double la, double lo) { return sphere_point(la, lo, radius_m, bumps_m); };
  const dvec3 south = at(latitude + h, longitude) - at(latitude - h, longitude);
  const dvec3 east = at(latitude, longitude + h) - at(latitude, longitude - h);
  const dvec3 normal = glm::cross(south, east);
  const double length = glm::length(normal);
  return length > 0 ? normal / length : glm::normalize(at(latitude, longitude));
}

Node node_at(std::string name, dvec3 translation = {0, 0, 0}, int parent = -1) {
  Node node;
  node.name = std::move(name);
  node.parent = parent;
  node.local.translation = translation;
  return node;
}

int add_node(Scene& scene, Node node) {
  scene.nodes.push_back(std::move(node));
  return static_cast<int>(scene.nodes.size()) - 1;
}

int add_material(Scene& scene, std::string name, vec3 color, int texture = -1) {
  Material material;
  material.name = std::move(name);
  material.base_color = color;
  material.texture = texture;
  scene.materials.push_back(material);
  return static_cast<int>(scene.materials.size()) - 1;
}

int add_checker(Scene& scene) {
  scene.textures.push_back(checker_texture());
  return static_cast<int>(scene.textures.size()) - 1;
}

void add_part(Scene& scene, std::string name, int node, Mesh mesh, int material) {
  mesh.name = name;
  scene.meshes.push_back(std::move(mesh));
  Part part;
  part.name = std::move(name);
  part.node = node;
  part.mesh = static_cast<int>(scene.meshes.size()) - 1;
  part.material = material;
  scene.parts.push_back(part);
}

int add_camera(Scene& scene, dvec3 position, double pitch_rad) {
  Node node = node_at("camera", position);
  node.local.rotation = glm::angleAxis(pitch_rad, dvec3{1, 0, 0});
  Camera camera;
  camera.name = "camera";
  camera.node = add_node(scene, node);
  camera.near_m = 0.1;
  camera.far_m = 100;
  scene.cameras.push_back(camera);
  return camera.node;
}

void add_lights(Scene& scene) {
  Light ambient;
  ambient.name = "sky";
  ambient.kind = Light::Kind::Ambient;
  ambient.color = {0.25f, 0.25f, 0.3f};
  Light sun;
  sun.name = "sun";
  sun.kind = Light::Kind::Directional;
  sun.direction = {-1, -2, -1.5};
  sun.color = {0.8f, 0.78f, 0.7f};
  scene.lights = {ambient, sun};
}

/// A scene of one part at the origin, seen from `camera`.
Scene one_part_scene(const std::string& name, Mesh mesh, bool textured, dvec3 camera, double pitch_rad) {
  Scene scene;
  scene.background = {0.1f, 0.15f, 0.25f};
  const int node = add_node(scene, node_at(name));
  const int texture = textured ? add_checker(scene) : -1;
  const int material = add_material(scene, name, textured ? vec3{1, 1, 1} : vec3{0.7f, 0.7f, 0.7f}, texture);
  add_part(scene, name, node, std::move(mesh), material);
  add_camera(scene, camera, pitch_rad);
  add_lights(scene);
  return scene;
}

/// A square tube without caps around y from 0 to 2 m, 0.3 m wide, with blend weights of joints 0 and 1.
Mesh bar_mesh() {
  constexpr int kRings = 16;
  Mesh mesh;
  for (int ring = 0; ring <= kRings; ++ring) {
    const double y = 2.0 * ring / kRings;
    const double upper = std::clamp((y - 0.5) / 1.0, 0.0, 1.0);
    for (int corner = 0; corner < 4; ++corner) {
      const double angle = kHalfTurn_rad / 4 + corner * kHalfTurn_rad / 2;
      const dvec3 out{std::sin(angle), 0, std::cos(angle)};
      mesh.positions.push_back(vec3(dvec3{0, y, 0} + 0.15 * std::sqrt(2.0) * out));
      mesh.normals.push_back(vec3(out));
      mesh.joints.push_back({0, 1, 0, 0});
      mesh.weights.push_back({static_cast<float>(1 - upper), static_cast<float>(upper), 0, 0});
    }
  }
  for (std::uint32_t ring = 0; ring < kRings; ++ring)
    for (std::uint32_t corner = 0; corner < 4; ++corner) {
      const std::uint32_t a = 4 * ring + corner, b = 4 * ring + (corner + 1) % 4;
      add_cell(mesh, a, b, b + 4, a + 4);
    }
  return mesh;
}

void scale_keys(Keys<dvec3>& keys, double factor) {
  for (dvec3& value : keys.values) value *= factor;
}

void scale_track(Track& track, double factor) {
  if (auto* transform = std::get_if<TransformTrack>(&track.motion))
    scale_keys(transform->translation, factor);
  if (auto* flight = std::get_if<FlightTrack>(&track.motion)) {
    scale_keys(flight->position, factor);
    scale_keys(flight->target, factor);
  }
}

}  // namespace

Mesh cube_mesh(double side_m) {
  Mesh mesh;
  mesh.name = "cube";
  const double h = side_m / 2;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) {
      dvec3 out{0, 0, 0}, right{0, 0, 0};
      out[axis] = sign;
      right[(axis + 1) % 3] = 1;
      const dvec3 up = glm::cross(out, right);
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      for (const auto& [u, v] : {std::pair{0, 1}, {1, 1}, {1, 0}, {0, 0}}) {
        mesh.positions.push_back(vec3(h * (out + (2.0 * u - 1) * right + (1 - 2.0 * v) * up)));
        mesh.normals.push_back(vec3(out));
        mesh.uvs.push_back({static_cast<float>(u), static_cast<float>(v)});
      }
      add_cell(mesh, first, first + 1, first + 2, first + 3);
    }
  return mesh;
}

Mesh quad_mesh(double side_m, int cells, double repeats) {
  TALISMAN_CHECK_GE(cells, 1);
  Mesh mesh;
  mesh.name = "quad";
  for (int row = 0; row <= cells; ++row)
    for (int column = 0; column <= cells; ++column) {
      const double u = static_cast<double>(column) / cells, v = static_cast<double>(row) / cells;
      mesh.positions.push_back(vec3(dvec3{(u - 0.5) * side_m, (0.5 - v) * side_m, 0}));
      mesh.normals.push_back({0, 0, 1});
      mesh.uvs.push_back({static_cast<float>(u * repeats), static_cast<float>(v * repeats)});
    }
  const auto stride = static_cast<std::uint32_t>(cells + 1);
  for (std::uint32_t row = 0; row + 1 < stride; ++row)
    for (std::uint32_t column = 0; column + 1 < stride; ++column) {
      const std::uint32_t top_left = row * stride + column;
      add_cell(mesh, top_left + stride, top_left + stride + 1, top_left + 1, top_left);
    }
  return mesh;
}

Mesh sphere_mesh(int rings, int segments, double radius_m, double bumps_m) {
  TALISMAN_CHECK_GE(rings, 2);
  TALISMAN_CHECK_GE(segments, 3);
  Mesh mesh;
  mesh.name = "sphere";
  for (int ring = 0; ring <= rings; ++ring)
    for (int segment = 0; segment <= segments; ++segment) {
      // The seam repeats segment 0, and a pole is one point, bit by bit.
      const bool pole = ring == 0 || ring == rings;
      const double latitude = kHalfTurn_rad * ring / rings;
      const double longitude = pole ? 0 : 2 * kHalfTurn_rad * (segment % segments) / segments;
      const dvec3 point = pole ? dvec3{0, ring == 0 ? radius_m : -radius_m, 0}
                               : sphere_point(latitude, longitude, radius_m, bumps_m);
      const dvec3 normal =
          pole ? dvec3{0, ring == 0 ? 1 : -1, 0} : sphere_normal(latitude, longitude, radius_m, bumps_m);
      mesh.positions.push_back(vec3(point));
      mesh.normals.push_back(vec3(normal));
      mesh.uvs.push_back({static_cast<float>(segment) / segments, static_cast<float>(ring) / rings});
    }
  const auto stride = static_cast<std::uint32_t>(segments + 1);
  for (std::uint32_t ring = 0; ring < static_cast<std::uint32_t>(rings); ++ring)
    for (std::uint32_t segment = 0; segment + 1 < stride; ++segment) {
      const std::uint32_t a = ring * stride + segment, b = a + stride;
      if (ring + 1 < static_cast<std::uint32_t>(rings))
        mesh.indices.insert(mesh.indices.end(), {a, b, b + 1});
      if (ring > 0) mesh.indices.insert(mesh.indices.end(), {a, b + 1, a + 1});
    }
  return mesh;
}

Texture checker_texture(int cells, int texels_per_cell) {
  Texture texture;
  texture.name = "checker";
  texture.width = texture.height = cells * texels_per_cell;
  for (int y = 0; y < texture.height; ++y)
    for (int x = 0; x < texture.width; ++x) {
      const std::uint8_t grey = (x / texels_per_cell + y / texels_per_cell) % 2 == 0 ? 230 : 60;
      texture.rgba.insert(texture.rgba.end(), {grey, grey, grey, 255});
    }
  return texture;
}

Scene cube_scene() { return one_part_scene("cube", cube_mesh(), false, {0, 0.8, 4}, -0.2); }

Scene textured_quad_scene() { return one_part_scene("quad", quad_mesh(2), true, {0, 0, 3}, 0); }

Scene sphere_scene() { return one_part_scene("sphere", sphere_mesh(24, 48), true, {0, 0.6, 3.5}, -0.17); }

Scene displaced_sphere_scene(int triangles) {
  TALISMAN_CHECK_GE(triangles, 1);
  // A grid of r rings and s segments has 2 s (r - 1) triangles; cells are about square where s = 2 r.
  const int rings = std::max(2, 1 + static_cast<int>(std::lround(std::sqrt(triangles / 4.0))));
  const int segments = std::max(4, static_cast<int>(std::lround(triangles / (2.0 * (rings - 1)))));
  Scene scene = one_part_scene("ball", sphere_mesh(rings, segments, 1, 0.1), true, {0, 0.6, 3.5}, -0.17);
  scene.tracks.push_back({scene.parts[0].node, SpinTrack{{0, 1, 0}, 0.5}});
  return scene;
}

Scene moving_scene() {
  Scene scene;
  scene.background = {0.3f, 0.45f, 0.7f};
  Node ground = node_at("ground");
  ground.local.rotation = glm::angleAxis(-kHalfTurn_rad / 2, dvec3{1, 0, 0});
  const int ground_node = add_node(scene, ground);
  const int cube = add_node(scene, node_at("cube", {0, 1, 0}));
  const int orbit = add_node(scene, node_at("orbit", {0, 1.2, 0}));
  const int moon = add_node(scene, node_at("moon", {2.5, 0, 0}, orbit));
  const int checker = add_checker(scene);
  add_part(scene, "ground", ground_node, quad_mesh(12, 8, 4),
           add_material(scene, "ground", {1, 1, 1}, checker));
  add_part(scene, "cube", cube, cube_mesh(), add_material(scene, "cube", {0.8f, 0.3f, 0.2f}));
  add_part(scene, "orbit/moon", moon, sphere_mesh(12, 24, 0.5),
           add_material(scene, "moon", {0.3f, 0.6f, 0.8f}));
  scene.tracks.push_back({cube, SpinTrack{{1, 2, 0}, 1}});
  scene.tracks.push_back({orbit, SpinTrack{{0, 1, 0}, 0.8}});

  FlightTrack flight;
  flight.position = {{0, 1, 2, 3, 4},
                     {{-5, 2, 8}, {-2.5, 2.6, 7.5}, {0, 3, 7}, {2.5, 2.6, 7.5}, {5, 2, 8}},
                     Interpolation::CatmullRom};
  flight.target = {{0}, {{0, 1, 0}}, Interpolation::Linear};
  scene.tracks.push_back({add_camera(scene, {-5, 2, 8}, 0), flight});
  add_lights(scene);
  return scene;
}

Scene skinned_bar_scene() {
  Scene scene = one_part_scene("bar", bar_mesh(), false, {0, 1, 5}, 0);
  const int lower = add_node(scene, node_at("lower"));
  const int upper = add_node(scene, node_at("upper", {0, 1, 0}, lower));
  Skin skin;
  skin.name = "bar";
  skin.joints = {lower, upper};
  dmat4 upper_from_mesh(1);
  upper_from_mesh[3] = {0, -1, 0, 1};
  skin.joint_from_mesh = {dmat4(1), upper_from_mesh};
  scene.skins.push_back(skin);
  scene.parts[0].skin = 0;
  scene.materials[0].two_sided = true;  // the tube is open at its ends

  TransformTrack bend;
  const glm::dquat straight(1, 0, 0, 0), bent = glm::angleAxis(kHalfTurn_rad / 3, dvec3{0, 0, 1});
  bend.rotation = {{0, 1, 2}, {straight, bent, straight}, Interpolation::Linear};
  bend.loop = true;
  scene.tracks.push_back({upper, bend});
  return scene;
}

Scene scaled(Scene scene, double factor) {
  TALISMAN_CHECK_LT(0, factor);
  for (Mesh& mesh : scene.meshes)
    for (vec3& position : mesh.positions) position = vec3(dvec3(position) * factor);
  for (Node& node : scene.nodes) node.local.translation *= factor;
  for (Track& track : scene.tracks) scale_track(track, factor);
  for (Skin& skin : scene.skins)
    for (dmat4& joint_from_mesh : skin.joint_from_mesh)
      joint_from_mesh[3] = dvec4(dvec3(joint_from_mesh[3]) * factor, 1);
  for (Light& light : scene.lights) light.position *= factor;
  for (Camera& camera : scene.cameras) {
    camera.near_m *= factor;
    camera.far_m *= factor;
  }
  return scene;
}

Scene tiny_scene() { return scaled(moving_scene(), 1e-4); }
Scene huge_scene() { return scaled(moving_scene(), 1e6); }

std::vector<LayerSpec> one_layer_per_part(const Scene& scene) {
  std::vector<LayerSpec> specs;
  for (const Part& part : scene.parts) {
    LayerSpec spec;
    spec.name = part.name;
    spec.part_globs = {part.name};
    specs.push_back(std::move(spec));
  }
  return specs;
}

}  // namespace talisman::tests
