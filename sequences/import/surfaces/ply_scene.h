// SPDX-License-Identifier: Apache-2.0
#pragma once

/// PLY files (ply_file.h) as a surface (bare_surface.h).
///
///   vertex      x y z; nx ny nz; red green blue, also "diffuse_red" or "r", with alpha; s t, u v or "texture_u"
///   face        lists of corners; polygons are cut into triangles; red green blue: the face has that colour, in place of
///               those of its corners; "texcoord": coordinates of its own corners
///   tristrips   runs of corners, -1 between two of them
///   picture     the first "comment TextureFile NAME"
///
/// Colours are in sRGB, whole numbers of 8 or 16 bits from 0 to the greatest, others from 0 to 1. What else the file holds
/// is named as not drawn. Where every alpha is 0, which would leave nothing to see, alpha is left out and that is said.

#include <string>

#include "sequences/import/model_import.h"
#include "sequences/import/texture_search.h"

namespace talisman::sequences {

bool is_ply(const std::string& path);

/// Reads the file. Throws InputError without the file's name.
ImportedModel read_ply(const ModelPlace& place);

}  // namespace talisman::sequences
