// SPDX-License-Identifier: Apache-2.0
// Vertices, snapping, shading and encoding are those of the fast path; they are functions of one vertex or
// one point. What the reference does on its own is everything between: which samples are covered, what is
// seen in each, and how they add up.
#include <algorithm>
#include <numeric>

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

/// The places of a texel at which it is looked at, of 4×4 (chunker/samples.h).
std::vector<int> places_of(int samples) {
  if (samples == 1) return {5};
  if (samples == 4) return {1, 7, 8, 14};
  std::vector<int> all(kPlaces);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

std::vector<bool> covered(const Triangle& t, const std::vector<int>& places, int x, int y) {
  std::vector<bool> inside;
  for (const int place : places) {
    const std::int64_t sx = static_cast<std::int64_t>(x) * 256 + 32 + 64 * (place % 4);
    const std::int64_t sy = static_cast<std::int64_t>(y) * 256 + 32 + 64 * (place / 4);
    inside.push_back(inside_edge(t, 0, 1, sx, sy) && inside_edge(t, 1, 2, sx, sy) &&
                     inside_edge(t, 2, 0, sx, sy));
  }
  return inside;
}

/// The mean place of what is covered, or the texel's centre where that is all.
Centroid centre_of(const std::vector<bool>& inside, const std::vector<int>& places) {
  int count = 0, x = 0, y = 0;
  for (std::size_t s = 0; s < places.size(); ++s)
    if (inside[s]) {
      ++count;
      x += 2 * (places[s] % 4) + 1;
      y += 2 * (places[s] / 4) + 1;
    }
  if (count == static_cast<int>(places.size())) return {0.5f, 0.5f};
  const float r = 0.125f / static_cast<float>(count);
  return {static_cast<float>(x) * r, static_cast<float>(y) * r};
}

Float4 color_of(const DrawList& list, const Triangle& t, Centroid at, int x, int y) {
  const Batch& batch = list.batches[t.batch];
  const Interpolator interpolator =
      interpolator_of(t, gradients_of(t), batch.attributes.data(), batch.shader.layout.count);
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

/// What each sample sees.
std::vector<Float4> samples_of(const DrawList& list, const std::vector<int>& places, int x, int y) {
  std::vector<std::vector<Surface>> surfaces(places.size());
  for (std::uint32_t order = 0; order < list.triangles.size(); ++order) {
    const Triangle& t = list.triangles[order];
    const std::vector<bool> inside = covered(t, places, x, y);
    if (std::find(inside.begin(), inside.end(), true) == inside.end()) continue;
    const DepthPlane plane = depth_plane(t, gradients_of(t), x, y);
    const Float4 color = color_of(list, t, centre_of(inside, places), x, y);
    for (std::size_t s = 0; s < places.size(); ++s)
      if (inside[s]) surfaces[s].push_back({depth_at(plane, places[s]), order, color});
  }
  std::vector<Float4> samples;
  samples.reserve(surfaces.size());
  for (std::vector<Surface>& of_sample : surfaces) samples.push_back(composite_front_to_back(of_sample));
  return samples;
}

/// Neighbours first, then pairs of pairs: the order of the sum is part of the result.
Float4 mean(std::span<const Float4> samples) {
  if (samples.size() == 1) return samples[0];
  const std::size_t half = samples.size() / 2;
  return (mean(samples.first(half)) + mean(samples.last(half))) * splat(0.5f);
}

Texel texel_at(const DrawList& list, const std::vector<int>& places, int x, int y) {
  Float4 color = mean(samples_of(list, places, x, y));
  finish_term(list.term, list.adds, {&color, 1});
  return encode({color[0], color[1], color[2], color[3]});
}

}  // namespace

Sprite render(const PreparedScene& prepared, const layers::SceneFrame& frame, std::span<const int> parts,
              layers::ivec2 display_px, const layers::SpritePlacement& placement,
              const RenderOptions& options, const ShadeInputs& inputs) {
  DrawList list;
  build_draw_list(prepared, frame, parts, display_px, placement, options, inputs, list);
  const std::vector<int> places = places_of(options.samples);
  Sprite sprite(list.size_px);
  for (int row = 0; row < sprite.chunks().y; ++row)
    for (int column = 0; column < sprite.chunks().x; ++column) {
      Chunk chunk{};
      for (int i = 0; i < kChunkSize * kChunkSize; ++i) {
        const int x = column * kChunkSize + i % kChunkSize, y = row * kChunkSize + i / kChunkSize;
        if (x < list.size_px.x && y < list.size_px.y) chunk.texels[i] = texel_at(list, places, x, y);
      }
      sprite.store(column, row, chunk);
    }
  return sprite;
}

}  // namespace talisman::chunker::reference
