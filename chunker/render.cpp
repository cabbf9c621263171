// SPDX-License-Identifier: Apache-2.0
#include "chunker/render.h"

#include <algorithm>
#include <map>
#include <set>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "chunker/chunk_work.h"
#include "chunker/clip.h"
#include "chunker/depth_render.h"
#include "chunker/job_order.h"
#include "chunker/raster.h"
#include "layers/built_effects.h"
#include "layers/check.h"
#include "layers/shading.h"

namespace talisman::chunker {
namespace {

/// Fixed point reaches this far; see kGuardBandPx.
constexpr int kLargestSpritePx = static_cast<int>(2 * kGuardBandPx);

void check_options(const layers::SpritePlacement& placement, const RenderOptions& options) {
  TALISMAN_CHECK_LE(placement.size_px.x, kLargestSpritePx);
  TALISMAN_CHECK_LE(placement.size_px.y, kLargestSpritePx);
  TALISMAN_CHECK_GE(options.max_fragments_per_chunk, 16);
  TALISMAN_CHECK(options.merge_depth >= 0 && options.merge_color >= 0);
  TALISMAN_CHECK(options.max_anisotropy >= 1 && options.max_anisotropy <= 16);
}

/// The textures that parts use, and whether their coarser levels are needed: everywhere where they are
/// filtered, and where a surface without coordinates shows the mean.
std::map<int, bool> textures_of(const layers::Scene& scene, bool filtered) {
  std::map<int, bool> used;
  for (const layers::Part& part : scene.parts) {
    if (part.material < 0) continue;
    const bool coarser = filtered || scene.meshes[part.mesh].uvs.empty();
    const layers::Material& material = scene.materials[part.material];
    for (const int texture : {material.texture, material.texture2, material.emissive_texture})
      if (texture >= 0 && texture < static_cast<int>(scene.textures.size()))
        used[texture] = used[texture] || coarser;
  }
  if constexpr (layers::is_built(layers::Effect::MovingPicture))
    for (const layers::MovingPicture& picture : scene.moving_pictures)
      if (const auto first = used.find(picture.texture); first != used.end())
        for (const int texture : picture.textures) used[texture] = first->second;
  return used;
}

/// The normal textures that parts use.
std::set<int> normal_textures_of(const layers::Scene& scene) {
  std::set<int> used;
  for (const layers::Part& part : scene.parts)
    if (part.material >= 0 && layers::has_normal_map(scene.materials[part.material], scene.meshes[part.mesh]))
      used.insert(scene.materials[part.material].normal_texture);
  return used;
}

/// For every place, in any order: draw(its index in work.places, renderer of the thread, triangles, first texel).
template <int kCount, typename Draw>
RenderCounters draw_chunks(const DrawList& list, const ChunkWork& work, const RenderOptions& options,
                           LinearImage* linear, const Draw& draw) {
  const std::vector<int>& places = work.places;
  const int columns = work.bins.chunks.x;
  tbb::enumerable_thread_specific<ChunkRenderer<kCount>> renderers(
      [&] { return ChunkRenderer<kCount>(list, options, linear); });
  const JobOrder order(places.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, places.size()), [&](const auto& range) {
    ChunkRenderer<kCount>& renderer = renderers.local();
    for (std::size_t job = range.begin(); job != range.end(); ++job) {
      const std::size_t i = order[job];
      const layers::ivec2 origin(places[i] % columns * kChunkSize, places[i] / columns * kChunkSize);
      draw(i, renderer, work.bins.of(places[i]), origin);
    }
  });
  RenderCounters counters;
  for (const ChunkRenderer<kCount>& renderer : renderers) counters += renderer.counters();
  counters.polygons_in = list.polygons_in;
  counters.polygons_drawn = static_cast<std::int64_t>(list.triangles.size());
  return counters;
}

/// The same with the samples that the options ask for.
template <typename Draw>
RenderCounters draw_chunks(const DrawList& list, const ChunkWork& work, const RenderOptions& options,
                           LinearImage* linear, const Draw& draw) {
  return with_samples(options.samples, [&](auto count) {
    return draw_chunks<decltype(count)::value>(list, work, options, linear, draw);
  });
}

}  // namespace

ChunkWork set_up_chunks(const PreparedScene& prepared, const layers::SceneFrame& frame,
                        std::span<const int> parts, layers::ivec2 display_px,
                        const layers::SpritePlacement& placement, const RenderOptions& options,
                        const ShadeInputs& inputs, DrawList& list) {
  check_options(placement, options);
  build_draw_list(prepared, frame, parts, display_px, placement, options, inputs, list);
  ChunkWork work{bin_triangles(list.triangles, list.size_px), {}};
  for (int c = 0; c < work.bins.count(); ++c)
    if (!work.bins.of(c).empty()) work.places.push_back(c);
  return work;
}

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

PreparedScene::PreparedScene(const layers::Scene& scene, const RenderOptions& options)
    : impl_(std::make_shared<Impl>()) {
  impl_->scene = &scene;
  impl_->boxes = layers::mesh_boxes(scene);
  if (!layers::is_built(layers::Effect::Texture) || scene.textures.empty()) return;
  impl_->pyramids.resize(scene.textures.size());
  const bool filtered = layers::is_built(layers::Effect::MipFilter) && options.mipmaps &&
                        options.filter == TextureFilter::Trilinear;
  const std::map<int, bool> used = textures_of(scene, filtered);
  const std::vector<std::pair<int, bool>> list(used.begin(), used.end());
  tbb::parallel_for(std::size_t{0}, list.size(), [&](std::size_t i) {
    impl_->pyramids[list[i].first] = build_pyramid(scene.textures[list[i].first], list[i].second);
  });
  if constexpr (!layers::is_built(layers::Effect::NormalMap)) return;
  if (options.shading != Shading::Phong) return;
  const std::set<int> normals = normal_textures_of(scene);
  if (!normals.empty()) impl_->normals.resize(scene.textures.size());
  for (const int texture : normals)
    impl_->normals[texture] = build_normal_pyramid(scene.textures[texture], filtered);
}

