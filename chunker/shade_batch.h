// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Many points of one triangle shaded at once: what shade() gives for each of them, bit by bit.
///
/// Interpolation, texture footprints and lights are computed in as many lanes as the processor has; texels
/// are fetched and mixed one point after the other, four channels at a time. What only some scenes ask for
/// (shadow maps, reflections, second textures, anisotropy) is looked up point by point, by the functions of
/// chunker/shade.h; a shader without them never comes near.

#include <span>
#include <vector>

#include "chunker/pixel.h"
#include "chunker/shade.h"

namespace talisman::chunker {

/// Points in and colours out, for up to all texels of a chunk.
struct ShadeBatch {
  static constexpr int kPoints = kChunkSize * kChunkSize;
  using Row = std::array<float, kPoints>;
  int count = 0;
  alignas(64) Row dx{}, dy{};                       ///< in: texels from the triangle's first corner
  alignas(16) std::array<Float4, kPoints> color{};  ///< out: premultiplied
  int texture_samples = 0;                          ///< out: filtered look-ups
};

/// Fills `color` of the first `count` points.
void shade_batch(const Shader& shader, const Interpolator& t, ShadeBatch& batch);

}  // namespace talisman::chunker
