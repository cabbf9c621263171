// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Normals as the file has them, each of length 1. One that has no direction (no length, or none that is finite) gets the
/// mean of its vertex's triangles, weighted by their areas; where these have none either, +y.

#include <cstddef>

#include "layers/scene.h"

namespace talisman::sequences {

/// How many had no direction. Cost: O(normals), and O(triangles) where there are such.
std::size_t make_unit_normals(layers::Mesh& mesh);

inline constexpr const char* kWithoutDirection = "normals without a direction are those of their triangles";

}  // namespace talisman::sequences
