// SPDX-License-Identifier: Apache-2.0
#pragma once

/// In which axes and units does a file give its places?
///
/// FBX says its up, front and right axes and its unit in centimetres (UnitScaleFactor); assimp hands them on
/// without applying them.

#include <assimp/scene.h>

#include "layers/scene.h"

namespace talisman::sequences {

/// Takes the place of what is above the root node.
struct FileFrame {
  layers::Transform transform;
};

/// Axes and units by the scene's metadata.
FileFrame file_frame(const aiScene& scene);

}  // namespace talisman::sequences
