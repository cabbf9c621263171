// SPDX-License-Identifier: Apache-2.0
#pragma once

/// In which axes, units and around which origin does a file give its places?
///
/// FBX says its up, front and right axes and its unit in centimetres (UnitScaleFactor); assimp hands them on
/// without applying them. Files of surveys give places of 10⁶ m with sizes of 0.2 m, which no float holds: of an
/// OBJ whose origin lies that far away the coordinates are read in double, a local origin is taken off before
/// assimp reads them, and a node puts it back.

#include <string>

#include <assimp/scene.h>
#include <assimp/Importer.hpp>

#include "layers/scene.h"
#include "sequences/import/texture_search.h"

namespace talisman::sequences {

/// Takes the place of what is above the root node.
struct FileFrame {
  layers::Transform transform;
};

/// Prepares `importer` to read the file around a local origin, which is returned; (0, 0, 0) where nothing is
/// gained by it. Cost: of an OBJ file, one reading of its lines.
/// What is opened is noted in `files`.
layers::dvec3 use_local_origin(Assimp::Importer& importer, const ModelPlace& model, FileUses& files);

/// Axes and units by the scene's metadata; `origin` as above.
FileFrame file_frame(const aiScene& scene, const layers::dvec3& origin);

}  // namespace talisman::sequences
