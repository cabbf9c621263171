// SPDX-License-Identifier: Apache-2.0
#include "chunker/chunk_cache.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <glm/matrix.hpp>

#include "chunker/pixel.h"

namespace talisman::chunker {
namespace {

using layers::dvec2;
using layers::dvec3;
using layers::ivec2;

/// Chunk columns and rows, both ends included.
struct ChunkRange {
  ivec2 first, last;
};

/// Where the pixel centre p is in the sprite; empty behind the horizon and where the map is not finite.
std::optional<dvec2> in_sprite(const layers::dmat3& sprite_from_screen, dvec2 p) {
  const dvec3 q = sprite_from_screen * dvec3(p, 1);
  const dvec2 at = dvec2(q) / q.z;
  if (!(q.z > 0) || !std::isfinite(at.x) || !std::isfinite(at.y)) return std::nullopt;
  return at;
}

/// The chunks under the bilinear footprints of the pixels from `first` to `last`.
std::optional<ChunkRange> chunks_under(const layers::dmat3& sprite_from_screen, ivec2 size_px, ivec2 first,
                                       ivec2 last) {
  dvec2 lo(HUGE_VAL), hi(-HUGE_VAL);
  for (const ivec2 corner : {first, ivec2(last.x, first.y), ivec2(first.x, last.y), last}) {
    const std::optional<dvec2> at = in_sprite(sprite_from_screen, dvec2(corner) + 0.5);
    if (!at) return std::nullopt;
    lo = glm::min(lo, *at);
    hi = glm::max(hi, *at);
  }
  lo = glm::max(glm::floor(lo - 0.5), dvec2(0));
  hi = glm::min(glm::floor(hi - 0.5) + 1.0, dvec2(size_px) - 1.0);
  if (lo.x > hi.x || lo.y > hi.y) return std::nullopt;
  return ChunkRange{ivec2(lo) / kChunkSize, ivec2(hi) / kChunkSize};
}

void touch_range(int id, const CompressedSprite& sprite, const ChunkRange& range, ChunkCache& cache) {
  for (int row = range.first.y; row <= range.last.y; ++row)
    for (int column = range.first.x; column <= range.last.x; ++column) {
      const auto bytes = static_cast<std::int64_t>(sprite.chunk_bytes(column, row).size());
      if (bytes > 0) cache.touch(id, row * sprite.chunks().x + column, bytes);
    }
}

/// Of a singular map the inverse is not finite, and shows nothing.
std::vector<layers::dmat3> inverses(std::span<const PlacedCompressed> sprites) {
  std::vector<layers::dmat3> maps;
  for (const PlacedCompressed& placed : sprites) maps.push_back(glm::inverse(placed.screen_from_sprite));
  return maps;
}

}  // namespace

double CacheCounters::hit_rate() const {
  return hits + misses > 0 ? static_cast<double>(hits) / static_cast<double>(hits + misses) : 0;
}

CacheCounters& CacheCounters::operator+=(const CacheCounters& o) {
  hits += o.hits;
  misses += o.misses;
  bytes_read += o.bytes_read;
  return *this;
}

void ChunkCache::touch(int sprite, int chunk, std::int64_t bytes) {
  const Key key =
      static_cast<Key>(static_cast<std::uint32_t>(sprite)) << 32 | static_cast<std::uint32_t>(chunk);
  if (const auto known = place_.find(key); known != place_.end()) {
    ++counters_.hits;
    used_.splice(used_.begin(), used_, known->second);
    return;
  }
  ++counters_.misses;
  counters_.bytes_read += bytes;
  if (capacity_ <= 0) return;
  if (static_cast<int>(used_.size()) == capacity_) {
    place_.erase(used_.back());
    used_.pop_back();
  }
  used_.push_front(key);
  place_[key] = used_.begin();
}

void touch_chunks(std::span<const PlacedCompressed> sprites, ivec2 display_px, ChunkCache& cache) {
  const std::vector<layers::dmat3> maps = inverses(sprites);
  for (int y = 0; y < display_px.y; y += kBandLines)
    for (std::size_t i = 0; i < sprites.size(); ++i)
      for (int x = 0; x < display_px.x; x += kChunkSize) {
        const ivec2 last = glm::min(ivec2(x + kChunkSize, y + kBandLines), display_px) - 1;
        const CompressedSprite& sprite = *sprites[i].sprite;
        if (const auto range = chunks_under(maps[i], sprite.size_px(), {x, y}, last))
          touch_range(static_cast<int>(i), sprite, *range, cache);
      }
}

}  // namespace talisman::chunker
