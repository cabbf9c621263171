// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How small can a sprite be kept, and what does that cost in its picture? Compression chunk by chunk [A §1
/// rows 6, 7]: every chunk is coded on its own and found by its offset, so that the compositor can fetch any
/// one of them.
///
/// Talisman's TREC is published as JPEG-like, about 10:1, per chunk and randomly accessible; its block
/// layout, tables and bit stream are not. All of what follows is assumed. A chunk is a mode byte (0: as it
/// is; else the quality, + 128 for colours that are not straight) and a bit stream of 16 blocks of 8×8
/// texels, each:
///
///   alpha    lossless. Predicted from its left and upper neighbours (the median of a, b and a + b - c), the
///            first of a block from the last of the block before; the differences modulo 256 are a sparse run.
///   colour   reversible YCoCg of the texel's bytes, an orthonormal 8×8 DCT in 12-bit fixed point, and
///
///              level = c / step,  step(u, v) = 2^((80 - quality)/10) · (1 + (u + v)/4) · (2 for Co and Cg)
///
///            rounded to nearest, for c other than the first (u = v = 0) a little towards 0. The first level
///            is the difference to that of the block before, the others are a sparse run in zig-zag order.
///   sparse run  how many are not zero; for each how many zeros before it, its size less one, its sign.
///            Numbers are Exp-Golomb codes of order 0.
///
/// Colours are coded *straight*: divided by alpha (in the square-root scale of the texel) where there is
/// some, what costs least where there is none. So an antialiased edge is no edge for the transform, a decoded
/// texel is never brighter than its alpha, and a clear texel stays clear. A chunk with a texel brighter than
/// its alpha (additive layers: alpha 0) is coded as it is, and may come back brighter or darker by the
/// quantisation. A chunk that would not get smaller than it is (noise) is stored as it is, with the mode that
/// says so. Clear chunks cost their reference only.
///
/// Integer arithmetic throughout: the same bytes on every machine. The decoder takes any bytes: it returns a
/// status, reads no byte beyond its input, and its work is bounded.

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "chunker/sprite.h"

namespace talisman::chunker {

struct CompressionOptions {
  /// 1 … 100; values outside count as the nearest end. Ten more halve the quantisation steps: more bytes,
  /// less error. 100 is off by at most a code value or two; the default gives about 10:1 on typical sprites.
  int quality = 85;
  bool operator==(const CompressionOptions&) const = default;
};

enum class DecodeStatus {
  Ok,
  Truncated,  ///< the bytes end before the chunk does
  Corrupt     ///< an unknown mode, a run beyond its block, a number beyond its range, bytes left over
};
std::string_view name(DecodeStatus status);  ///< "ok", "truncated", "corrupt"

/// The bytes of one chunk. Cost: some 20 µs.
std::vector<std::uint8_t> compress_chunk(const Chunk& chunk, const CompressionOptions& options);

/// `chunk` is clear unless the status is Ok. Cost: some 20 µs.
DecodeStatus decompress_chunk(std::span<const std::uint8_t> bytes, Chunk& chunk);

/// All chunks of a sprite, and where each of them begins.
class CompressedSprite {
 public:
  CompressedSprite() = default;
  layers::ivec2 size_px() const { return size_px_; }
  layers::ivec2 chunks() const { return chunks_; }  ///< columns, rows
  /// The bytes of the chunk at (column, row); empty where it is clear.
  std::span<const std::uint8_t> chunk_bytes(int column, int row) const;
  std::int64_t stored_chunks() const { return stored_chunks_; }
  std::int64_t raw_chunks() const { return raw_chunks_; }  ///< stored as they are: they did not get smaller
  std::int64_t bytes() const;                              ///< stored chunks and references

 private:
  friend CompressedSprite compress(const Sprite& sprite, const CompressionOptions& options);
  layers::ivec2 size_px_{0, 0}, chunks_{0, 0};
  std::vector<std::uint32_t> offset_;  ///< of every chunk, row by row, and the end
  std::vector<std::uint8_t> bytes_;
  std::int64_t stored_chunks_ = 0, raw_chunks_ = 0;
};

/// Chunks are independent jobs; the bytes do not depend on their order.
CompressedSprite compress(const Sprite& sprite, const CompressionOptions& options);

/// One chunk, as the compositor would fetch it; texels outside the sprite are clear.
DecodeStatus decompress_chunk(const CompressedSprite& sprite, int column, int row, Chunk& chunk);
Sprite decompress(const CompressedSprite& sprite);

/// What compression changed, in sums that can be added up over sprites. Colour is measured in the texel's
/// bytes (square-root scale, where equal steps look about equal) and weighted by alpha; texels that add light
/// (alpha 0, not black) count in full.
struct CompressionError {
  std::int64_t color_squared = 0;  ///< Σ weight · (Δr² + Δg² + Δb²), weight 255 = one
  std::int64_t color_weight = 0;   ///< Σ weight · 3
  std::int64_t alpha_squared = 0;  ///< Σ Δa²
  std::int64_t texels = 0;         ///< of chunks that are stored
  double color_psnr_db() const;    ///< infinite if there is no error
  double alpha_psnr_db() const;
  CompressionError& operator+=(const CompressionError& o);
  bool operator==(const CompressionError&) const = default;
};

/// Both sprites have the same size.
CompressionError compression_error(const Sprite& original, const Sprite& decoded);

}  // namespace talisman::chunker