PreparedScene::~PreparedScene() = default;
PreparedScene::PreparedScene(PreparedScene&&) noexcept = default;
PreparedScene& PreparedScene::operator=(PreparedScene&&) noexcept = default;

const layers::Scene& PreparedScene::scene() const { return *impl_->scene; }

std::int64_t PreparedScene::texture_bytes() const {
  std::int64_t sum = 0;
  for (const Pyramid& pyramid : impl_->pyramids) sum += pyramid.bytes();
  for (const Pyramid& pyramid : impl_->normals) sum += pyramid.bytes();
  return sum;
}

RenderResult render(const PreparedScene& prepared, const layers::SceneFrame& frame,
                    std::span<const int> parts, layers::ivec2 display_px,
                    const layers::SpritePlacement& placement, const RenderOptions& options,
                    const ShadeInputs& inputs) {
  DrawList list;
  const ChunkWork work = set_up_chunks(prepared, frame, parts, display_px, placement, options, inputs, list);
  std::vector<Chunk> chunks(work.places.size());
  RenderResult result;
  result.counters = draw_chunks(list, work, options, nullptr,
                                [&](std::size_t i, auto& renderer, auto triangles, layers::ivec2 origin) {
                                  chunks[i] = renderer.draw(triangles, origin);
                                });
  result.sprite = Sprite::assemble(list.size_px, work.places, chunks);
  result.counters.chunks_rendered = result.sprite.stored_chunks();
  result.counters.chunks_clear = result.sprite.clear_chunks();
  return result;
}

RenderedChunks render_chunks(const PreparedScene& prepared, const layers::SceneFrame& frame,
                             std::span<const int> parts, layers::ivec2 display_px,
                             const layers::SpritePlacement& placement, std::span<const int> places,
                             const RenderOptions& options, const ShadeInputs& inputs) {
  DrawList list;
  ChunkWork work = set_up_chunks(prepared, frame, parts, display_px, placement, options, inputs, list);
  work.places.clear();
  std::vector<std::size_t> index;  // of each place that is worked on
  for (std::size_t i = 0; i < places.size(); ++i) {
    TALISMAN_CHECK(places[i] >= 0 && places[i] < work.bins.count());
    if (work.bins.of(places[i]).empty()) continue;
    work.places.push_back(places[i]);
    index.push_back(i);
  }
  RenderedChunks result{{places.begin(), places.end()}, std::vector<Chunk>(places.size()), {}};
  result.counters = draw_chunks(list, work, options, nullptr,
                                [&](std::size_t i, auto& renderer, auto triangles, layers::ivec2 origin) {
                                  result.chunks[index[i]] = renderer.draw(triangles, origin);
                                });
  for (const Chunk& chunk : result.chunks)
    ++(is_clear_chunk(chunk) ? result.counters.chunks_clear : result.counters.chunks_rendered);
  return result;
}

LinearImage render_linear(const PreparedScene& prepared, const layers::SceneFrame& frame,
                          std::span<const int> parts, layers::ivec2 display_px,
                          const layers::SpritePlacement& placement, const RenderOptions& options,
                          const ShadeInputs& inputs) {
  DrawList list;
  const ChunkWork work = set_up_chunks(prepared, frame, parts, display_px, placement, options, inputs, list);
  LinearImage image;
  image.size_px = list.size_px;
  image.texels.resize(static_cast<std::size_t>(list.size_px.x) * list.size_px.y);
  image.counters = draw_chunks(list, work, options, &image,
                               [](std::size_t, auto& renderer, auto triangles, layers::ivec2 origin) {
                                 renderer.draw(triangles, origin);
                               });
  image.counters.chunks_rendered = static_cast<std::int64_t>(work.places.size());
  image.counters.chunks_clear = work.bins.count() - image.counters.chunks_rendered;
  return image;
}

DepthRenderResult render_with_depth(const PreparedScene& prepared, const layers::SceneFrame& frame,
                                    std::span<const int> parts, std::span<const std::uint32_t> numbers,
                                    layers::ivec2 display_px, const RenderOptions& options,
                                    const ShadeInputs& inputs) {
  TALISMAN_CHECK_EQ(parts.size(), numbers.size());
  layers::SpritePlacement whole_display;
  whole_display.size_px = display_px;
  DrawList list;
  const ChunkWork work =
      set_up_chunks(prepared, frame, parts, display_px, whole_display, options, inputs, list);
  TALISMAN_CHECK(list.triangles.empty() || list.batches.size() == parts.size());
  std::vector<Chunk> chunks(work.places.size());
  std::vector<DepthChunk> depths(work.places.size());
  DepthRenderResult result{PlanBuffer(display_px), {}};
  result.counters = draw_chunks(list, work, options, nullptr,
                                [&](std::size_t i, auto& renderer, auto triangles, layers::ivec2 origin) {
                                  DepthChunk& depth = depths[i];
                                  depth.clear();
                                  chunks[i] = renderer.draw(triangles, origin, &depth);
                                  for (std::uint32_t& part : depth.part)
                                    if (part < numbers.size()) part = numbers[part];
                                });
  for (std::size_t i = 0; i < chunks.size(); ++i)
    if (!is_clear_chunk(chunks[i])) {
      result.buffer.put(work.places[i], chunks[i], depths[i]);
      ++result.counters.chunks_rendered;
    }
  result.counters.chunks_clear = work.bins.count() - result.counters.chunks_rendered;
  return result;
}

}  // namespace talisman::chunker
