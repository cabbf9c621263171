// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Chunks of a sprite that are drawn alone, because only they are too far off (regulator/chunk_refresh.h): what of it
/// is decided, and what is remembered. `--refresh chunks`.
///
/// A sprite is judged by its chunks once it does not serve as a whole, and from the first chunk that was drawn alone
/// until all of it is drawn again. All of it is drawn where
///
///   another fiducial speaks (sampling, visibility, turned sides), or the author asks for a render
///   light, shadows, or a picture on it have changed, as far as an 8-bit picture shows; or they are not followed
///   it mirrors, is blurred by motion, may not be drawn in every frame, shares its sprite with others, is a term of
///   shading, looks up an old map, or deforms
///   it outgrows its extents, the warp folds or is perspective
///   more than 60 % of its chunks are over the bound, or they are of too many instants, or drawing the whole costs less
///   a frame (regulator/refresh_ledger.h)
///
/// and in runs with fades, compression, shared sprites, old poses, or accumulated pictures, where nothing is judged by
/// chunks. A run without the option keeps nothing, and asks nothing.
///
/// What chunks cost: polygons, as many as the layer has vertices, which all are transformed, and those that fall
/// into the chunks, but no more than all; texels and chunks of those drawn.

#include <vector>

#include "sequences/pipeline/pipeline.h"
#include "sequences/pipeline/refresh/refresh_report.h"

namespace talisman::sequences {

/// Triangles of a group that is judged as one. Fewer bound more tightly, and cost time in proportion to the groups.
inline constexpr int kChunkContentTriangles = 64;

bool refreshes_chunks(const Pipeline& pipeline);

/// By layer id. Cost: once per run, O(triangles · log triangles).
std::vector<regulator::LayerContent> layer_contents(const layers::Scene& scene, const LayerTable& layers);

/// Judges the chunks where the sprite as a whole does not serve, or is mixed; then `assessment` says so.
void assess_chunks(const Pipeline& pipeline, PipelineState& state, int layer, int frame,
                   regulator::LayerAssessment& assessment);

/// Notes that chunks are of this frame.
void remember_refresh(const Pipeline& pipeline, PipelineState& state, int frame,
                      const regulator::LayerAssessment& assessment);

RefreshReport refreshed(const regulator::FramePlan& plan);

/// The places of the chunks of an instant, ascending.
std::vector<int> places_of(const regulator::SpriteChunks& chunks, std::size_t instant);
/// Where their texels lie on the display of that instant.
layers::SpritePlacement placement_of(const LayerMemory& memory, std::size_t instant);

}  // namespace talisman::sequences
