// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/default_view.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "sequences/content/shapes.h"

namespace talisman::sequences {

namespace {

using layers::dvec3;
using layers::Light;

constexpr double kOrbitElevation_rad = 0.3;
constexpr double kOrbitFov_rad = 0.7;
constexpr double kOrbitRoom = 1.08;  // the sphere around all parts fills the picture but for this

constexpr float kKey = 0.65f, kSkyAbove = 0.2f, kSkyAround = 0.28f;
const dvec3 kKeyDirection = glm::normalize(dvec3(-0.4, -0.85, -0.35));
/// Linear; as the square root in 8 bits, as sprites have it, a whole number: ground and backdrop are alike to the
/// last bit.
constexpr float kBackdrop = 128.0f / 255 * 128 / 255;
/// In radii of what stands on it; the shadow of its sphere reaches as far under the key light.
constexpr double kGroundRadius = 2.3;
constexpr double kGroundGap = 2e-3;  // below the lowest point: nothing lies in the ground's plane

int add_node(layers::Scene& scene, const std::string& name, int parent, const layers::Transform& local) {
  scene.nodes.push_back({name, parent, local});
  return static_cast<int>(scene.nodes.size()) - 1;
}

struct Sphere {
  dvec3 center{0};
  double radius = 1;
  double lowest = 0;  ///< y of what is in it
};

Sphere around(const layers::Scene& scene) {
  const layers::WorldBounds bounds = bounds_of_scene(scene);
  if (bounds.empty()) return {};
  const double radius = 0.5 * glm::length(bounds.hi - bounds.lo);
  return {0.5 * (bounds.lo + bounds.hi), radius > 0 ? radius : 1, bounds.lo.y};
}

Light light_of(const char* name, Light::Kind kind, const dvec3& direction, float intensity) {
  Light light;
  light.name = name;
  light.kind = kind;
  light.direction = direction;
  light.color = layers::vec3(intensity);
  return light;
}

void add_daylight(layers::Scene& scene) {
  scene.lights.push_back(light_of("ambient", Light::Kind::Ambient, {0, -1, 0}, 0.25f));
  scene.lights.push_back(light_of("sun", Light::Kind::Directional, {-0.45, -0.75, -0.5}, 0.85f));
}

std::vector<Light> key_and_sky() {
  return {light_of("sky", Light::Kind::Ambient, {0, -1, 0}, kSkyAround),
          light_of("sky above", Light::Kind::Directional, {0, -1, 0}, kSkyAbove),
          light_of("key", Light::Kind::Directional, kKeyDirection, kKey)};
}

StageGround ground_below(const Sphere& all) {
  StageGround ground;
  ground.place = {all.center.x, all.lowest - kGroundGap * all.radius, all.center.z};
  ground.radius_m = kGroundRadius * all.radius;
  const double light = kSkyAround + kSkyAbove - kKey * kKeyDirection.y;
  ground.color = layers::vec3(static_cast<float>(kBackdrop / light));
  return ground;
}

layers::Mesh mesh_of(const StageGround& ground) {
  ShapeContent disc;
  disc.kind = ShapeContent::Kind::Disc;
  disc.size_m = {2 * ground.radius_m, 1, 2 * ground.radius_m};
  disc.segments = ground.segments;
  layers::Mesh mesh = shape_mesh(disc);
  mesh.name = "ground";
  return mesh;
}

void add_ground(layers::Scene& scene, const StageGround& ground, std::vector<layers::LayerSpec>& specs) {
  std::set<std::string> parts, specced;
  for (const layers::Part& part : scene.parts) parts.insert(part.name);
  for (const layers::LayerSpec& spec : specs) specced.insert(spec.name);
  layers::Transform place;
  place.translation = ground.place;
  layers::Part part;
  part.name = unused_name(parts, "ground");
  part.node = add_node(scene, "ground", -1, place);
  part.mesh = static_cast<int>(scene.meshes.size());
  part.material = static_cast<int>(scene.materials.size());
  scene.meshes.push_back(mesh_of(ground));
  layers::Material material;
  material.name = "ground";
  material.base_color = ground.color;
  scene.materials.push_back(material);
  scene.parts.push_back(part);
  layers::LayerSpec spec;
  spec.name = unused_name(specced, "ground");
  spec.part_globs = {part.name};
  spec.shading.shadows = layers::LayerPreferences{};
  // One light casts, so black over is exact; and where there is no shadow the ground is the backdrop to the last bit.
  spec.shading.shadows_as = layers::ShadowsAs::Shade;
  spec.casts_shadows = false;
  specs.push_back(std::move(spec));
}

}  // namespace

std::string unused_name(const std::set<std::string>& used, std::string name) {
  while (used.contains(name)) name += "'";
  return name;
}

Orbit orbit_around(const layers::Scene& scene, double turn_s) {
  const Sphere all = around(scene);
  Orbit orbit;
  orbit.center = all.center;
  orbit.distance_m = kOrbitRoom * all.radius / std::sin(kOrbitFov_rad / 2);
  orbit.elevation_rad = kOrbitElevation_rad;
  orbit.turn_s = turn_s;
  orbit.fov_y_rad = kOrbitFov_rad;
  orbit.near_m = 0.5 * (orbit.distance_m - all.radius);
  orbit.far_m = 2 * (orbit.distance_m + all.radius);
  return orbit;
}

void add_orbit(layers::Scene& scene, const Orbit& orbit) {
  layers::Transform pivot, arm;
  pivot.translation = orbit.center;
  arm.rotation = glm::angleAxis(-orbit.elevation_rad, dvec3(1, 0, 0));
  arm.translation = arm.rotation * dvec3(0, 0, orbit.distance_m);
  const int pivot_node = add_node(scene, "orbit", -1, pivot);
  layers::Camera camera;
  camera.name = "orbit";
  camera.node = add_node(scene, "orbit camera", pivot_node, arm);
  camera.fov_y_rad = orbit.fov_y_rad;
  camera.near_m = orbit.near_m;
  camera.far_m = orbit.far_m;
  scene.tracks.push_back({pivot_node, layers::SpinTrack{{0, 1, 0}, 2 * M_PI / orbit.turn_s}});
  scene.cameras.push_back(camera);
}

layers::WorldBounds bounds_of_part(const layers::SceneFrame& frame, const layers::Part& part) {
  layers::WorldBounds bounds;
  for (const dvec3& p : layers::world_positions(frame, part)) include(bounds, {p, p});
  return bounds;
}

void include(layers::WorldBounds& bounds, const layers::WorldBounds& more) {
  bounds.lo = glm::min(bounds.lo, more.lo);
  bounds.hi = glm::max(bounds.hi, more.hi);
}

layers::WorldBounds bounds_of_scene(const layers::Scene& scene) {
  constexpr int kSteps = 8;
  layers::WorldBounds bounds;
  const double duration = scene.duration_s();
  for (int k = 0; k <= (duration > 0 ? kSteps : 0); ++k) {
    const layers::SceneFrame frame = scene.at(duration * k / kSteps);
    for (const layers::Part& part : scene.parts) include(bounds, bounds_of_part(frame, part));
  }
  return bounds;
}

void add_default_view(layers::Scene& scene, double turn_s) {
  if (scene.cameras.empty()) add_orbit(scene, orbit_around(scene, turn_s));
  if (scene.lights.empty()) add_daylight(scene);
}

ModelStage model_stage(const layers::Scene& scene, const ModelView& view) {
  ModelStage stage;
  const bool lit_by_us = scene.lights.empty();
  if (lit_by_us) stage.lights = key_and_sky();
  if (!scene.cameras.empty()) return stage;
  stage.orbit = orbit_around(scene, view.turn_s);
  if (!view.stage) return stage;
  stage.backdrop = layers::vec3(lit_by_us ? kBackdrop / static_cast<float>(view.exposure_lx) : kBackdrop);
  if (!lit_by_us) return stage;  // other lights would show the ground
  stage.lights.back().casts_shadow = true;
  stage.ground = ground_below(around(scene));
  return stage;
}

void add_model_view(layers::Scene& scene, std::vector<layers::LayerSpec>& specs, const ModelView& view) {
  const ModelStage stage = model_stage(scene, view);
  for (layers::Light light : stage.lights) {
    light.color /= static_cast<float>(view.exposure_lx);
    scene.lights.push_back(std::move(light));
  }
  if (stage.orbit) add_orbit(scene, *stage.orbit);
  if (stage.backdrop) scene.background = *stage.backdrop;
  if (stage.ground) add_ground(scene, *stage.ground, specs);
}

}  // namespace talisman::sequences
