// SPDX-License-Identifier: Apache-2.0
#include "chunker/window.h"

#include <algorithm>
#include <cstring>

namespace talisman::chunker {
namespace {

constexpr int kPieceShift = 4;
constexpr int kPieceTexels = 1 << kPieceShift;

/// Blocks of 8 that the texels first … last of a sprite's row or column take in one chunk: a half-open range
/// within 0 … 4.
struct BlockRange {
  int first, last;
};
BlockRange blocks_in_chunk(int chunk, int first, int last) {
  const int start = chunk * kChunkSize;
  return {std::max(first - start, 0) / 8, std::min(last - start, kChunkSize - 1) / 8 + 1};
}

/// Bits 4 · row + column, as those of Sprite::opaque_blocks.
unsigned block_bits(BlockRange columns, BlockRange rows) {
  const unsigned in_row = (1u << columns.last) - (1u << columns.first);
  const unsigned row_starts = 0x1111u & ((1u << 4 * rows.last) - (1u << 4 * rows.first));
  return in_row * row_starts;
}

}  // namespace

static_assert(kChunkSize == 32, "chunk_of() shifts by five");

const Chunk* chunk_or_clear(const Sprite& sprite, int column, int row) {
  const layers::ivec2 chunks = sprite.chunks();
  const bool inside = column >= 0 && column < chunks.x && row >= 0 && row < chunks.y;
  return inside ? sprite.chunk(column, row) : nullptr;
}

bool is_clear(const Sprite& sprite, const layers::RectI& texels) {
  const layers::ivec2 chunks = sprite.chunks();
  const int first_column = std::max(chunk_of(texels.x0), 0),
            last_column = std::min(chunk_of(texels.x1 - 1), chunks.x - 1);
  const int first_row = std::max(chunk_of(texels.y0), 0),
            last_row = std::min(chunk_of(texels.y1 - 1), chunks.y - 1);
  for (int row = first_row; row <= last_row; ++row) {
    for (int column = first_column; column <= last_column; ++column) {
      if (sprite.may_hold(column, row)) return false;
    }
  }
  return true;
}

bool is_opaque(const Sprite& sprite, const layers::RectI& texels) {
  const layers::ivec2 size = sprite.size_px();
  if (texels.x0 < 0 || texels.y0 < 0 || texels.x1 > size.x || texels.y1 > size.y) return false;
  for (int row = chunk_of(texels.y0); row <= chunk_of(texels.y1 - 1); ++row) {
    const BlockRange rows = blocks_in_chunk(row, texels.y0, texels.y1 - 1);
    for (int column = chunk_of(texels.x0); column <= chunk_of(texels.x1 - 1); ++column) {
      const unsigned needed = block_bits(blocks_in_chunk(column, texels.x0, texels.x1 - 1), rows);
      if ((needed & ~static_cast<unsigned>(sprite.opaque_blocks(column, row))) != 0) return false;
    }
  }
  return true;
}

bool Window::gather(const Sprite& sprite, const layers::RectI& texels) {
  const int first_piece = texels.x0 >> kPieceShift, last_piece = texels.x1 >> kPieceShift;
  const layers::RectI rows{0, texels.y0, 0, texels.y1 + 1};
  const std::int64_t stride = (static_cast<std::int64_t>(last_piece) - first_piece + 1) * kPieceTexels;
  if (stride * rows.height() > kMaxTexels) return false;
  stride_ = static_cast<int>(stride);
  origin_ = {first_piece * kPieceTexels, rows.y0};
  for (int row = chunk_of(rows.y0); row <= chunk_of(rows.y1 - 1); ++row) {
    for (int piece = first_piece; piece <= last_piece; ++piece) {
      gather_piece(chunk_or_clear(sprite, chunk_of(piece * kPieceTexels), row), row, piece, rows);
    }
  }
  return true;
}

void Window::gather_piece(const Chunk* chunk, int chunk_row, int piece, layers::RectI rows) {
  const int top = chunk_row * kChunkSize, x = piece * kPieceTexels;
  const int first = std::max(rows.y0, top), last = std::min(rows.y1, top + kChunkSize);
  Texel* target = texels_.data() + static_cast<std::ptrdiff_t>(first - rows.y0) * stride_ + (x - origin_.x);
  const int column = x & (kChunkSize - 1);
  for (int y = first; y < last; ++y, target += stride_) {
    if (chunk) {
      std::memcpy(target, chunk->texels + (y - top) * kChunkSize + column, kPieceTexels * sizeof(Texel));
    } else {
      std::fill_n(target, kPieceTexels, Texel{});
    }
  }
}

}  // namespace talisman::chunker
