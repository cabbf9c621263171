// SPDX-License-Identifier: Apache-2.0
#include "layers/light_change.h"

#include <vector>

#include "layers/shading.h"

namespace talisman::layers {
namespace {

int carrier_of(std::span<const int> carriers, int node) { return node >= 0 ? carriers[node] : -1; }

/// A skinned part follows its joints, and deforms.
bool move_against_each_other(const Scene& scene, const Part& part, int other_node,
                             std::span<const int> carriers) {
  return deforms(scene, part) || carrier_of(carriers, part.node) != carrier_of(carriers, other_node);
}

bool is_black(const vec3& c) { return c.x == 0 && c.y == 0 && c.z == 0; }

int camera_node(const Scene& scene) {
  const int camera = scene.active_camera;
  return camera >= 0 && camera < static_cast<int>(scene.cameras.size()) ? scene.cameras[camera].node : -1;
}

}  // namespace

LightChange light_change_of(const Scene& scene, const Layer& layer, std::span<const int> carriers) {
  static const Material plain;
  bool lit = false;
  std::vector<const Light*> sources;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (scene.lights[i].kind != Light::Kind::Ambient && holds_light(scene, layer, static_cast<int>(i)))
      sources.push_back(&scene.lights[i]);
  for (const int index : layer.parts) {
    const Part& part = scene.parts[index];
    const Material& material = part.material >= 0 ? scene.materials[part.material] : plain;
    if (material.unlit) continue;
    lit = true;
    for (const Light* light : sources)
      if (move_against_each_other(scene, part, light->node, carriers))
        return {"part '" + part.name + "' and light '" + light->name + "' move against each other", ""};
    if (!sources.empty() && !is_black(material.specular) &&
        move_against_each_other(scene, part, camera_node(scene), carriers))
      return {"part '" + part.name + "' is specular and moves against the eye", ""};
  }
  if (!lit) return {"", "no part of the layer is lit"};
  if (scene.lights.empty()) return {"", "the scene has no light"};
  if (sources.empty()) return {"", "the only light is ambient"};
  return {"", "no light moves against the layer, and no highlight moves on it"};
}

}  // namespace talisman::layers
