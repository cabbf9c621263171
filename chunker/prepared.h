// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a PreparedScene holds: one pyramid per texture that some part uses, empty ones for the rest.

#include <vector>

#include "chunker/render.h"
#include "chunker/texture.h"
#include "layers/part_box.h"

namespace talisman::chunker {

struct PreparedScene::Impl {
  const layers::Scene* scene = nullptr;
  std::vector<Pyramid> pyramids;       ///< as many as Scene::textures
  std::vector<layers::MeshBox> boxes;  ///< as many as Scene::meshes
  std::vector<Pyramid> normals;  ///< likewise, of normal textures; without any where no part asks for one
};

}  // namespace talisman::chunker
