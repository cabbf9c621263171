// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Scenes of cubes and squares whose right factoring is known, put together by hand. The camera stands at z = 10 and looks
/// along -z unless it is moved; its display is 100 × 100 px and shows 10 m × 10 m in the plane z = 0: a metre there is 10 px.

#include <cmath>
#include <string>
#include <vector>

#include "sequences/content/factoring/factoring.h"
#include "tests/support/scenes.h"

namespace talisman::tests {

using layers::dvec3;

struct FactoredScene {
  layers::Scene scene;
  sequences::Settings settings;

  explicit FactoredScene(int frames = 24) {
    scene.meshes = {cube_mesh(1), quad_mesh(1)};
    scene.materials.resize(1);
    scene.cameras.emplace_back();
    scene.cameras[0].fov_y_rad = 2 * std::atan(0.5);
    scene.cameras[0].near_m = 0.01;
    scene.cameras[0].node = node("eye", {0, 0, 10});
    settings.view.display_px = {100, 100};
    settings.frames = frames;
    settings.fps = 1;  // frame f is at f seconds
    settings.regulator.thresholds.geometric_px = 2;
  }

  int node(const std::string& name, const dvec3& place, int parent = -1) {
    layers::Node node;
    node.name = name;
    node.parent = parent;
    node.local.translation = place;
    scene.nodes.push_back(node);
    return static_cast<int>(scene.nodes.size()) - 1;
  }
  /// A part of its own name at a node of its own. `mesh`: 0 a cube, 1 a square that faces +z, both of 1 m.
  int part(const std::string& name, const dvec3& place, int parent = -1, int mesh = 0,
           const dvec3& scale = dvec3(1)) {
    const int at = node(name, place, parent);
    scene.nodes[at].local.scale = scale;
    scene.parts.push_back({name, at, mesh, 0, -1});
    return at;
  }
  /// Goes from where it is with a constant velocity, m/s, over all frames.
  void moves(int node, const dvec3& velocity) {
    layers::TransformTrack track;
    const double end_s = settings.frames;
    track.translation.times_s = {0, end_s};
    track.translation.values = {scene.nodes[node].local.translation,
                                scene.nodes[node].local.translation + velocity * end_s};
    scene.tracks.push_back({node, track});
  }
  void spins(int node, double rate_rad_per_s) {
    scene.tracks.push_back({node, layers::SpinTrack{{0, 1, 0}, rate_rad_per_s}});
  }
  int eye() const { return scene.cameras[0].node; }

  sequences::FactoringStudy study(int max = sequences::kMostLayersByDefault,
                                  sequences::FactoringWay way = sequences::FactoringWay::Velocity) const {
    return sequences::study({scene, {}, {}, settings}, {way, max});
  }
  /// The names of the parts of each layer of a factoring.
  std::vector<std::vector<std::string>> parts_of(const sequences::Factoring& factoring) const {
    std::vector<std::vector<std::string>> all;
    for (const layers::Layer& layer : layers::factor(scene, factoring.specs).layers) {
      all.emplace_back();
      for (const int part : layer.parts) all.back().push_back(scene.parts[part].name);
    }
    return all;
  }
};

}  // namespace talisman::tests
