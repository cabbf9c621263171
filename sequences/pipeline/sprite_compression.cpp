// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/sprite_compression.h"

#include <utility>

#include "sequences/pipeline/stopwatch.h"

namespace talisman::sequences {

double CompressionReport::ratio() const {
  return compressed_bytes > 0 ? static_cast<double>(original_bytes) / static_cast<double>(compressed_bytes)
                              : 1;
}

CompressionReport& CompressionReport::operator+=(const CompressionReport& o) {
  sprites += o.sprites;
  original_bytes += o.original_bytes;
  compressed_bytes += o.compressed_bytes;
  chunks += o.chunks;
  raw_chunks += o.raw_chunks;
  error += o.error;
  cache += o.cache;
  compress_ms += o.compress_ms;
  return *this;
}

void keep_compressed(int layer, const chunker::Sprite& drawn, const chunker::CompressionOptions& options,
                     CompressedSprites& compressed, chunker::SpriteStore& store, CompressionReport* report) {
  const Stopwatch watch;
  chunker::CompressedSprite& kept = compressed[layer] = chunker::compress(drawn, options);
  chunker::Sprite shown = chunker::decompress(kept);
  if (report) {
    ++report->sprites;
    report->original_bytes += drawn.bytes();
    report->compressed_bytes += kept.bytes();
    report->chunks += kept.stored_chunks();
    report->raw_chunks += kept.raw_chunks();
    report->error += chunker::compression_error(drawn, shown);
    report->compress_ms += watch.ms();
  }
  store.put(layer, std::move(shown), kept.bytes());
}

chunker::CacheCounters model_chunk_reads(std::span<const chunker::PlacedCompressed> sprites,
                                         layers::ivec2 display_px) {
  chunker::ChunkCache cache(kCache_chunks);
  chunker::touch_chunks(sprites, display_px, cache);
  return cache.counters();
}

}  // namespace talisman::sequences
