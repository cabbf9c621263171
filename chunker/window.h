// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A rectangular piece of a sprite, gathered from its chunks into rows that stay in the first-level cache.
///
/// One 32×32 display tile under a warp near scale 1 needs some 36×36 texels out of up to nine chunks. Copying
/// whole chunk rows (128 bytes each) costs about a tenth of the filtering, and afterwards a 2×2 footprint is
/// two plain 8-byte loads, whatever chunks it lies in. Texels outside the sprite are clear.

#include <array>

#include "chunker/sampling.h"
#include "chunker/sprite.h"

namespace talisman::chunker {

class Window {
 public:
  /// Most texels that a window holds (48 KiB). A 32×32 tile fits up to about 2.5-fold minification.
  static constexpr int kMaxTexels = 96 * 128;

  /// Gathers the texels of `texels` and the row and column after them. False, and nothing gathered, if they
  /// do not fit.
  bool gather(const Sprite& sprite, const layers::RectI& texels);

  const Texel* texels() const { return texels_.data(); }
  int stride() const { return stride_; }
  layers::ivec2 origin() const { return origin_; }  ///< sprite texel of texels()[0]

 private:
  void gather_piece(const Chunk* chunk, int chunk_row, int piece, layers::RectI rows);

  alignas(64) std::array<Texel, kMaxTexels> texels_;
  int stride_ = 0;
  layers::ivec2 origin_{0, 0};
};

/// The stored chunk at (column, row); null also outside the sprite.
const Chunk* chunk_or_clear(const Sprite& sprite, int column, int row);

/// Is certainly nothing stored under `texels`?
bool is_clear(const Sprite& sprite, const layers::RectI& texels);

/// Are all of `texels` inside the sprite and in opaque 8×8 blocks?
bool is_opaque(const Sprite& sprite, const layers::RectI& texels);

/// Chunk column or row of a texel column or row, also of negative ones.
inline int chunk_of(int texel) { return texel >> 5; }

}  // namespace talisman::chunker
