// SPDX-License-Identifier: Apache-2.0
#pragma once

// A scene of ten boxes side by side: the first stands still, each of the others turns faster than the one before. Each
// is a part, "box0" to "box9".
#include <talisman/layers/layer.h>

#include <string>

inline talisman::layers::Mesh box() {
  talisman::layers::Mesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0f, 1.0f}) {
      const auto first = static_cast<unsigned>(mesh.positions.size());
      talisman::layers::vec3 normal{0, 0, 0}, u{0, 0, 0}, v{0, 0, 0};
      normal[axis] = side;
      u[(axis + 1) % 3] = side;
      v[(axis + 2) % 3] = 1;
      for (const auto& corner : {-u - v, u - v, u + v, -u + v}) {
        mesh.positions.push_back(0.5f * (normal + corner));
        mesh.normals.push_back(normal);
      }
      for (const unsigned corner : {0, 1, 2, 0, 2, 3}) mesh.indices.push_back(first + corner);
    }
  return mesh;
}

inline talisman::layers::Scene ten_boxes() {
  using namespace talisman::layers;
  Scene scene;
  scene.meshes = {box()};
  for (int i = 0; i < 10; ++i) {
    Node node{"box" + std::to_string(i), -1, {}};
    node.local.translation = {1.6 * (i % 5) - 3.2, i < 5 ? 0.9 : -0.9, 0};
    scene.nodes.push_back(node);
    if (i > 0) scene.tracks.push_back({i, SpinTrack{{0.2, 1, 0}, 0.1 * i}});
    Material paint;
    paint.base_color = {0.2f + 0.08f * static_cast<float>(i), 0.5f, 0.9f - 0.08f * static_cast<float>(i)};
    scene.materials.push_back(paint);
    scene.parts.push_back({node.name, i, 0, i, -1});
  }
  Node eye{"eye", -1, {}};
  eye.local.translation = {0, 0, 8};
  scene.nodes.push_back(eye);
  scene.cameras = {{"camera", 10, 0.7}};
  Light sky, sun;
  sky.kind = Light::Kind::Ambient;
  sky.color = {0.3f, 0.3f, 0.3f};
  sun.direction = {-0.4, -0.6, -0.7};
  scene.lights = {sky, sun};
  scene.background = {0.02f, 0.02f, 0.03f};
  return scene;
}
