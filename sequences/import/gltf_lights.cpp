// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sequences/import/exposure.h"
#include "sequences/import/gltf_scene.h"
#include "sequences/import/limits.h"

namespace talisman::sequences {

namespace {

using layers::Light;

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
  if (!import.model.scene.lights.empty()) expose_lights(import.model);
}

}  // namespace talisman::sequences
