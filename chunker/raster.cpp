// SPDX-License-Identifier: Apache-2.0
#include "chunker/raster.h"

#include <limits>

#include "chunker/encode_row.h"

namespace talisman::chunker {
namespace {

/// What of depth_plane() and of a point's place does not change along a column of texels.
struct ColumnTerms {
  std::array<double, kChunkSize> depth;       ///< at the middle of the column, without the share of y
  std::array<float, kChunkSize> from_corner;  ///< of the triangle's first, texels
  ColumnTerms(const Triangle& t, const Gradients& gradients, int origin_x, const LatticeBox& box) {
    for (int x = box.x0; x <= box.x1; ++x) {
      from_corner[x] = chunker::from_corner(origin_x + x, t.x[0]);
      depth[x] = t.depth[0] + gradients.depth_x * (static_cast<double>(from_corner[x]) + 0.5);
    }
  }
};

bool is_nothing(Float4 c) { return c[3] == 0 && c[0] == 0 && c[1] == 0 && c[2] == 0; }

}  // namespace

template <int kCount>
Chunk ChunkRenderer<kCount>::draw(std::span<const std::uint32_t> triangles, layers::ivec2 origin,
                                  DepthChunk* depth) {
  Chunk chunk{};
  origin_ = origin;
  noted_ = depth;
  counters_.polygon_chunks += static_cast<std::int64_t>(triangles.size());
  const LatticeBox box{0, 0, std::min(kChunkSize, list_.size_px.x - origin.x) - 1,
                       std::min(kChunkSize, list_.size_px.y - origin.y) - 1};
  draw_box(triangles, box, chunk);
  return chunk;
}

template <int kCount>
void ChunkRenderer<kCount>::draw_box(std::span<const std::uint32_t> triangles, const LatticeBox& box,
                                     Chunk& out) {
  const bool single = box.x0 == box.x1 && box.y0 == box.y1;
  const int limit = single ? std::numeric_limits<int>::max() : options_.max_fragments_per_chunk;
  buffer_.clear(box, limit, {options_.merge_depth, options_.merge_color});
  if (!draw_triangles(triangles, box)) {
    draw_quarters(triangles, box, out);
    return;
  }
  std::array<Float4, kChunkSize> row;
  for (int y = box.y0; y <= box.y1; ++y) {
    for (int x = box.x0; x <= box.x1; ++x) row[x] = buffer_.resolve(y * kChunkSize + x);
    finish_row({&row[box.x0], &row[box.x1] + 1}, box.x0, y, out);
  }
  if (noted_ != nullptr) note_depth(box);
}

template <int kCount>
void ChunkRenderer<kCount>::note_depth(const LatticeBox& box) {
  for (int y = box.y0; y <= box.y1; ++y)
    for (int x = box.x0; x <= box.x1; ++x) {
      const int texel = y * kChunkSize + x;
      const Fragment* front = buffer_.nearest(texel);
      if (front == nullptr) continue;
      noted_->z[texel] = FragmentBuffer<kCount>::depth_of(front->depth);
      noted_->part[texel] = list_.triangles[front->order].batch;
    }
}

template <int kCount>
void ChunkRenderer<kCount>::finish_row(std::span<Float4> row, int x0, int y, Chunk& out) const {
  finish_term(list_.term, list_.adds, row);
  if (linear_ == nullptr) {
    encode_row(row.data(), static_cast<int>(row.size()), &out.texels[y * kChunkSize + x0]);
    return;
  }
  LinearColor* to =
      &linear_->texels[static_cast<std::size_t>(origin_.y + y) * linear_->size_px.x + origin_.x + x0];
  for (const Float4& c : row) *to++ = {c[0], c[1], c[2], c[3]};
}

template <int kCount>
void ChunkRenderer<kCount>::draw_quarters(std::span<const std::uint32_t> triangles, const LatticeBox& box,
                                          Chunk& out) {
  ++counters_.chunk_subdivisions;
  const int xm = (box.x0 + box.x1) / 2, ym = (box.y0 + box.y1) / 2;
  const LatticeBox quarters[4] = {{box.x0, box.y0, xm, ym},
                                  {xm + 1, box.y0, box.x1, ym},
                                  {box.x0, ym + 1, xm, box.y1},
                                  {xm + 1, ym + 1, box.x1, box.y1}};
  for (const LatticeBox& quarter : quarters)
    if (!quarter.empty()) draw_box(triangles, quarter, out);
}

template <int kCount>
bool ChunkRenderer<kCount>::draw_triangles(std::span<const std::uint32_t> triangles, const LatticeBox& box) {
  for (const std::uint32_t order : triangles)
    if (!draw_triangle(order, box)) return false;
  return true;
}

template <int kCount>
bool ChunkRenderer<kCount>::draw_triangle(std::uint32_t order, const LatticeBox& box) {
  const Triangle& t = list_.triangles[order];
  LatticeBox texels = texels_of(sample_box(t));
  texels = intersection(
      box, {texels.x0 - origin_.x, texels.y0 - origin_.y, texels.x1 - origin_.x, texels.y1 - origin_.y});
  if (texels.empty()) return true;
  const EdgeSet edges = edges_of(t, origin_.x, origin_.y);
  if (!may_cover(edges, texels)) return true;
  cover<kCount>(edges, texels, coverage_);
  const Gradients gradients = gradients_of(t);
  gather_visible(t, gradients, texels);
  if (batch_.count == 0) return true;
  const Batch& batch = list_.batches[t.batch];
  const Shader& shader = batch.shader;
  shade_batch(shader, interpolator_of(t, gradients, batch.attributes.data(), shader.layout.count), batch_);
  count_shading(shader);
  return shader.opaque ? store_fragments<true>(order) : store_fragments<false>(order);
}

template <int kCount>
void ChunkRenderer<kCount>::count_shading(const Shader& shader) {
  counters_.pixels_shaded += batch_.count;
  counters_.texture_samples += batch_.texture_samples;
  if (shader.shadowed)
    counters_.shadow_lookups += static_cast<std::int64_t>(batch_.count) * shader.lights->shadows;
  if (shader.reflection != nullptr) counters_.reflection_lookups += batch_.count;
}

template <int kCount>
void ChunkRenderer<kCount>::gather_visible(const Triangle& t, const Gradients& gradients,
                                           const LatticeBox& box) {
  int count = 0;
  depth_dx_ = static_cast<float>(gradients.depth_x);
  depth_dy_ = static_cast<float>(gradients.depth_y);
  const ColumnTerms columns(t, gradients, origin_.x, box);
  for (int y = box.y0; y <= box.y1; ++y) {
    const float dy = from_corner(origin_.y + y, t.y[0]);
    const double depth_of_row = gradients.depth_y * (static_cast<double>(dy) + 0.5);
    for (std::uint32_t left = coverage_.touched[y]; left != 0; left &= left - 1) {
      const int x = __builtin_ctz(left), texel = y * kChunkSize + x;
      const bool full = coverage_.full[y] >> x & 1;
      const std::uint16_t mask = full ? Samples<kCount>::kFull : coverage_.mask[texel];
      const DepthPlane depth{static_cast<float>(columns.depth[x] + depth_of_row), depth_dx_, depth_dy_};
      if (buffer_.hides(texel, mask, depth)) continue;
      const Centroid at = full ? Centroid{0.5f, 0.5f} : centroid_of<kCount>(mask);
      texel_[count] = static_cast<std::uint16_t>(texel);
      mask_[count] = mask;
      depth_[count] = depth.z;
      batch_.dx[count] = columns.from_corner[x] + at.x;
      batch_.dy[count] = dy + at.y;
      ++count;
    }
  }
  batch_.count = count;
}

/// False if the fragments did not fit.
template <int kCount>
template <bool kOpaque>
bool ChunkRenderer<kCount>::store_fragments(std::uint32_t order) {
  Fragment fragment;
  fragment.order = order;
  fragment.depth.dx = depth_dx_;
  fragment.depth.dy = depth_dy_;
  for (int i = 0; i < batch_.count; ++i) {
    fragment.mask = mask_[i];
    fragment.depth.z = depth_[i];
    fragment.color = batch_.color[i];
    if constexpr (!kOpaque)
      if (is_nothing(fragment.color)) continue;
    if (!add<kOpaque>(texel_[i], fragment)) return false;
  }
  return true;
}

template <int kCount>
template <bool kOpaque>
bool ChunkRenderer<kCount>::add(int texel, const Fragment& fragment) {
  const Added added = buffer_.template add<kOpaque>(texel, fragment);
  counters_.pixels_filled += added != Added::Refused ? 1 : 0;
  counters_.fragments += added == Added::Stored ? 1 : 0;
  counters_.fragments_merged += added == Added::Merged ? 1 : 0;
  return added != Added::Refused;
}

template class ChunkRenderer<1>;
template class ChunkRenderer<4>;
template class ChunkRenderer<16>;

}  // namespace talisman::chunker
