// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A room in which every shading effect can be switched on, one by one, for the tests of shade layers.

#include <cmath>
#include <vector>

#include "layers/layer.h"
#include "tests/support/scenes.h"

namespace talisman::tests {

using layers::dvec3;
using layers::LayerPreferences;
using layers::LayerSet;
using layers::LayerSpec;
using layers::Light;
using layers::Node;
using layers::Scene;
using layers::ShadingSpec;
using layers::SpinTrack;
using layers::vec3;

/// A floor of 8 m that faces up at y = 0, a ball above it, a camera and a spot light that look at both.
struct Room {
  Scene scene;
  std::vector<LayerSpec> specs;

  Room() {
    scene.meshes = {quad_mesh(8, 2), sphere_mesh(8, 12, 0.5)};
    scene.textures = {checker_texture()};
    scene.materials.resize(2);
    scene.materials[0].name = "boards";
    scene.materials[1].name = "red";
    Node floor, ball, eye, lamp;
    floor.name = "floor";
    floor.local.rotation = glm::angleAxis(-M_PI / 2, dvec3(1, 0, 0));
    ball.name = "ball";
    ball.local.translation = {0, 1, 0};
    eye.name = "eye";
    eye.local.translation = {0, 2, 6};
    eye.local.rotation = glm::angleAxis(-0.3, dvec3(1, 0, 0));
    lamp.name = "lamp";
    lamp.local.translation = {1, 4, 1};
    scene.nodes = {floor, ball, eye, lamp};
    scene.parts = {{"floor", 0, 0, 0, -1}, {"ball", 1, 1, 1, -1}};
    scene.cameras.emplace_back();
    scene.cameras[0].node = 2;
    Light light;
    light.name = "lamp";
    light.kind = Light::Kind::Spot;
    light.node = 3;
    scene.lights = {light};
    specs = one_layer_per_part(scene);
  }

  Room& casting() {
    scene.lights[0].casts_shadow = true;
    return *this;
  }
  Room& mirroring() {
    scene.materials[0].reflectivity = 0.3f;
    return *this;
  }
  Room& shining() {
    scene.materials[0].specular = vec3(0.5f);
    return *this;
  }
  Room& textured_twice() {
    scene.materials[0].texture = scene.materials[0].texture2 = 0;
    return *this;
  }
  Room& factored() {
    ShadingSpec& shading = specs[0].shading;
    shading.shadows = shading.specular = shading.reflection = shading.textures = LayerPreferences{};
    return *this;
  }
  Room& spinning(int node) {
    scene.tracks.push_back({node, SpinTrack{{0, 0, 1}, 1}});
    return *this;
  }

  LayerSet layers() const { return factor(scene, specs); }
};

}  // namespace talisman::tests
