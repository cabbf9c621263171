// SPDX-License-Identifier: Apache-2.0
// Vertices, snapping, shading and encoding are those of the fast path; they are functions of one vertex or
// one point. What the reference does on its own is everything between: which samples are covered, what is
// seen in each, and how they add up.
#include <algorithm>

#include "chunker/coverage.h"
#include "chunker/draw_list.h"
#include "chunker/fragment.h"
#include "chunker/reference.h"

namespace talisman::chunker::reference {
namespace {

struct Surface {
  float depth;
  std::uint32_t order;
  Float4 color;
};

/// Is the sample at (x, y), in 1/256 texel, on the inner side of the edge, or on it and owned by it?
bool inside_edge(const Triangle& t, int from, int to, std::int64_t x, std::int64_t y) {
  const std::int64_t dx = t.x[to] - t.x[from], dy = t.y[to] - t.y[from];
  const std::int64_t e = dx * (y - t.y[from]) - dy * (x - t.x[from]);
  const bool top = dy == 0 && dx > 0, left = dy < 0;
  return e > 0 || (e == 0 && (top || left));
}

std::uint16_t mask_of(const Triangle& t, int x, int y) {
  unsigned mask = 0;
  for (int s = 0; s < kSamples; ++s) {
    const std::int64_t sx = static_cast<std::int64_t>(x) * 256 + 32 + 64 * (s % 4);
    const std::int64_t sy = static_cast<std::int64_t>(y) * 256 + 32 + 64 * (s / 4);
    if (inside_edge(t, 0, 1, sx, sy) && inside_edge(t, 1, 2, sx, sy) && inside_edge(t, 2, 0, sx, sy))
      mask |= 1u << s;
  }
  return static_cast<std::uint16_t>(mask);
}

Float4 color_of(const DrawList& list, const Triangle& t, std::uint16_t mask, int x, int y) {
  const Batch& batch = list.batches[t.batch];
  const Interpolator interpolator =
      interpolator_of(t, gradients_of(t), batch.attributes.data(), batch.shader.layout.count);
  const Centroid at = centroid_of(mask);
  const float dx = from_corner(x, t.x[0]) + at.x, dy = from_corner(y, t.y[0]) + at.y;
  return shade(batch.shader, interpolator, dx, dy);
}

Float4 composite_front_to_back(std::vector<Surface>& surfaces) {
  std::sort(surfaces.begin(), surfaces.end(), [](const Surface& a, const Surface& b) {
    return a.depth != b.depth ? a.depth > b.depth : a.order < b.order;
  });
  SampleSum sum;
  for (const Surface& surface : surfaces) sum.add_behind(surface.color);
  return sum.color;
}

Texel texel_at(const DrawList& list, int samples_per_texel, int x, int y) {
  std::array<std::vector<Surface>, kSamples> surfaces;
  for (std::uint32_t order = 0; order < list.triangles.size(); ++order) {
    const Triangle& t = list.triangles[order];
    std::uint16_t mask = mask_of(t, x, y);
    if (samples_per_texel != kSamples) mask = reduced_mask(mask, samples_per_texel);
    if (mask == 0) continue;
    DepthPlane plane = depth_plane(t, gradients_of(t), x, y);
    if (samples_per_texel == 1) plane = flattened(plane, kOnlySample);
    const Float4 color = color_of(list, t, mask, x, y);
    for (int s = 0; s < kSamples; ++s)
      if (mask >> s & 1) surfaces[s].push_back({depth_at(plane, s), order, color});
  }
  std::array<Float4, kSamples> samples;
  for (int s = 0; s < kSamples; ++s) samples[s] = composite_front_to_back(surfaces[s]);
  Float4 mean = mean_of_samples(samples);
  finish_term(list.term, {&mean, 1});
  return encode({mean[0], mean[1], mean[2], mean[3]});
}

}  // namespace

Sprite render(const PreparedScene& prepared, const layers::SceneFrame& frame, std::span<const int> parts,
              layers::ivec2 display_px, const layers::SpritePlacement& placement,
              const RenderOptions& options, const ShadeInputs& inputs) {
  DrawList list;
  build_draw_list(prepared, frame, parts, display_px, placement, options, inputs, list);
  Sprite sprite(list.size_px);
  for (int row = 0; row < sprite.chunks().y; ++row)
    for (int column = 0; column < sprite.chunks().x; ++column) {
      Chunk chunk{};
      for (int i = 0; i < kChunkSize * kChunkSize; ++i) {
        const int x = column * kChunkSize + i % kChunkSize, y = row * kChunkSize + i / kChunkSize;
        if (x < list.size_px.x && y < list.size_px.y) chunk.texels[i] = texel_at(list, options.samples, x, y);
      }
      sprite.store(column, row, chunk);
    }
  return sprite;
}

}  // namespace talisman::chunker::reference
