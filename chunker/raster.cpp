// SPDX-License-Identifier: Apache-2.0
#include "chunker/raster.h"

#include <limits>

namespace talisman::chunker {
namespace {

Texel encoded(Float4 c) { return encode({c[0], c[1], c[2], c[3]}); }

bool is_nothing(Float4 c) { return c[0] == 0 && c[1] == 0 && c[2] == 0 && c[3] == 0; }

}  // namespace

Chunk ChunkRenderer::draw(std::span<const std::uint32_t> triangles, layers::ivec2 origin) {
  Chunk chunk{};
  origin_ = origin;
  counters_.polygon_chunks += static_cast<std::int64_t>(triangles.size());
  const LatticeBox box{0, 0, std::min(kChunkSize, list_.size_px.x - origin.x) - 1,
                       std::min(kChunkSize, list_.size_px.y - origin.y) - 1};
  draw_box(triangles, box, chunk);
  return chunk;
}

void ChunkRenderer::draw_box(std::span<const std::uint32_t> triangles, const LatticeBox& box, Chunk& out) {
  const bool single = box.x0 == box.x1 && box.y0 == box.y1;
  const int limit = single ? std::numeric_limits<int>::max() : options_.max_fragments_per_chunk;
  buffer_.clear(box, limit, {options_.merge_depth, options_.merge_color});
  if (!draw_triangles(triangles, box)) {
    draw_quarters(triangles, box, out);
    return;
  }
  for (int y = box.y0; y <= box.y1; ++y)
    for (int x = box.x0; x <= box.x1; ++x)
      out.texels[y * kChunkSize + x] = encoded(buffer_.resolve(y * kChunkSize + x));
}

void ChunkRenderer::draw_quarters(std::span<const std::uint32_t> triangles, const LatticeBox& box,
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

bool ChunkRenderer::draw_triangles(std::span<const std::uint32_t> triangles, const LatticeBox& box) {
  for (const std::uint32_t order : triangles)
    if (!draw_triangle(order, box)) return false;
  return true;
}

bool ChunkRenderer::draw_triangle(std::uint32_t order, const LatticeBox& box) {
  const Triangle& t = list_.triangles[order];
  LatticeBox texels = texels_of(sample_box(t));
  texels = intersection(
      box, {texels.x0 - origin_.x, texels.y0 - origin_.y, texels.x1 - origin_.x, texels.y1 - origin_.y});
  if (texels.empty()) return true;
  const EdgeSet edges = edges_of(t, origin_.x, origin_.y);
  if (!may_cover(edges, texels)) return true;
  cover(edges, texels, coverage_);
  const Batch& batch = list_.batches[t.batch];
  const bool textured = batch.shader.pyramid != nullptr;
  if (batch.shader.per_pixel)
    return textured ? draw_covered<true, true>(t, batch, order, texels)
                    : draw_covered<false, true>(t, batch, order, texels);
  return textured ? draw_covered<true, false>(t, batch, order, texels)
                  : draw_covered<false, false>(t, batch, order, texels);
}

/// False if the fragments did not fit.
template <bool kTextured, bool kPerPixel>
bool ChunkRenderer::draw_covered(const Triangle& t, const Batch& batch, std::uint32_t order,
                                 const LatticeBox& box) {
  const Gradients gradients = gradients_of(t);
  Interpolator interpolator;
  bool prepared = false;
  std::int64_t shaded = 0;
  bool fits = true;
  for (int y = box.y0; y <= box.y1 && fits; ++y) {
    const float dy = from_corner(origin_.y + y, t.y[0]);
    for (std::uint32_t left = coverage_.touched[y]; left != 0 && fits; left &= left - 1) {
      const int x = __builtin_ctz(left), texel = y * kChunkSize + x;
      Fragment fragment;
      fragment.order = order;
      fragment.mask = coverage_.full[y] >> x & 1 ? kFullMask : coverage_.mask[texel];
      fragment.depth = depth_plane(t, gradients, origin_.x + x, origin_.y + y);
      if (buffer_.hides(texel, fragment.mask, fragment.depth)) continue;
      if (!prepared) {
        interpolator = interpolator_of(t, gradients, batch.attributes.data(), batch.shader.layout.count);
        prepared = true;
      }
      const Centroid at = centroid_of(fragment.mask);
      const float dx = from_corner(origin_.x + x, t.x[0]);
      fragment.color = shade<kTextured, kPerPixel>(batch.shader, interpolator, dx + at.x, dy + at.y);
      ++shaded;
      if (!is_nothing(fragment.color)) fits = add(texel, fragment);
    }
  }
  counters_.pixels_shaded += shaded;
  if constexpr (kTextured) counters_.texture_samples += shaded;
  return fits;
}

bool ChunkRenderer::add(int texel, const Fragment& fragment) {
  const Added added = buffer_.add(texel, fragment);
  counters_.pixels_filled += added != Added::Refused ? 1 : 0;
  counters_.fragments += added == Added::Stored ? 1 : 0;
  counters_.fragments_merged += added == Added::Merged ? 1 : 0;
  return added != Added::Refused;
}

}  // namespace talisman::chunker
