// SPDX-License-Identifier: Apache-2.0
#include "chunker/bin.h"

#include "chunker/coverage.h"

namespace talisman::chunker {
namespace {

constexpr LatticeBox kWholeChunk{0, 0, kChunkSize - 1, kChunkSize - 1};

LatticeBox chunks_of(const Triangle& t, const LatticeBox& sprite) {
  const LatticeBox texels = intersection(texels_of(sample_box(t)), sprite);
  return {texels.x0 / kChunkSize, texels.y0 / kChunkSize, texels.x1 / kChunkSize, texels.y1 / kChunkSize};
}

/// Visits (triangle, chunk) pairs in the order of the triangles.
template <typename Visit>
void for_each_pair(std::span<const Triangle> triangles, layers::ivec2 size_px, int columns, Visit visit) {
  const LatticeBox sprite{0, 0, size_px.x - 1, size_px.y - 1};
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const LatticeBox box = chunks_of(triangles[i], sprite);
    const bool few = (box.x1 - box.x0 + 1) * (box.y1 - box.y0 + 1) <= 2;
    for (int row = box.y0; row <= box.y1; ++row)
      for (int column = box.x0; column <= box.x1; ++column)
        if (few || may_cover(edges_of(triangles[i], column * kChunkSize, row * kChunkSize), kWholeChunk))
          visit(i, row * columns + column);
  }
}

}  // namespace

Bins bin_triangles(std::span<const Triangle> triangles, layers::ivec2 size_px) {
  Bins bins;
  bins.chunks = {(size_px.x + kChunkSize - 1) / kChunkSize, (size_px.y + kChunkSize - 1) / kChunkSize};
  const int columns = bins.chunks.x;
  bins.first.assign(static_cast<std::size_t>(bins.chunks.x) * bins.chunks.y + 1, 0);
  for_each_pair(triangles, size_px, columns, [&](std::uint32_t, int chunk) { ++bins.first[chunk + 1]; });
  for (std::size_t c = 1; c < bins.first.size(); ++c) bins.first[c] += bins.first[c - 1];
  bins.triangles.resize(bins.first.back());
  std::vector<std::uint32_t> next(bins.first.begin(), bins.first.end() - 1);
  for_each_pair(triangles, size_px, columns,
                [&](std::uint32_t i, int chunk) { bins.triangles[next[chunk]++] = i; });
  return bins;
}

}  // namespace talisman::chunker
