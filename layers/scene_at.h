// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The steps of Scene::at, one thing at a time, as layers/advance.cpp takes them too: the same bits from both.

#include <vector>

#include "layers/scene.h"

namespace talisman::layers {

/// The product, or `above` where it overflows: such a node stays with its parent.
dmat4 world_of_node(const dmat4& above, const Transform& local);

CameraState camera_at(const Scene& scene, const std::vector<dmat4>& worlds);
LightState light_at(const Light& light, const std::vector<dmat4>& worlds);

/// By node; empty where no mesh has morph targets.
std::vector<std::vector<double>> morph_weights_at(const Scene& scene, double t_s);

}  // namespace talisman::layers
