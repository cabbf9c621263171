// SPDX-License-Identifier: Apache-2.0
#pragma once

/// OBJ files, in a time that grows linearly with their length: tinyobjloader reads the geometry, in double; materials:
/// obj_materials.h.
///
///   parts     one per object or group and material; polygons are cut into triangles
///   places    far from the file's origin they are kept around a local one, which a node puts back
///   sides     both are drawn: the format has no rule that hides one
///   normals   the file's; without any: the mean of the triangles around a point, of one smoothing group where the
///             file has groups (without a group: flat), else of all
///   colours   of vertices (v x y z r g b), in sRGB; where the file names no material they are meant alone

#include "sequences/import/model_import.h"
#include "sequences/import/texture_search.h"

namespace talisman::sequences {

bool is_obj(const std::string& path);

/// Reads the file. Throws InputError without the file's name. Cost: about 2 µs and 200 bytes per
/// triangle.
ImportedModel read_obj(const ModelPlace& place);

}  // namespace talisman::sequences
