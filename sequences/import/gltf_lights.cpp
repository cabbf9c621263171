// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include <glm/geometric.hpp>

#include "layers/layer.h"
#include "sequences/import/gltf_scene.h"

namespace talisman::sequences {

namespace {

using layers::dvec3;
using layers::Light;

constexpr double kWidestCone_rad = std::numbers::pi / 2;  ///< a half-space
constexpr double kLeastDistance = 0.1;                    ///< of a part's radius

void read_cone(GltfImport& import, const Json& from, Light& light) {
  const Json& spot = object_of(from, "spot");
  const double inner = number_of(spot, "innerConeAngle", 0);
  const double outer = number_of(spot, "outerConeAngle", std::numbers::pi / 4);
  light.outer_cone_rad = std::clamp(outer, 0.0, kWidestCone_rad);
  if (inner > outer)
    throw InputError("cannot be read as a model: light '" + light.name + "' has innerConeAngle " +
                     std::to_string(inner) + ", rule: at most outerConeAngle, " + std::to_string(outer));
  light.inner_cone_rad = std::clamp(inner, 0.0, light.outer_cone_rad);
  if (light.outer_cone_rad > 0) return;
  import.warn("light '" + light.name + "' is a spot without an angle; it shines into a half-space");
  light.outer_cone_rad = light.inner_cone_rad = kWidestCone_rad;
}

void read_light(GltfImport& import, const Json& from, const GltfNode& place) {
  Light light;
  light.name = text_of(from, "name", place.path);
  light.node = place.inner;
  light.direction = {0, 0, -1};
  const std::string type = text_of(from, "type");
  const auto color = numbers_of(from, "color", 3, {1, 1, 1});
  const double intensity = std::max(0.0, number_of(from, "intensity", 1));
  for (int k = 0; k < 3; ++k) light.color[k] = static_cast<float>(std::max(0.0, color[k]) * intensity);
  if (type == "directional") {
    light.kind = Light::Kind::Directional;
  } else if (type == "point" || type == "spot") {
    light.kind = type == "point" ? Light::Kind::Point : Light::Kind::Spot;
    light.attenuation = {0, 0, 1};  // candela → lux
    light.range_m = std::max(0.0, number_of(from, "range", 0));
    if (type == "spot") read_cone(import, from, light);
  } else {
    return import.warn("light '" + light.name + "' is of the kind '" + type + "', which is not simulated");
  }
  import.model.scene.lights.push_back(light);
}

// --- Exposure

layers::WorldBounds bounds_of(const layers::SceneFrame& frame, const layers::Part& part) {
  layers::WorldBounds bounds;
  for (const dvec3& p : layers::world_positions(frame, part)) {
    bounds.lo = glm::min(bounds.lo, p);
    bounds.hi = glm::max(bounds.hi, p);
  }
  return bounds;
}

double distance_to(const layers::WorldBounds& bounds, const dvec3& p) {
  const double least = kLeastDistance * 0.5 * glm::length(bounds.hi - bounds.lo);
  return std::max({glm::length(p - glm::clamp(p, bounds.lo, bounds.hi)), least, 1e-6});
}

double brightest_channel(const layers::vec3& c) { return std::max({c.x, c.y, c.z}); }

/// Lux on the nearest part that faces the light.
double illuminance(const layers::LightState& light, const std::vector<layers::WorldBounds>& parts) {
  const double intensity = brightest_channel(light.color);
  if (light.kind == Light::Kind::Directional) return intensity;
  double nearest = HUGE_VAL;
  for (const layers::WorldBounds& part : parts)
    if (!part.empty()) nearest = std::min(nearest, distance_to(part, light.position));
  return std::isfinite(nearest) ? intensity * layers::falloff(light, nearest) : 0;
}

/// The largest illuminance becomes 1 on a white surface that faces it; the ratio of the lights stays.
void expose(GltfImport& import) {
  layers::Scene& scene = import.model.scene;
  const layers::SceneFrame frame = scene.at(0);
  std::vector<layers::WorldBounds> parts;
  for (const layers::Part& part : scene.parts) parts.push_back(bounds_of(frame, part));
  double most = 0;
  for (const layers::LightState& light : frame.lights) most = std::max(most, illuminance(light, parts));
  if (!(most > 0 && std::isfinite(1 / most))) return;
  for (Light& light : scene.lights) light.color *= static_cast<float>(1 / most);
  char text[96];
  std::snprintf(text, sizeof text, "the largest illuminance, %.4g lx, is shown as 1 on white", most);
  import.model.notes.push_back(text);
}

}  // namespace

void import_gltf_lights(GltfImport& import) {
  for (const auto& [index, place] : import.nodes) {
    const Json* use = extension_of(item_of(import.file, "nodes", index), "KHR_lights_punctual");
    if (!use) continue;
    const Json* all = extension_of(import.file.json, "KHR_lights_punctual");
    const int light = index_of(*use, "light");
    static const Json kNone = Json::array();
    const Json& lights = all ? list_of(*all, "lights") : kNone;
    if (light < 0 || static_cast<std::size_t>(light) >= lights.size())
      throw InputError("glTF: light " + std::to_string(light) + " is used, rule: below " +
                       std::to_string(lights.size()));
    read_light(import, lights[static_cast<std::size_t>(light)], place);
  }
  if (!import.model.scene.lights.empty()) expose(import);
}

}  // namespace talisman::sequences
