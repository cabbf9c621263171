// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The effect *sprite compression* in a run: a sprite is compressed once it is drawn, and what the compositor
/// shows is what it decompresses. Nothing of it exists in a run that does not ask for it.
///
/// The compositor's cache is modelled for each frame on its own, from empty: a frame's sprites are many times
/// larger than the cache, and so the counters of a frame do not depend on which frames were drawn before it.

#include <cstdint>
#include <map>
#include <span>

#include "chunker/chunk_cache.h"
#include "chunker/compression.h"

namespace talisman::sequences {

/// By layer id.
using CompressedSprites = std::map<int, chunker::CompressedSprite>;

/// Chunks in the modelled cache: 256 KiB of decompressed texels, a row of chunks across a 1024-pixel display
/// for two layers. [A §1: unpublished, assumed.]
inline constexpr int kCache_chunks = 64;

/// Of one frame: the sprites drawn for it, and what the compositor read of all that it showed.
struct CompressionReport {
  std::int64_t sprites = 0;
  std::int64_t original_bytes = 0;    ///< of the stored chunks and the references
  std::int64_t compressed_bytes = 0;  ///< likewise
  std::int64_t chunks = 0;            ///< that are not clear
  std::int64_t raw_chunks = 0;        ///< of them, those that did not get smaller
  chunker::CompressionError error;
  chunker::CacheCounters cache;
  double compress_ms = 0;  ///< to compress, decompress and compare; part of render_ms
  double ratio() const;    ///< original : compressed; 1 if nothing was drawn
  CompressionReport& operator+=(const CompressionReport& o);
};

/// Compresses a sprite that was just drawn. `store` gets it as the compositor shows it, at the bytes of the
/// compressed one. Counts into `report` unless that is null.
void keep_compressed(int layer, const chunker::Sprite& drawn, const chunker::CompressionOptions& options,
                     CompressedSprites& compressed, chunker::SpriteStore& store, CompressionReport* report);

/// What compositing one frame reads; sprites back to front.
chunker::CacheCounters model_chunk_reads(std::span<const chunker::PlacedCompressed> sprites,
                                         layers::ivec2 display_px);

}  // namespace talisman::sequences
