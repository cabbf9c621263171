// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The painted ground of a terrain, from the program's cache (files/cache.h) where it has been painted before.
///
///   key      the content of the class image and of every tile, all numbers that the painter uses, the windows,
///            the program's code
///   content  for each window width and height (32 bits each), then the texels, 4 bytes each
///
/// The pyramids that the renderer makes of these textures are not kept: of the 5.7 million texels of the canyon
/// they are 115 MB, and to read them takes as long (0.8 s of one processor) as to make them (0.7 to 0.9 s).

#include <vector>

#include "sequences/content/ground_texture.h"

namespace talisman::sequences {

/// What GroundPainter paints for each window, in the same order; empty if the content has no classes. Throws
/// InputError.
std::vector<layers::Texture> painted_ground(const TerrainContent& content, const layers::HeightField& field,
                                            const std::vector<GroundWindow>& windows);

}  // namespace talisman::sequences
