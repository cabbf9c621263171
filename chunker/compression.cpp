// SPDX-License-Identifier: Apache-2.0
#include "chunker/compression.h"

#include <cmath>

#include <tbb/parallel_for.h>

#include "chunker/job_order.h"
#include "layers/check.h"

namespace talisman::chunker {
namespace {

double psnr_db(std::int64_t squared, std::int64_t weight) {
  if (squared == 0 || weight == 0) return HUGE_VAL;
  return 10 * std::log10(255.0 * 255.0 * static_cast<double>(weight) / static_cast<double>(squared));
}

std::int64_t squared(int a, int b) { return std::int64_t{a - b} * (a - b); }

/// 255 = one: alpha, or for light without alpha all of it.
int weight_of(Texel t) { return t.a == 0 && (t.r | t.g | t.b) != 0 ? 255 : t.a; }

CompressionError chunk_error(const Chunk& original, const Chunk* decoded) {
  CompressionError error;
  for (int i = 0; i < kChunkSize * kChunkSize; ++i) {
    const Texel a = original.texels[i], b = decoded ? decoded->texels[i] : Texel{};
    error.color_squared += weight_of(a) * (squared(a.r, b.r) + squared(a.g, b.g) + squared(a.b, b.b));
    error.color_weight += weight_of(a) * 3;
    error.alpha_squared += squared(a.a, b.a);
  }
  error.texels = kChunkSize * kChunkSize;
  return error;
}

void clear_outside(layers::ivec2 size_px, int column, int row, Chunk& chunk) {
  const int width = size_px.x - column * kChunkSize, height = size_px.y - row * kChunkSize;
  if (width >= kChunkSize && height >= kChunkSize) return;
  for (int y = 0; y < kChunkSize; ++y)
    for (int x = 0; x < kChunkSize; ++x)
      if (x >= width || y >= height) chunk.texels[y * kChunkSize + x] = {};
}

}  // namespace

std::string_view name(DecodeStatus status) {
  switch (status) {
    case DecodeStatus::Ok:
      return "ok";
    case DecodeStatus::Truncated:
      return "truncated";
    case DecodeStatus::Corrupt:
      return "corrupt";
  }
  return "?";
}

std::span<const std::uint8_t> CompressedSprite::chunk_bytes(int column, int row) const {
  TALISMAN_CHECK(column >= 0 && column < chunks_.x && row >= 0 && row < chunks_.y);
  const std::size_t index = static_cast<std::size_t>(row) * chunks_.x + column;
  return std::span(bytes_).subspan(offset_[index], offset_[index + 1] - offset_[index]);
}

std::int64_t CompressedSprite::bytes() const {
  const std::int64_t references = std::int64_t{chunks_.x} * chunks_.y;
  return static_cast<std::int64_t>(bytes_.size() + references * sizeof(std::uint32_t));
}

CompressedSprite compress(const Sprite& sprite, const CompressionOptions& options) {
  CompressedSprite result;
  result.size_px_ = sprite.size_px();
  result.chunks_ = sprite.chunks();
  const int columns = result.chunks_.x, count = columns * result.chunks_.y;
  std::vector<std::vector<std::uint8_t>> parts(count);
  const JobOrder order(static_cast<std::size_t>(count));
  tbb::parallel_for(0, count, [&](int job) {
    const int i = static_cast<int>(order[job]);
    if (const Chunk* chunk = sprite.chunk(i % columns, i / columns))
      parts[i] = compress_chunk(*chunk, options);
  });
  result.offset_.push_back(0);
  for (const auto& part : parts) {
    result.bytes_.insert(result.bytes_.end(), part.begin(), part.end());
    result.offset_.push_back(static_cast<std::uint32_t>(result.bytes_.size()));
    result.stored_chunks_ += !part.empty();
    result.raw_chunks_ += part.size() > sizeof(Chunk);
  }
  return result;
}

DecodeStatus decompress_chunk(const CompressedSprite& sprite, int column, int row, Chunk& chunk) {
  chunk = {};
  const auto bytes = sprite.chunk_bytes(column, row);
  if (bytes.empty()) return DecodeStatus::Ok;
  const DecodeStatus status = decompress_chunk(bytes, chunk);
  clear_outside(sprite.size_px(), column, row, chunk);
  return status;
}

Sprite decompress(const CompressedSprite& sprite) {
  const int columns = sprite.chunks().x, count = columns * sprite.chunks().y;
  std::vector<int> places;
  for (int i = 0; i < count; ++i)
    if (!sprite.chunk_bytes(i % columns, i / columns).empty()) places.push_back(i);
  std::vector<Chunk> chunks(places.size());
  const JobOrder order(places.size());
  tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t job) {
    const std::size_t i = order[job];
    const DecodeStatus status = decompress_chunk(sprite, places[i] % columns, places[i] / columns, chunks[i]);
    TALISMAN_CHECK(status == DecodeStatus::Ok);  // its bytes come from `compress`
  });
  return Sprite::assemble(sprite.size_px(), places, chunks);
}

double CompressionError::color_psnr_db() const { return psnr_db(color_squared, color_weight); }
double CompressionError::alpha_psnr_db() const { return psnr_db(alpha_squared, texels); }

CompressionError& CompressionError::operator+=(const CompressionError& o) {
  color_squared += o.color_squared;
  color_weight += o.color_weight;
  alpha_squared += o.alpha_squared;
  texels += o.texels;
  return *this;
}

CompressionError compression_error(const Sprite& original, const Sprite& decoded) {
  TALISMAN_CHECK(original.size_px() == decoded.size_px());
  CompressionError error;
  for (int row = 0; row < original.chunks().y; ++row)
    for (int column = 0; column < original.chunks().x; ++column)
      if (const Chunk* chunk = original.chunk(column, row))
        error += chunk_error(*chunk, decoded.chunk(column, row));
  return error;
}

}  // namespace talisman::chunker
