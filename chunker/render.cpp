// SPDX-License-Identifier: Apache-2.0
#include "chunker/render.h"

#include <algorithm>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "chunker/bin.h"
#include "chunker/clip.h"
#include "chunker/raster.h"
#include "layers/check.h"

namespace talisman::chunker {
namespace {

/// Fixed point reaches this far; see kGuardBandPx.
constexpr int kLargestSpritePx = static_cast<int>(2 * kGuardBandPx);

void check_options(const layers::SpritePlacement& placement, const RenderOptions& options) {
  TALISMAN_CHECK_LE(placement.size_px.x, kLargestSpritePx);
  TALISMAN_CHECK_LE(placement.size_px.y, kLargestSpritePx);
  TALISMAN_CHECK_GE(options.max_fragments_per_chunk, 16);
  TALISMAN_CHECK(options.merge_depth >= 0 && options.merge_color >= 0);
  TALISMAN_CHECK(options.samples == 1 || options.samples == 4 || options.samples == 16);
  TALISMAN_CHECK(options.max_anisotropy >= 1 && options.max_anisotropy <= 16);
}

/// The chunks in which there is something to draw.
struct Work {
  Bins bins;
  std::vector<int> places;
};

Work set_up(const PreparedScene& prepared, const layers::SceneFrame& frame, std::span<const int> parts,
            layers::ivec2 display_px, const layers::SpritePlacement& placement, const RenderOptions& options,
            const ShadeInputs& inputs, DrawList& list) {
  check_options(placement, options);
  build_draw_list(prepared, frame, parts, display_px, placement, options, inputs, list);
  Work work{bin_triangles(list.triangles, list.size_px), {}};
  for (int c = 0; c < work.bins.count(); ++c)
    if (!work.bins.of(c).empty()) work.places.push_back(c);
  return work;
}

/// Draws every place; finished chunks go to `take(index of the place, chunk)`.
template <typename Take>
RenderCounters draw_chunks(const DrawList& list, const Work& work, const RenderOptions& options,
                           LinearImage* linear, const Take& take) {
  const std::vector<int>& places = work.places;
  const int columns = work.bins.chunks.x;
  tbb::enumerable_thread_specific<ChunkRenderer> renderers(
      [&] { return ChunkRenderer(list, options, linear); });
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, places.size()), [&](const auto& range) {
    ChunkRenderer& renderer = renderers.local();
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const layers::ivec2 origin(places[i] % columns * kChunkSize, places[i] / columns * kChunkSize);
      take(i, renderer.draw(work.bins.of(places[i]), origin));
    }
  });
  RenderCounters counters;
  for (const ChunkRenderer& renderer : renderers) counters += renderer.counters();
  counters.polygons_in = list.polygons_in;
  counters.polygons_drawn = static_cast<std::int64_t>(list.triangles.size());
  return counters;
}

}  // namespace

RenderCounters& RenderCounters::operator+=(const RenderCounters& o) {
  polygons_in += o.polygons_in;
  polygons_drawn += o.polygons_drawn;
  polygon_chunks += o.polygon_chunks;
  chunks_rendered += o.chunks_rendered;
  chunks_clear += o.chunks_clear;
  pixels_filled += o.pixels_filled;
  pixels_shaded += o.pixels_shaded;
  fragments += o.fragments;
  fragments_merged += o.fragments_merged;
  chunk_subdivisions += o.chunk_subdivisions;
  texture_samples += o.texture_samples;
  shadow_lookups += o.shadow_lookups;
  reflection_lookups += o.reflection_lookups;
  return *this;
}

PreparedScene::PreparedScene(const layers::Scene& scene) : impl_(std::make_unique<Impl>()) {
  impl_->scene = &scene;
  impl_->pyramids.resize(scene.textures.size());
  std::vector<int> used;
  for (const layers::Part& part : scene.parts)
    if (part.material >= 0) {
      used.push_back(scene.materials[part.material].texture);
      used.push_back(scene.materials[part.material].texture2);
    }
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  std::erase_if(used, [&](int t) { return t < 0 || t >= static_cast<int>(scene.textures.size()); });
  tbb::parallel_for(std::size_t{0}, used.size(), [&](std::size_t i) {
    impl_->pyramids[used[i]] = build_pyramid(scene.textures[used[i]]);
  });
}

PreparedScene::~PreparedScene() = default;
PreparedScene::PreparedScene(PreparedScene&&) noexcept = default;
PreparedScene& PreparedScene::operator=(PreparedScene&&) noexcept = default;

const layers::Scene& PreparedScene::scene() const { return *impl_->scene; }

std::int64_t PreparedScene::texture_bytes() const {
  std::int64_t sum = 0;
  for (const Pyramid& pyramid : impl_->pyramids) sum += pyramid.bytes();
  return sum;
}

RenderResult render(const PreparedScene& prepared, const layers::SceneFrame& frame,
                    std::span<const int> parts, layers::ivec2 display_px,
                    const layers::SpritePlacement& placement, const RenderOptions& options,
                    const ShadeInputs& inputs) {
  DrawList list;
  const Work work = set_up(prepared, frame, parts, display_px, placement, options, inputs, list);
  std::vector<Chunk> chunks(work.places.size());
  RenderResult result;
  result.counters = draw_chunks(list, work, options, nullptr,
                                [&](std::size_t i, const Chunk& chunk) { chunks[i] = chunk; });
  result.sprite = Sprite::assemble(list.size_px, work.places, chunks);
  result.counters.chunks_rendered = result.sprite.stored_chunks();
  result.counters.chunks_clear = result.sprite.clear_chunks();
  return result;
}

LinearImage render_linear(const PreparedScene& prepared, const layers::SceneFrame& frame,
                          std::span<const int> parts, layers::ivec2 display_px,
                          const layers::SpritePlacement& placement, const RenderOptions& options,
                          const ShadeInputs& inputs) {
  DrawList list;
  const Work work = set_up(prepared, frame, parts, display_px, placement, options, inputs, list);
  LinearImage image;
  image.size_px = list.size_px;
  image.texels.resize(static_cast<std::size_t>(list.size_px.x) * list.size_px.y);
  image.counters = draw_chunks(list, work, options, &image, [](std::size_t, const Chunk&) {});
  image.counters.chunks_rendered = static_cast<std::int64_t>(work.places.size());
  image.counters.chunks_clear = work.bins.count() - image.counters.chunks_rendered;
  return image;
}

}  // namespace talisman::chunker
