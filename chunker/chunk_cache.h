// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How often does the compositor fetch and decompress a chunk? A model of its cache of decompressed chunks
/// [A §1 row 7]: the N that were used last. Size and rule are unpublished; both are assumed.
///
/// The compositor finishes 32 display lines at a time. For each band it goes through the sprites back to
/// front, and along the band tile by tile (32×32 pixels); a tile asks for every chunk under the bounding box
/// of its texels, as chunker/composite gathers them. A chunk that is in the cache is a hit; one that is not
/// is fetched (its compressed bytes are read) and decompressed, and takes the place of the one that was used
/// longest ago. Clear chunks are known from their reference and ask for nothing.

#include <cstdint>
#include <list>
#include <span>
#include <unordered_map>

#include "chunker/compression.h"

namespace talisman::chunker {

struct CacheCounters {
  std::int64_t hits = 0;
  std::int64_t misses = 0;
  std::int64_t bytes_read = 0;  ///< compressed bytes of the misses
  double hit_rate() const;      ///< 0 … 1; 0 if nothing was asked for
  CacheCounters& operator+=(const CacheCounters& o);
  bool operator==(const CacheCounters&) const = default;
};

/// The chunks that were used last.
class ChunkCache {
 public:
  /// `capacity` ≥ 0 chunks of 4 KiB; 0: every access is a miss.
  explicit ChunkCache(int capacity) : capacity_(capacity) {}

  /// One access to chunk `chunk` of sprite `sprite`, which is `bytes` long. Cost: O(1).
  void touch(int sprite, int chunk, std::int64_t bytes);
  const CacheCounters& counters() const { return counters_; }

 private:
  using Key = std::uint64_t;
  int capacity_;
  std::list<Key> used_;  ///< last used first
  std::unordered_map<Key, std::list<Key>::iterator> place_;
  CacheCounters counters_;
};

struct PlacedCompressed {
  const CompressedSprite* sprite = nullptr;
  layers::dmat3 screen_from_sprite{1.0};
};

/// The accesses of one frame, sprites back to front. A map that is singular or not finite asks for nothing,
/// as does a tile that the horizon of a perspective map crosses. Cost: O(sprites · tiles + accesses).
void touch_chunks(std::span<const PlacedCompressed> sprites, layers::ivec2 display_px, ChunkCache& cache);

}  // namespace talisman::chunker
