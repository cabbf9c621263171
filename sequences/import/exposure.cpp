// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/exposure.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <glm/geometric.hpp>

#include "layers/layer.h"

namespace talisman::sequences {

namespace {

using layers::dvec3;
using layers::Light;

constexpr double kLeastDistance = 0.1;  ///< of a part's radius

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

/// Can a spot reach any of the part? A sphere around the bounds against its cone.
bool is_in_cone(const layers::LightState& light, const layers::WorldBounds& part) {
  const dvec3 to = 0.5 * (part.lo + part.hi) - light.position;
  const double distance = glm::length(to), radius = 0.5 * glm::length(part.hi - part.lo);
  if (distance <= radius) return true;
  const double off_axis = std::acos(std::clamp(glm::dot(to / distance, light.direction), -1.0, 1.0));
  return off_axis - std::asin(radius / distance) <= light.outer_cone_rad;
}

/// Lux on the nearest part that faces the light, and is in its cone.
double illuminance(const layers::LightState& light, const std::vector<layers::WorldBounds>& parts) {
  const double intensity = brightest_channel(light.color);
  if (light.kind == Light::Kind::Directional) return intensity;
  double nearest = HUGE_VAL;
  for (const layers::WorldBounds& part : parts)
    if (!part.empty() && (light.kind != Light::Kind::Spot || is_in_cone(light, part)))
      nearest = std::min(nearest, distance_to(part, light.position));
  return std::isfinite(nearest) ? intensity * layers::falloff(light, nearest) : 0;
}

}  // namespace

void expose_lights(ImportedModel& model) {
  layers::Scene& scene = model.scene;
  const layers::SceneFrame frame = scene.at(0);
  std::vector<layers::WorldBounds> parts;
  for (const layers::Part& part : scene.parts) parts.push_back(bounds_of(frame, part));
  double most = 0;
  for (const layers::LightState& light : frame.lights) most = std::max(most, illuminance(light, parts));
  if (!(most > 0 && std::isfinite(1 / most))) return;
  for (layers::Light& light : scene.lights) light.color *= static_cast<float>(1 / most);
  model.exposure_lx = most;
  char text[96];
  std::snprintf(text, sizeof text, "the largest illuminance, %.4g lx, is shown as 1 on white", most);
  model.notes.push_back(text);
}

}  // namespace talisman::sequences
