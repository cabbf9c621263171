// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which triangles does each chunk have to draw? A triangle that spans several chunks is drawn in each of
/// them [A §1 row 1].

#include <cstdint>
#include <span>
#include <vector>

#include "chunker/triangle.h"

namespace talisman::chunker {

/// Triangles by chunk, each in the order of the list.
struct Bins {
  layers::ivec2 chunks{0, 0};
  std::vector<std::uint32_t> first;  ///< chunks + 1 offsets into `triangles`
  std::vector<std::uint32_t> triangles;
  int count() const { return static_cast<int>(first.size()) - 1; }
  std::span<const std::uint32_t> of(int chunk) const {
    return {triangles.data() + first[chunk], triangles.data() + first[chunk + 1]};
  }
};

/// Cost: O(triangle–chunk pairs); chunks of a triangle's bounding box that lie outside one of its edges are
/// skipped.
Bins bin_triangles(std::span<const Triangle> triangles, layers::ivec2 size_px);

}  // namespace talisman::chunker
