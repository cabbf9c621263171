// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Sprites in chunks [LS97 1.1]: the picture of a layer, stored as whole 32×32 chunks. A chunk in which
/// nothing was drawn is not stored. Byte counts are those of the stored chunks plus one reference per chunk.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "chunker/pixel.h"
#include "layers/sprite_transform.h"

namespace talisman::chunker {

/// 32×32 texels, row by row.
struct Chunk {
  Texel texels[kChunkSize * kChunkSize];
};

class LateChunks;  // chunker/late_chunks.h

/// Has nothing of `chunk` a colour or alpha?
bool is_clear_chunk(const Chunk& chunk);
/// What Sprite::opaque_blocks says of it.
std::uint16_t opaque_blocks_of(const Chunk& chunk);

class Sprite {
 public:
  Sprite() = default;
  /// A clear sprite of `size_px` texels (each ≥ 0).
  explicit Sprite(layers::ivec2 size_px);
  /// A sprite of finished chunks, stored in the order given; `places` are row · columns + column. Clear ones
  /// are dropped.
  static Sprite assemble(layers::ivec2 size_px, std::span<const int> places, std::span<const Chunk> chunks);

  /// A sprite whose chunks at `places`, ascending, are drawn when they are first read; the others are clear.
  static Sprite late(layers::ivec2 size_px, std::span<const int> places, std::shared_ptr<LateChunks> chunks);
  /// Null unless chunks are drawn late.
  LateChunks* late_chunks() const { return late_.get(); }

  layers::ivec2 size_px() const { return size_px_; }
  layers::ivec2 chunks() const { return chunks_; }  ///< columns, rows
  /// The stored chunk at (column, row), or null where it is clear. A late one is drawn.
  const Chunk* chunk(int column, int row) const;
  /// May something be stored at (column, row)? Draws nothing: a late chunk may turn out to be clear.
  bool may_hold(int column, int row) const;
  /// Which 8×8 blocks of the chunk at (column, row) have alpha 255 in every texel: bit 4 · row + column of the
  /// block. A clear chunk has none. Known from the moment a chunk is stored, and no part of bytes().
  std::uint16_t opaque_blocks(int column, int row) const;
  /// Stores a chunk unless it is clear (then drops what was there). Texels outside size_px must be clear.
  /// Not for several threads at once; those finish their chunks on their own and join them by `assemble`.
  void store(int column, int row, const Chunk& chunk);
  /// The same, also where chunks are drawn late: that one is no longer.
  void replace(int column, int row, const Chunk& chunk);

  Texel texel(int x, int y) const;     ///< clear outside
  std::int64_t stored_chunks() const;  ///< late ones that may hold something count, drawn or not
  std::int64_t clear_chunks() const;
  std::int64_t bytes() const;  ///< stored chunks and references

 private:
  void release(std::int32_t& reference);

  layers::ivec2 size_px_{0, 0};
  layers::ivec2 chunks_{0, 0};
  std::vector<std::int32_t>
      reference_;  ///< index into storage_, -1: clear. Where chunks are drawn late: a slot of
                   ///< late_, or -2 - index into storage_ of one that was replaced
  std::vector<Chunk> storage_;
  std::vector<std::uint16_t> opaque_;  ///< opaque blocks of each stored chunk
  std::shared_ptr<LateChunks> late_;   ///< has the chunks in the place of storage_; copies share it
};

/// The sprites that are alive, one per layer id.
class SpriteStore {
 public:
  void put(int layer, Sprite sprite);
  /// The same for a sprite that is kept in other ways and takes `stored_bytes`.
  void put(int layer, Sprite sprite, std::int64_t stored_bytes);
  const Sprite* find(int layer) const;  ///< null if there is none
  void drop(int layer);
  /// In place of what the layer's sprite has there; `places` are row · columns + column.
  void replace(int layer, std::span<const int> places, std::span<const Chunk> chunks);
  std::int64_t bytes() const;

 private:
  std::vector<Sprite> sprites_;
  std::vector<bool> alive_;
  std::vector<std::int64_t> stored_bytes_;
};

}  // namespace talisman::chunker
