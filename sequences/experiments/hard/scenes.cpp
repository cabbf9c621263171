// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/hard/scenes.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include <glm/gtc/quaternion.hpp>

#include "chunker/reference.h"
#include "chunker/shadow_map.h"
#include "layers/shading.h"
#include "sequences/content/shapes.h"

namespace talisman::sequences {
namespace {

using layers::dvec3;
using layers::Light;
using layers::Scene;
using layers::vec2;
using layers::vec3;

layers::Texture two_greys() {
  layers::Texture texture;
  texture.name = "checker";
  texture.width = texture.height = 64;
  for (int i = 0; i < 64 * 64; ++i) {
    const std::uint8_t grey = (i % 64 / 8 + i / 64 / 8) % 2 == 0 ? 230 : 60;
    texture.rgba.insert(texture.rgba.end(), {grey, grey, grey, 255});
  }
  return texture;
}

layers::Mesh scaled_shape(ShapeContent::Kind kind, dvec3 size, int segments, double scale) {
  ShapeContent shape;
  shape.kind = kind;
  shape.size_m = size;
  shape.segments = segments;
  layers::Mesh mesh = shape_mesh(shape);
  for (vec3& p : mesh.positions) p = vec3(dvec3(p) * scale);
  return mesh;
}

void add_world_lights(Scene& scene, double scale, dvec3 origin) {
  Light ambient, sun, lamp;
  ambient.kind = Light::Kind::Ambient;
  ambient.color = vec3(0.2f);
  sun.direction = {0.4, -1, -0.3};
  sun.color = vec3(0.6f);
  sun.casts_shadow = true;
  sun.shadow.resolution_px = 256;
  lamp.kind = Light::Kind::Point;
  lamp.position = (origin + dvec3(-2, 3, 2)) * scale;
  lamp.color = {0.5f, 0.3f, 0.2f};
  lamp.range_m = 12 * scale;
  scene.lights = {ambient, sun, lamp};
}

void add_world_camera(Scene& scene, double scale, dvec3 origin) {
  layers::FlightTrack flight;
  for (const dvec3& p :
       {dvec3(-5, 2, 8), dvec3(-2.5, 2.6, 7.5), dvec3(0, 3, 7), dvec3(2.5, 2.6, 7.5), dvec3(5, 2, 8)}) {
    flight.position.times_s.push_back(double(flight.position.times_s.size()));
    flight.position.values.push_back((origin + p) * scale);
  }
  flight.position.interpolation = layers::Interpolation::CatmullRom;
  flight.target = {{0}, {(origin + dvec3(0, 1, 0)) * scale}, layers::Interpolation::Linear};
  scene.nodes.emplace_back();
  scene.cameras[0].node = int(scene.nodes.size()) - 1;
  scene.tracks.push_back({scene.cameras[0].node, flight});
}

}  // namespace

Scene hard_view(double fov_rad, double near_m) {
  Scene scene;
  layers::Camera camera;
  camera.fov_y_rad = fov_rad;
  camera.near_m = near_m;
  camera.far_m = near_m * 1e5;
  scene.cameras.push_back(camera);
  return scene;
}

int add_hard_part(Scene& scene, layers::Mesh mesh, const layers::Material& material, dvec3 position) {
  const int index = int(scene.parts.size());
  layers::Node node;
  node.name = mesh.name = "part " + std::to_string(index);
  node.local.translation = position;
  scene.nodes.push_back(node);
  scene.meshes.push_back(std::move(mesh));
  scene.materials.push_back(material);
  layers::Part part;
  part.name = node.name;
  part.node = int(scene.nodes.size()) - 1;
  part.mesh = part.material = index;
  scene.parts.push_back(part);
  return index;
}

layers::Mesh filling_triangle(double depth_m, double repeats) {
  layers::Mesh mesh;
  for (const auto& [x, y] : {std::pair{-3, -3}, {9, -3}, {-3, 9}}) {
    mesh.positions.push_back(vec3(dvec3(x, y, -1) * depth_m));
    mesh.normals.push_back({0, 0, 1});
    mesh.uvs.push_back(vec2(layers::dvec2((x + 1) * 0.5, (1 - y) * 0.5) * repeats));
  }
  mesh.indices = {0, 1, 2};
  return mesh;
}

layers::Mesh level_square(double side_m) {
  return scaled_shape(ShapeContent::Kind::Plane, {1, 1, 1}, 1, side_m);
}

layers::Material hard_material(vec3 color) {
  layers::Material material;
  material.base_color = color;
  return material;
}

Scene hard_world(double scale, dvec3 origin) {
  Scene scene = hard_view(0.9, 0.1 * scale);
  scene.background = {0.3f, 0.45f, 0.7f};
  scene.textures = {two_greys()};
  const auto add = [&](layers::Mesh mesh, vec3 color, dvec3 position) {
    return add_hard_part(scene, std::move(mesh), hard_material(color), (origin + position) * scale);
  };
  const int floor = add(scaled_shape(ShapeContent::Kind::Plane, {12, 1, 12}, 8, scale), vec3(1), {0, 0, 0});
  const int box =
      add(scaled_shape(ShapeContent::Kind::Box, {1, 1, 1}, 1, scale), {0.8f, 0.3f, 0.2f}, {0, 1, 0});
  const int ball =
      add(scaled_shape(ShapeContent::Kind::Sphere, {1, 1, 1}, 20, scale), {0.3f, 0.6f, 0.8f}, {2.2, 1.2, 0});
  scene.materials[floor].texture = 0;
  scene.materials[ball].specular = vec3(0.4f);
  scene.materials[ball].shininess = 20;
  scene.tracks.push_back({scene.parts[box].node, layers::SpinTrack{{1, 2, 0}, 1}});
  scene.tracks.push_back({scene.parts[ball].node, layers::SpinTrack{{0, 1, 0}, 2}});
  add_world_lights(scene, scale, origin);
  add_world_camera(scene, scale, origin);
  return scene;
}

layers::LayerSet layers_of_parts(const Scene& scene) {
  std::vector<layers::LayerSpec> specs;
  for (const layers::Part& part : scene.parts) {
    layers::LayerSpec spec;
    spec.name = part.name;
    spec.part_globs = {part.name};
    specs.push_back(spec);
  }
  return layers::factor(scene, specs);
}

HardPicture draw_hard(const Scene& scene, layers::ivec2 size, const chunker::RenderOptions& options,
                      bool with_reference, double t_s) {
  const layers::SceneFrame frame = scene.at(t_s);
  std::vector<int> parts(scene.parts.size()), casters;
  std::iota(parts.begin(), parts.end(), 0);
  for (const int part : parts)
    if (layers::casts_shadow(scene, scene.parts[part])) casters.push_back(part);
  std::vector<chunker::ShadowMap> maps(scene.lights.size());
  std::vector<const chunker::ShadowMap*> pointers(scene.lights.size(), nullptr);
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (scene.lights[i].casts_shadow) {
      maps[i] = chunker::make_shadow_map(frame, int(i), casters);
      pointers[i] = &maps[i];
    }
  chunker::ShadeInputs inputs;
  inputs.shadow_maps = pointers;
  layers::SpritePlacement placement;
  placement.size_px = size;
  const chunker::PreparedScene prepared(scene, options);
  HardPicture picture;
  picture.linear = chunker::render_linear(prepared, frame, parts, size, placement, options, inputs);
  picture.sprite = chunker::render(prepared, frame, parts, size, placement, options, inputs).sprite;
  if (with_reference)
    picture.reference = chunker::reference::render(prepared, frame, parts, size, placement, options, inputs);
  return picture;
}

chunker::RenderOptions unmerged() {
  chunker::RenderOptions options;
  options.merge_depth = options.merge_color = 0;
  return options;
}

namespace {

/// `see(difference)` for each texel: the largest over its channels.
template <typename See>
void each_difference(const chunker::Sprite& a, const chunker::Sprite& b, See see) {
  for (int y = 0; y < a.size_px().y; ++y)
    for (int x = 0; x < a.size_px().x; ++x) {
      const chunker::Texel p = a.texel(x, y), q = b.texel(x, y);
      see(std::max({std::abs(p.r - q.r), std::abs(p.g - q.g), std::abs(p.b - q.b), std::abs(p.a - q.a)}));
    }
}

}  // namespace

int largest_code_difference(const chunker::Sprite& a, const chunker::Sprite& b) {
  int largest = 0;
  each_difference(a, b, [&](int d) { largest = std::max(largest, d); });
  return largest;
}

double share_that_differs(const chunker::Sprite& a, const chunker::Sprite& b, int allowed) {
  double different = 0;
  each_difference(a, b, [&](int d) { different += d > allowed; });
  return different / (double(a.size_px().x) * a.size_px().y);
}

}  // namespace talisman::sequences
