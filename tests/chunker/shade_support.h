// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A small scene that calls for every shading term: a shiny, mirroring, checkered floor, a cube and a
/// translucent ball over it, an ambient light, a spot and a sun that both cast shadows.

#include <memory>

#include <glm/gtc/quaternion.hpp>

#include "chunker/mirror.h"
#include "chunker/multipass.h"
#include "chunker/shadow_map.h"
#include "tests/chunker/render_support.h"
#include "tests/support/scenes.h"

namespace talisman::chunker::tests {

class ShadeScene {
 public:
  static constexpr int kFloor = 0, kCube = 1, kBall = 2;  ///< parts, meshes, materials and nodes
  static constexpr int kSpot = 1, kSun = 2;               ///< lights

  ShadeScene() {
    namespace content = talisman::tests;
    scene.meshes = {content::quad_mesh(6, 4, 3), content::cube_mesh(), content::sphere_mesh(6, 10, 0.5)};
    scene.textures = {content::checker_texture(4, 8), content::checker_texture(3, 5)};
    scene.nodes.resize(4);
    scene.nodes[kFloor].local.rotation = glm::angleAxis(-std::acos(0.0), dvec3(1, 0, 0));
    scene.nodes[kCube].local.translation = {-0.4, 0.9, 0};
    scene.nodes[kBall].local.translation = {0.9, 0.7, 0.6};
    scene.nodes[3].local.translation = {0, 2.5, 4};
    scene.nodes[3].local.rotation = glm::angleAxis(-0.5, dvec3(1, 0, 0));
    scene.materials.resize(3);
    for (int i = 0; i < 3; ++i) {
      layers::Material& material = scene.materials[i];
      material.base_color = {0.7f, 0.6f - 0.1f * i, 0.4f};
      material.specular = {0.5f, 0.4f, 0.3f};
      material.shininess = 15;
      scene.parts.push_back({"part", i, i, i, -1});
    }
    scene.materials[kFloor].texture = 0;
    scene.materials[kFloor].reflectivity = 0.4f;
    scene.materials[kBall].opacity = 0.6f;
    scene.materials[kCube].emissive = {0.02f, 0, 0};
    scene.lights.resize(3);
    scene.lights[0].kind = layers::Light::Kind::Ambient;
    scene.lights[0].color = vec3(0.2f);
    scene.lights[kSpot].kind = layers::Light::Kind::Spot;
    scene.lights[kSpot].position = {1.5, 4, 1.5};
    scene.lights[kSpot].direction = {-1.5, -4, -1.5};
    scene.lights[kSpot].color = vec3(0.6f);
    scene.lights[kSun].direction = {1, -2, -0.5};
    scene.lights[kSun].color = {0.4f, 0.35f, 0.3f};
    for (const int light : {kSpot, kSun}) {
      scene.lights[light].casts_shadow = true;
      scene.lights[light].shadow.resolution_px = 128;
    }
    layers::Camera camera;
    camera.node = 3;
    scene.cameras.push_back(camera);
  }

  /// Draws the maps and the reflection, and returns what looks them up. Call it after the last change.
  ShadeInputs inputs(ShadeTerm term = ShadeTerm::Full, int light = -1) {
    if (maps_.empty()) prepare();
    ShadeInputs inputs;
    inputs.term = term;
    inputs.light = light;
    inputs.shadow_maps = pointers_;
    mirror_.picture = &reflection_;
    inputs.reflections = {&mirror_, 1};
    return inputs;
  }

  RenderResult render(const ShadeInputs& inputs, const RenderOptions& options = {}) const {
    const PreparedScene prepared(scene);
    return chunker::render(prepared, scene.at(0), all_parts(scene), size, display_placement(size), options,
                           inputs);
  }
  Sprite reference(const ShadeInputs& inputs, const RenderOptions& options = {}) const {
    const PreparedScene prepared(scene);
    return reference::render(prepared, scene.at(0), all_parts(scene), size, display_placement(size), options,
                             inputs);
  }
  LinearImage linear(const ShadeInputs& inputs, const RenderOptions& options = {}) const {
    const PreparedScene prepared(scene);
    return render_linear(prepared, scene.at(0), all_parts(scene), size, display_placement(size), options,
                         inputs);
  }
  LinearImage multipass(const ShadeInputs& inputs, const RenderOptions& options = {}) const {
    const PreparedScene prepared(scene);
    return render_multipass(prepared, scene.at(0), all_parts(scene), size, display_placement(size), options,
                            inputs);
  }

  layers::Scene scene;
  ivec2 size{45, 37};

 private:
  void prepare() {
    const layers::SceneFrame frame = scene.at(0);
    std::vector<int> casters = all_parts(scene);
    casters.erase(casters.begin());  // all but the floor
    maps_.resize(scene.lights.size());
    for (int i = 1; i < static_cast<int>(scene.lights.size()); ++i)
      maps_[i] = make_shadow_map(frame, i, casters);
    for (const ShadowMap& map : maps_) pointers_.push_back(&map);
    const PreparedScene prepared(scene);
    reflection_ = chunker::render(prepared, mirrored_frame(frame, {0, 0, 0}, {0, 1, 0}), casters, size,
                                  display_placement(size))
                      .sprite;
  }

  std::vector<ShadowMap> maps_;
  std::vector<const ShadowMap*> pointers_;
  Sprite reflection_;
  Reflection mirror_;
};

inline constexpr ShadeTerm kAllTerms[] = {ShadeTerm::Full,     ShadeTerm::Base,       ShadeTerm::Shadow,
                                          ShadeTerm::Specular, ShadeTerm::Reflection, ShadeTerm::Texture1,
                                          ShadeTerm::Texture2};

inline std::string name_of(ShadeTerm term) { return "term " + std::to_string(static_cast<int>(term)); }

}  // namespace talisman::chunker::tests
