// SPDX-License-Identifier: Apache-2.0
#include "chunker/plan_buffer.h"

#include <algorithm>

#include <glm/common.hpp>

#include "chunker/join_lanes.h"
#include "layers/check.h"

namespace talisman::chunker {

JoinCounters& JoinCounters::operator+=(const JoinCounters& o) {
  joins += o.joins;
  pixels_compared += o.pixels_compared;
  pixels_copied += o.pixels_copied;
  pixels_cleared += o.pixels_cleared;
  pixels_skipped += o.pixels_skipped;
  return *this;
}

void join_chunks(const Chunk& other_color, const DepthChunk& other_depth, Chunk& color, DepthChunk& depth) {
  static_assert(sizeof(Texel) == sizeof(std::uint32_t));
  // Words of four bytes, as they lie in memory: gcc's own vectors, which these are loaded as, may alias anything.
  join_lanes({other_depth.z.data(), other_depth.part.data(),
              reinterpret_cast<const std::uint32_t*>(other_color.texels)},
             {depth.z.data(), depth.part.data(), reinterpret_cast<std::uint32_t*>(color.texels)},
             kChunkSize * kChunkSize);
}

PlanBuffer::PlanBuffer(layers::ivec2 size_px)
    : size_px_(size_px), chunks_((size_px + kChunkSize - 1) / kChunkSize) {
  TALISMAN_CHECK(size_px.x >= 0 && size_px.y >= 0);
  reference_.assign(static_cast<std::size_t>(chunks_.x) * chunks_.y, -1);
}

void PlanBuffer::clear(JoinCounters& counters) {
  counters.pixels_cleared += stored_ * pixels();
  stored_ = 0;
  reference_.assign(reference_.size(), -1);
}

int PlanBuffer::take_chunk() {
  if (stored_ == static_cast<int>(color_.size())) {
    color_.emplace_back();
    depth_.emplace_back();
  }
  return stored_++;
}

void PlanBuffer::put(int place, const Chunk& color, const DepthChunk& depth) {
  TALISMAN_CHECK_EQ(reference_[place], -1);
  const int slot = take_chunk();
  reference_[place] = slot;
  color_[slot] = color;
  depth_[slot] = depth;
}

void PlanBuffer::copy(const PlanBuffer& other, JoinCounters& counters) {
  TALISMAN_CHECK(size_px_ == other.size_px_);
  color_.resize(std::max(color_.size(), static_cast<std::size_t>(other.stored_)));
  depth_.resize(color_.size());
  std::copy_n(other.color_.begin(), other.stored_, color_.begin());
  std::copy_n(other.depth_.begin(), other.stored_, depth_.begin());
  reference_ = other.reference_;
  stored_ = other.stored_;
  counters.pixels_copied += stored_ * pixels();
}

void PlanBuffer::join(const PlanBuffer& other, JoinCounters& counters) {
  TALISMAN_CHECK(size_px_ == other.size_px_);
  ++counters.joins;
  for (std::size_t place = 0; place < reference_.size(); ++place) {
    const std::int32_t from = other.reference_[place], to = reference_[place];
    if (from < 0) {
      counters.pixels_skipped += pixels();
    } else if (to < 0) {
      put(static_cast<int>(place), other.color_[from], other.depth_[from]);
      counters.pixels_copied += pixels();
    } else {
      join_chunks(other.color_[from], other.depth_[from], color_[to], depth_[to]);
      counters.pixels_compared += pixels();
    }
  }
}

const Chunk* PlanBuffer::color(int place) const {
  return reference_[place] < 0 ? nullptr : &color_[reference_[place]];
}

const DepthChunk* PlanBuffer::depth(int place) const {
  return reference_[place] < 0 ? nullptr : &depth_[reference_[place]];
}

Sprite PlanBuffer::sprite() const {
  std::vector<int> places;
  std::vector<Chunk> chunks;
  places.reserve(stored_);
  chunks.reserve(stored_);
  for (std::size_t place = 0; place < reference_.size(); ++place) {
    if (reference_[place] < 0) continue;
    places.push_back(static_cast<int>(place));
    chunks.push_back(color_[reference_[place]]);
  }
  return Sprite::assemble(size_px_, places, chunks);
}

std::int64_t PlanBuffer::edge_texels() const {
  std::int64_t count = 0;
  for (int place = 0; place < static_cast<int>(reference_.size()); ++place) {
    if (reference_[place] < 0) continue;
    const layers::ivec2 first = kChunkSize * layers::ivec2(place % chunks_.x, place / chunks_.x),
                        shown = glm::min(size_px_ - first, layers::ivec2(kChunkSize));
    const Chunk& chunk = color_[reference_[place]];
    for (int y = 0; y < shown.y; ++y)
      for (int x = 0; x < shown.x; ++x) {
        const Texel& texel = chunk.texels[y * kChunkSize + x];
        count += texel.a != 0 && texel.a != 255;
      }
  }
  return count;
}

std::int64_t PlanBuffer::bytes() const {
  return static_cast<std::int64_t>(reference_.size() * sizeof(std::int32_t)) +
         stored_ * static_cast<std::int64_t>(sizeof(Chunk) + sizeof(DepthChunk));
}

}  // namespace talisman::chunker
