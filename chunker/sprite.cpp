// SPDX-License-Identifier: Apache-2.0
#include "chunker/sprite.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "chunker/late_chunks.h"
#include "layers/check.h"

namespace talisman::chunker {
namespace {

constexpr int kClear = -1;
constexpr int kReplaced = -2;  ///< and below

/// Two texels at a time; a block is opaque when the bits of all its alphas are set.
using TexelPair = std::uint64_t;

TexelPair texel_pair(const Texel* texels) {
  TexelPair pair;
  std::memcpy(&pair, texels, sizeof pair);
  return pair;
}

}  // namespace

bool is_clear_chunk(const Chunk& chunk) {
  static const Chunk clear{};
  return std::memcmp(&chunk, &clear, sizeof(Chunk)) == 0;
}

std::uint16_t opaque_blocks_of(const Chunk& chunk) {
  constexpr Texel kAlphaBits[2] = {{0, 0, 0, 255}, {0, 0, 0, 255}};
  const TexelPair alpha_bits = texel_pair(kAlphaBits);
  std::uint16_t opaque = 0;
  for (int block = 0; block < 16; ++block) {
    const Texel* corner = chunk.texels + block / 4 * (8 * kChunkSize) + block % 4 * 8;
    TexelPair common = alpha_bits;
    for (int row = 0; row < 8; ++row) {
      for (int pair = 0; pair < 4; ++pair) common &= texel_pair(corner + row * kChunkSize + 2 * pair);
    }
    if (common == alpha_bits) opaque |= static_cast<std::uint16_t>(1u << block);
  }
  return opaque;
}

Sprite::Sprite(layers::ivec2 size_px) : size_px_(size_px) {
  TALISMAN_CHECK_GE(size_px.x, 0);
  TALISMAN_CHECK_GE(size_px.y, 0);
  chunks_ = {(size_px.x + kChunkSize - 1) / kChunkSize, (size_px.y + kChunkSize - 1) / kChunkSize};
  reference_.assign(static_cast<std::size_t>(chunks_.x) * chunks_.y, kClear);
}

Sprite Sprite::assemble(layers::ivec2 size_px, std::span<const int> places, std::span<const Chunk> chunks) {
  TALISMAN_CHECK_EQ(places.size(), chunks.size());
  Sprite sprite(size_px);
  sprite.storage_.reserve(chunks.size());
  sprite.opaque_.reserve(chunks.size());
  for (std::size_t i = 0; i < places.size(); ++i)
    sprite.store(places[i] % sprite.chunks_.x, places[i] / sprite.chunks_.x, chunks[i]);
  return sprite;
}

Sprite Sprite::late(layers::ivec2 size_px, std::span<const int> places, std::shared_ptr<LateChunks> chunks) {
  TALISMAN_CHECK_EQ(static_cast<int>(places.size()), chunks->count());
  Sprite sprite(size_px);
  for (std::size_t i = 0; i < places.size(); ++i) sprite.reference_[places[i]] = static_cast<std::int32_t>(i);
  sprite.late_ = std::move(chunks);
  return sprite;
}

bool Sprite::may_hold(int column, int row) const {
  TALISMAN_CHECK(column >= 0 && column < chunks_.x && row >= 0 && row < chunks_.y);
  return reference_[static_cast<std::size_t>(row) * chunks_.x + column] != kClear;
}

const Chunk* Sprite::chunk(int column, int row) const {
  TALISMAN_CHECK(column >= 0 && column < chunks_.x && row >= 0 && row < chunks_.y);
  const std::int32_t index = reference_[static_cast<std::size_t>(row) * chunks_.x + column];
  if (late_ && index > kClear) return late_->chunk(index);
  return index == kClear ? nullptr : &storage_[late_ ? kReplaced - index : index];
}

std::uint16_t Sprite::opaque_blocks(int column, int row) const {
  TALISMAN_CHECK(column >= 0 && column < chunks_.x && row >= 0 && row < chunks_.y);
  const std::int32_t index = reference_[static_cast<std::size_t>(row) * chunks_.x + column];
  if (late_ && index > kClear) return late_->opaque_blocks(index);
  return index == kClear ? std::uint16_t{0} : opaque_[late_ ? kReplaced - index : index];
}

void Sprite::store(int column, int row, const Chunk& chunk) {
  TALISMAN_CHECK(column >= 0 && column < chunks_.x && row >= 0 && row < chunks_.y);
  TALISMAN_CHECK(late_ == nullptr);
  std::int32_t& reference = reference_[static_cast<std::size_t>(row) * chunks_.x + column];
  if (is_clear_chunk(chunk)) {
    if (reference != kClear) release(reference);
    return;
  }
  if (reference != kClear) {
    storage_[reference] = chunk;
    opaque_[reference] = opaque_blocks_of(chunk);
    return;
  }
  reference = static_cast<std::int32_t>(storage_.size());
  storage_.push_back(chunk);
  opaque_.push_back(opaque_blocks_of(chunk));
}

void Sprite::replace(int column, int row, const Chunk& chunk) {
  if (late_ == nullptr) return store(column, row, chunk);
  TALISMAN_CHECK(column >= 0 && column < chunks_.x && row >= 0 && row < chunks_.y);
  std::int32_t& reference = reference_[static_cast<std::size_t>(row) * chunks_.x + column];
  if (reference > kReplaced && is_clear_chunk(chunk)) {
    reference = kClear;
    return;
  }
  if (reference > kReplaced) {
    reference = kReplaced - static_cast<std::int32_t>(storage_.size());
    storage_.emplace_back();
    opaque_.emplace_back();
  }
  storage_[kReplaced - reference] = chunk;  // a clear one stays: there is no list of gaps
  opaque_[kReplaced - reference] = opaque_blocks_of(chunk);
}

void Sprite::release(std::int32_t& reference) {
  // The last stored chunk moves into the gap, so that storage never holds a chunk that nobody refers to.
  const auto last = static_cast<std::int32_t>(storage_.size()) - 1;
  const std::int32_t gap = std::exchange(reference, kClear);
  if (gap != last) {
    storage_[gap] = storage_[last];
    opaque_[gap] = opaque_[last];
    *std::find(reference_.begin(), reference_.end(), last) = gap;
  }
  storage_.pop_back();
  opaque_.pop_back();
}

Texel Sprite::texel(int x, int y) const {
  if (x < 0 || y < 0 || x >= size_px_.x || y >= size_px_.y) return {};
  const Chunk* stored = chunk(x / kChunkSize, y / kChunkSize);
  return stored ? stored->texels[(y % kChunkSize) * kChunkSize + x % kChunkSize] : Texel{};
}

std::int64_t Sprite::stored_chunks() const {
  return late_ ? late_->count() : static_cast<std::int64_t>(storage_.size());
}

std::int64_t Sprite::clear_chunks() const {
  return static_cast<std::int64_t>(reference_.size()) - stored_chunks();
}

std::int64_t Sprite::bytes() const {
  return stored_chunks() * static_cast<std::int64_t>(sizeof(Chunk)) +
         static_cast<std::int64_t>(reference_.size() * sizeof(std::int32_t));
}

void SpriteStore::put(int layer, Sprite sprite) {
  const std::int64_t bytes = sprite.bytes();
  put(layer, std::move(sprite), bytes);
}

void SpriteStore::put(int layer, Sprite sprite, std::int64_t stored_bytes) {
  TALISMAN_CHECK_GE(layer, 0);
  const auto index = static_cast<std::size_t>(layer);
  if (index >= sprites_.size()) {
    sprites_.resize(index + 1);
    alive_.resize(index + 1, false);
    stored_bytes_.resize(index + 1, 0);
  }
  sprites_[index] = std::move(sprite);
  alive_[index] = true;
  stored_bytes_[index] = stored_bytes;
}

const Sprite* SpriteStore::find(int layer) const {
  const bool known = layer >= 0 && static_cast<std::size_t>(layer) < sprites_.size() && alive_[layer];
  return known ? &sprites_[layer] : nullptr;
}

void SpriteStore::drop(int layer) {
  if (find(layer) == nullptr) return;
  sprites_[layer] = Sprite();
  alive_[layer] = false;
  stored_bytes_[layer] = 0;
}

void SpriteStore::replace(int layer, std::span<const int> places, std::span<const Chunk> chunks) {
  TALISMAN_CHECK(find(layer) != nullptr);
  TALISMAN_CHECK_EQ(places.size(), chunks.size());
  Sprite& sprite = sprites_[layer];
  for (std::size_t i = 0; i < places.size(); ++i)
    sprite.replace(places[i] % sprite.chunks().x, places[i] / sprite.chunks().x, chunks[i]);
  stored_bytes_[layer] = sprite.bytes();
}

std::int64_t SpriteStore::bytes() const {
  std::int64_t sum = 0;
  for (const std::int64_t bytes : stored_bytes_) sum += bytes;
  return sum;
}

}  // namespace talisman::chunker
