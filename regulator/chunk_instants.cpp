// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "layers/check.h"
#include "layers/state.h"
#include "regulator/box_places.h"
#include "regulator/chunk_refresh.h"

namespace talisman::regulator {

using layers::Affine2;
using layers::dvec2;
using layers::dvec4;

namespace {

/// From clip space to pixels, homogeneous.
PlaceMap screen_from_clip_map(layers::ivec2 display_px) {
  const dvec2 half = 0.5 * dvec2(display_px);
  PlaceMap map(0.0);
  map[0].x = half.x;
  map[1].y = -half.y;
  map[3] = {half.x, half.y, 1};
  return map;
}

layers::ivec2 chunk_count(const layers::SpritePlacement& placement) {
  return (placement.size_px + (kRefreshChunk - 1)) / kRefreshChunk;
}

}  // namespace

std::string_view name(Refresh refresh) { return refresh == Refresh::Chunks ? "chunks" : "sprite"; }

ContentView content_view(const layers::LayerState& state) {
  ContentView view;
  view.near_m = state.camera.near_m;
  const PlaceMap screen_from_world = screen_from_clip_map(state.view.display_px) *
                                     layers::clip_from_world(state.camera, state.view.display_px);
  view.screen_from_part.reserve(state.world_from_part.size());
  for (const layers::dmat4& world_from_part : state.world_from_part)
    view.screen_from_part.push_back(screen_from_world * world_from_part);
  return view;
}

ChunkInstant chunk_instant(const LayerContent& content, const ContentView& seen,
                           const layers::SpritePlacement& placement, const Affine2& carried, int frame) {
  ChunkInstant instant{frame, carried, box_corners(content, seen), {}};
  const std::optional<Affine2> back = inverse(carried), texel = inverse(placement.screen_from_sprite);
  TALISMAN_CHECK(back && texel);
  for (layers::dvec3& corner : instant.corners) corner = mapped(*back, corner);
  instant.reach.reserve(content.boxes.size());
  for (std::size_t box = 0; box < content.boxes.size(); ++box) {
    const BoxReach reach =
        box_reach(corners_of(instant.corners, box), *texel, dvec2(placement.size_px), 1, seen.near_m);
    instant.reach.push_back(
        reach.sight == BoxSight::Outside ? ChunkRect{} : chunks_in(reach.bounds, chunk_count(placement)));
  }
  return instant;
}

SpriteChunks whole_sprite(const layers::SpritePlacement& placement, ChunkInstant first) {
  SpriteChunks chunks;
  chunks.count = chunk_count(placement);
  chunks.of_chunk.assign(static_cast<std::size_t>(chunks.count.x) * chunks.count.y, 0);
  chunks.instants.push_back(std::make_shared<const ChunkInstant>(std::move(first)));
  chunks.drawn.push_back(0);
  return chunks;
}

void set_chunks(std::span<const int> places, ChunkInstant instant, SpriteChunks& chunks) {
  for (const int place : places) chunks.of_chunk[place] = static_cast<std::uint8_t>(chunks.instants.size());
  chunks.instants.push_back(std::make_shared<const ChunkInstant>(std::move(instant)));
  chunks.drawn.push_back(0);
  std::vector<char> used(chunks.instants.size(), 0);
  used[0] = 1;
  for (const std::uint8_t k : chunks.of_chunk) used[k] = 1;
  std::vector<std::uint8_t> now(used.size(), 0);
  std::size_t kept = 0;
  for (std::size_t k = 0; k < used.size(); ++k) {
    if (!used[k]) continue;
    now[k] = static_cast<std::uint8_t>(kept);
    chunks.drawn[kept] = chunks.drawn[k];
    chunks.instants[kept++] = std::move(chunks.instants[k]);
  }
  chunks.instants.resize(kept);
  chunks.drawn.resize(kept);
  for (std::uint8_t& k : chunks.of_chunk) k = now[k];
}

}  // namespace talisman::regulator
