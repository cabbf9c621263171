// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A picture with depth, and how two of them become one: the scratch buffers of predictive rendering [F96 3.1.5, 3.3.1].
///
/// Each texel has a colour, a depth 1/w (0: clear, larger is nearer) and the number of the part that it shows. Of two
/// buffers the nearer surface is seen, and at equal depth the part with the lower number,
///
///   b is seen instead of a   if z_b > z_a, or z_b = z_a and part_b < part_a
///
/// which is what one pass over all parts decides (chunker/render.h) where each texel has one sample: then joined buffers
/// equal that pass, byte for byte. With more samples a texel at an edge holds a mix of what lies behind each other, of
/// which a join sees the nearest depth alone: wrong there, by as much as the mix weighs.
///
/// Buffers are stored in 32×32 chunks; a clear one takes no memory, is never compared, and is taken over whole by
/// what it is joined with.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "chunker/pixel.h"
#include "chunker/sprite.h"

namespace talisman::chunker {

/// Depths and parts beside the texels of a Chunk.
struct DepthChunk {
  std::array<float, kChunkSize * kChunkSize> z;
  std::array<std::uint32_t, kChunkSize * kChunkSize> part;
  void clear() {
    z.fill(0);
    part.fill(~std::uint32_t{0});
  }
};

/// What joins took. Pixels are those of whole chunks.
struct JoinCounters {
  std::int64_t joins = 0;  ///< of two buffers
  std::int64_t pixels_compared = 0;
  std::int64_t pixels_copied = 0;  ///< into a chunk that was clear, or of a buffer that begins as a copy
  std::int64_t pixels_cleared = 0;
  std::int64_t pixels_skipped = 0;  ///< of chunks that are clear in what is joined
  JoinCounters& operator+=(const JoinCounters& o);
  bool operator==(const JoinCounters&) const = default;
};

class PlanBuffer {
 public:
  PlanBuffer() = default;
  /// Clear.
  explicit PlanBuffer(layers::ivec2 size_px);

  layers::ivec2 size_px() const { return size_px_; }
  layers::ivec2 chunks() const { return chunks_; }  ///< columns, rows
  bool is_clear() const { return stored_ == 0; }

  /// Keeps its memory.
  void clear(JoinCounters& counters);
  /// Stores a chunk at `place` = row · columns + column, which is clear.
  void put(int place, const Chunk& color, const DepthChunk& depth);
  /// Becomes a copy of `other`, of the same size.
  void copy(const PlanBuffer& other, JoinCounters& counters);
  /// Joins `other`, of the same size, with what is there.
  void join(const PlanBuffer& other, JoinCounters& counters);

  const Chunk* color(int place) const;       ///< null where it is clear
  const DepthChunk* depth(int place) const;  ///< likewise
  Sprite sprite() const;                     ///< its colours
  std::int64_t edge_texels() const;          ///< of the picture, covered in part
  std::int64_t bytes() const;                ///< of the chunks stored, and a reference for each

 private:
  int take_chunk();
  std::int64_t pixels() const { return std::int64_t{kChunkSize} * kChunkSize; }

  layers::ivec2 size_px_{0, 0}, chunks_{0, 0};
  std::vector<std::int32_t> reference_;  ///< by place; -1: clear
  std::vector<Chunk> color_;             ///< the first `stored_` are in use
  std::vector<DepthChunk> depth_;
  int stored_ = 0;
};

/// Joins `other` with `color` and `depth`, texel by texel.
void join_chunks(const Chunk& other_color, const DepthChunk& other_depth, Chunk& color, DepthChunk& depth);

}  // namespace talisman::chunker
