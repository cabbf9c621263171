// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The decision side of one layer at one frame, as `step` and the search for the best instant to draw
/// (draw_instant.h) share it: captured states, placement, cost, assessment. No pixel is touched.

#include <vector>

#include "regulator/shadow_maps.h"
#include "sequences/pipeline/latency/known_scene.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// Does the policy draw sprites as of instants other than now?
bool looks_ahead(const Pipeline& pipeline);

/// Does the policy draw layers one by one, which then need an order?
bool draws_sprites(const Pipeline& pipeline);

/// The family of warps, and its norm, that carries the layer's sprite.
warp::Curve curve_of(const Pipeline& pipeline, const layers::Layer& layer);

/// Makes `frame` the frame that is planned, under this pipeline: forgets what is past, what was only
/// expected, and what was judged under other options.
void begin_frame(const Pipeline& pipeline, PipelineState& state, int frame);

/// The states of all layers at `frame`, by layer id; captured once and kept in `state` (a frame ahead that
/// was looked at is not captured again when it comes). Aggregates (sequences/pipeline/aggregates.h) are
/// captured if they exist in the frame that was ordered last. The reference holds until aggregates are made.
const std::vector<layers::LayerState>& captured_states(const Pipeline& pipeline, PipelineState& state,
                                                       int frame);

/// The state of one layer into `states`; that of a shade is made of its base's, which comes first.
void capture_layer(const LayerTable& table, const layers::Layer& layer, const layers::FrameCapture& capture,
                   std::vector<layers::LayerState>& states);

/// The state of one layer where a motion is asked for: captured also where the layer is not seen.
const layers::LayerState& captured_motion(const Pipeline& pipeline, PipelineState& state, int layer,
                                          int frame);

/// Where the layer's sprite lies if it is rendered at the instant of `frame`. Extents grow only where the
/// sprite is to be moved later. Computed once for each instant.
const layers::SpritePlacement& captured_placement(const Pipeline& pipeline, PipelineState& state, int layer,
                                                  int frame);

/// The same at a resolution, relative to what the layer's author asks for; not kept.
layers::SpritePlacement placement_at_resolution(const Pipeline& pipeline, PipelineState& state, int layer,
                                                int frame, double resolution);

/// Step 6 of [LS97 6], policy Budget: chooses the resolution of every layer in view and of the shadow maps, and
/// computes placement and cost again where it is not 1. `options`: the budget of this frame.
void fit_resolutions(const Pipeline& pipeline, PipelineState& state, int frame,
                     const regulator::RegulatorOptions& options,
                     std::vector<regulator::LayerAssessment>& assessments,
                     std::vector<regulator::MapAssessment>& maps);

/// The same without growth: as the policy `reference` draws it.
layers::SpritePlacement placement_without_growth(const Pipeline& pipeline, const LayerTable& layers,
                                                 const layers::LayerState& now);

/// Where the picture lies that a mirror shows in such a sprite: an upright rectangle of the display around it, as
/// dense as the sprite is.
layers::SpritePlacement mirrored_placement(const layers::SpritePlacement& sprite, int max_sprite_px);

/// What drawing the layer into such a sprite costs; pixels and chunks count those of mirrored pictures, too.
regulator::LayerCost cost_of(const Pipeline& pipeline, const LayerTable& layers, int layer,
                             const layers::SpritePlacement& placement);

/// What showing at `now` the sprite as rendered at `then` with `placement` is worth. The layer is in view.
regulator::LayerAssessment assess_sprite(const Pipeline& pipeline, const LayerTable& layers,
                                         const layers::LayerState& then,
                                         const layers::SpritePlacement& placement,
                                         const layers::LayerState& now, int frames_since_render);

/// Counts for how many frames each layer has been at rest, if the regulator asks for it. Of layers that were not
/// looked at in the frame before, as of an aggregate that is made, the count begins.
void note_rest(const Pipeline& pipeline, PipelineState& state, int frame);

/// What the regulator knows about `layer` at `frame`.
regulator::LayerAssessment assess_layer(const Pipeline& pipeline, PipelineState& state, int layer, int frame);

}  // namespace talisman::sequences
