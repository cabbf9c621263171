// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/step.h"

#include "chunker/late_chunks.h"
#include "layers/animation.h"
#include "layers/built_effects.h"
#include "layers/check.h"
#include "layers/effects.h"
#include "layers/moving_picture.h"
#include "sequences/pipeline/accumulate.h"
#include "sequences/pipeline/aggregates.h"
#include "sequences/pipeline/blended_sprites.h"
#include "sequences/pipeline/cross_fading.h"
#include "sequences/pipeline/culling/culling.h"
#include "sequences/pipeline/depth_complexity.h"
#include "sequences/pipeline/direct_picture.h"
#include "sequences/pipeline/draw_instant.h"
#include "sequences/pipeline/extended_composite.h"
#include "sequences/pipeline/instants.h"
#include "sequences/pipeline/latency/last_warp.h"
#include "sequences/pipeline/latency/late_camera.h"
#include "sequences/pipeline/layer_planning.h"
#include "sequences/pipeline/light_beside.h"
#include "sequences/pipeline/lod/levels_now.h"
#include "sequences/pipeline/predictive/plan_buffers.h"
#include "sequences/pipeline/refresh/refresh.h"
#include "sequences/pipeline/regrouping/regroup.h"
#include "sequences/pipeline/shade_passes.h"
#include "sequences/pipeline/shadow_map_planning.h"
#include "sequences/pipeline/stopwatch.h"

namespace talisman::sequences {

namespace {

using layers::Layer;
using layers::LayerState;
using layers::SceneFrame;
using layers::SpritePlacement;
using regulator::Action;
using regulator::LayerAssessment;

/// What the policy `reference` would render for this frame: every layer in view, without growth, and the shadow
/// maps that changed since the last frame, whatever this run does. Between two beats, cycles are merged as on the
/// last one.
regulator::LayerCost reference_cost(const Pipeline& pipeline, PipelineState& state, const FrameReport& report,
                                    const std::vector<ShadowMapCost>& costs) {
  const std::vector<LayerState>& states = captured_states(pipeline, state, report.frame);
  const std::vector<ShadowMapKey>& keys = state.captured.at(report.frame).shadow_maps;
  regulator::LayerCost sum;
  ShadeCounters passes;
  for (const Layer& layer : report.layers) {
    if (!report.order.has_own_sprite(layer.id, layer.is_aggregate()) || !states[layer.id].touches_display)
      continue;
    const regulator::LayerCost cost =
        cost_of(pipeline, report.layers, layer.id,
                placement_without_growth(pipeline, report.layers, states[layer.id]));
    sum.polygons += cost.polygons;
    sum.pixels += cost.pixels;
    state.reference_shades.add_render(pipeline.scene, report.layers.set(), layer, keys, costs, passes);
  }
  sum.polygons += passes.shadow_polygons;
  sum.pixels += passes.shadow_pixels;
  return sum;
}

/// The order in which sprites are composited; may merge layers into aggregates.
FrameOrder order_of(const Pipeline& pipeline, PipelineState& state, int frame) {
  if (state.beat) return standing_order(state.beat->order);
  FrameOrder order = order_layers(pipeline, state, frame);
  if (regulator::keeps_beat(pipeline.settings.regulator)) state.beat = BeatMemory{frame, order};
  return order;
}

/// The time whose fades are shown.
double time_of_fades(const Pipeline& pipeline, const PipelineState& state, int frame) {
  return time_of(pipeline, state.beat ? state.beat->frame : frame);
}

/// A layer that another one draws in this frame, or an aggregate that does not exist in it, is out of view.
LayerAssessment assess(const Pipeline& pipeline, PipelineState& state, const Layer& layer,
                       const FrameReport& report) {
  if (report.order.has_own_sprite(layer.id, layer.is_aggregate()))
    return assess_layer(pipeline, state, layer.id, report.frame);
  LayerAssessment not_shown;
  not_shown.layer = layer.id;
  not_shown.preferences = layer.preferences;
  not_shown.has_sprite = state.memory[layer.id].then.has_value();
  return not_shown;
}

/// How far the choice of this frame was from the best one, if the policy makes one.
std::optional<regulator::BudgetGap> gap_of(const FrameReport& report, const ShadowMapsNow& maps,
                                           const regulator::RegulatorOptions& options) {
  if (options.policy != regulator::Policy::Budget) return std::nullopt;
  constexpr std::size_t kMostStates = 20'000;  // some 20 ms, then the frame counts as not proved
  return regulator::budget_gap_of_frame(report.assessments, options, maps.maps, kMostStates);
}

/// Chooses the instant as of which the layer is drawn, and completes the decision by how that sprite is shown
/// now. Returns the instant.
int decide_instant(const Pipeline& pipeline, PipelineState& state, int frame,
                   regulator::LayerDecision& decision, LookaheadReport& counts) {
  const regulator::FrameRun run = choose_draw_instant(pipeline, state, decision.layer, frame, &counts);
  decision.reason += "; rendered as of frame " + std::to_string(run.instant) + ", serves " +
                     std::to_string(run.first) + "-" + std::to_string(run.last);
  if (predicts(pipeline)) decision.reason += " if the motion goes on";
  if (looks_no_farther(pipeline, frame, run)) decision.reason += " or longer";
  if (run.instant == frame) return frame;
  const LayerAssessment shown =
      assess_sprite(pipeline, state.layers, captured_states(pipeline, state, run.instant)[decision.layer],
                    captured_placement(pipeline, state, decision.layer, run.instant),
                    captured_states(pipeline, state, frame)[decision.layer], 0);
  decision.shown_warp = shown.fitted.warp;
  decision.shown_geometric_px = shown.fiducials.geometric.px;
  decision.shown_color = shown.fiducials.photometric.multiplier;
  return run.instant;
}

/// Frames of moving pictures that a sprite shows and the texture memory does not hold yet: each moving picture has
/// room for one.
void upload_pictures(const Pipeline& pipeline, PipelineState& state, const LayerState& drawn,
                     FrameReport& report) {
  for (const layers::ShownPicture& shown : drawn.pictures) {
    if (state.uploaded[shown.picture] == shown.frame) continue;
    state.uploaded[shown.picture] = shown.frame;
    *report.upload_bytes += layers::bytes_of(pipeline.scene, shown);
  }
}

/// Notes every layer that is to be rendered: its state and its placement, drawn or not.
void remember_renders(const Pipeline& pipeline, PipelineState& state, const ShadowMapsNow& maps,
                      FrameReport& report) {
  if (layers::is_built(layers::Effect::MovingPicture) && !pipeline.scene.moving_pictures.empty()) {
    state.uploaded.resize(pipeline.scene.moving_pictures.size(), -1);
    report.upload_bytes = 0;
  }
  if (looks_ahead(pipeline)) report.lookahead.emplace();
  if (refreshes_chunks(pipeline)) report.refresh = refreshed(report.plan);
  for (regulator::LayerDecision& decision : report.plan.decisions) {
    if (decision.action == Action::Drop) continue;
    LayerMemory& memory = state.memory[decision.layer];
    if (decision.action == Action::Rerender) {
      const int instant = looks_ahead(pipeline) && !decision.settled
                              ? decide_instant(pipeline, state, report.frame, decision, *report.lookahead)
                              : report.frame;
      begin_fade(pipeline, state, decision.layer, report.frame);
      place_at_level(pipeline, state, instant, decision);
      // The placement first: it depends on how long the old sprite lasted.
      memory.placement = captured_placement(pipeline, state, decision.layer, instant);
      memory.then = captured_states(pipeline, state, instant)[decision.layer];
      if (report.upload_bytes) upload_pictures(pipeline, state, *memory.then, report);
      memory.frame_rendered = report.frame;
      memory.depicts_frame = instant;
      memory.drawn = false;
      memory.chunks.reset();
      memory.ledger = regulator::after_whole(memory.ledger, report.frame);
      memory.resolution = decision.resolution;
      memory.level = decision.level;
      memory.predicted = predicts(pipeline);
      memory.frames_short_of_area = 0;
      decision.cost = cost_of(pipeline, state.layers, decision.layer, memory.placement);
      lower_cost(pipeline, state.layers[decision.layer], memory, decision.cost);
      look_up_shadow_maps(pipeline, state, maps, decision.layer, instant, report);
    }
    if (decision.action == Action::Refresh)
      remember_refresh(pipeline, state, report.frame, report.assessments[decision.layer]);
    memory.frames_short_of_area = decision.short_of_area ? memory.frames_short_of_area + 1 : 0;
    decision.depicts_frame = memory.depicts_frame;
    memory.frame_shown = report.frame;
  }
  finish_shadow_maps(state, report);
}

/// Are there buffers with depth instead of sprites?
bool joins_buffers(const Pipeline& pipeline) {
  return layers::is_built(layers::Effect::Predictive) &&
         pipeline.settings.regulator.policy == regulator::Policy::Predictive;
}

/// The options of the regulator for this frame: what is measured is filled in.
regulator::RegulatorOptions options_now(const Pipeline& pipeline, const PipelineState& state) {
  regulator::RegulatorOptions options = pipeline.settings.regulator;
  if (options.budget.depth_complexity == 0) options.budget.depth_complexity = state.depth.complexity();
  return options;
}

/// The sprites of this frame, back to front, each with the map that puts it in its place.
std::vector<ShownSprite> sprites_shown(const Pipeline& pipeline, const PipelineState& state,
                                       const Fades& fades, const FrameReport& report) {
  const double fades_s = time_of_fades(pipeline, state, report.frame);
  std::vector<ShownSprite> shown;
  shown.reserve(report.order.back_to_front.size());
  for (const int layer : report.order.back_to_front) {
    const regulator::LayerDecision& decision = report.plan.decisions[layer];
    const LayerMemory& memory = state.memory[layer];
    if (decision.action == Action::Drop || memory.placement.empty()) continue;
    SpriteMultipliers multipliers = multipliers_at(report.layers[layer], fades_s);
    const auto fade = fades.out.find(layer);
    const bool fades_in = fade != fades.out.end();
    if (layers::is_built(layers::Effect::ColorWarp) && !fades_in)
      multipliers.color *= layers::vec3(decision.shown_color);
    shown.push_back({layer, decision.shown_warp.now_from_then * to_mat3(memory.placement.screen_from_sprite),
                     memory.placement.size_px, report.frame - memory.frame_rendered, multipliers});
    shown.back().steps = decision.action == Action::Rerender || decision.action == Action::Refresh ||
                         fades_in || fades.ended.contains(layer);
    if (fades_in) shown.back().old = fade->second;
    if (report.layers[layer].kind == layers::LayerKind::Light)
      shown.back().beside_base_px =
          light_beside_px(state, report, report.layers[layer],
                          state.captured.at(report.frame).states[report.layers[layer].base]);
  }
  return shown;
}

/// How the run compresses its sprites, or null.
const chunker::CompressionOptions* compression_of(const Pipeline& pipeline) {
  const bool called = layers::is_built(layers::Effect::SpriteCompression) && pipeline.settings.compression;
  return called ? &*pipeline.settings.compression : nullptr;
}

/// Does a frame look only at the chunks that it shows?
bool draws_chunks_late(const Pipeline& pipeline) {
  return pipeline.settings.late_chunks && compression_of(pipeline) == nullptr &&
         pipeline.settings.regulator.blend_frames == 0;
}

/// Draws what is remembered of a layer: the picture of its own instant.
chunker::RenderResult draw_remembered(const Pipeline& pipeline, PipelineState& state, Instants& instants,
                                      const chunker::PreparedScene& prepared, int layer,
                                      const LayerMemory& memory) {
  const int instant = memory.depicts_frame;
  const SceneFrame& frame = instants.at(memory.predicted ? memory.frame_rendered : instant, instant);
  std::vector<HeldMap> held;
  for (const ShadowMapInstant& map : memory.maps)
    held.push_back({map.light, &instants.at(map.known, map.depicts_frame), map.resolution});
  const auto draw = draws_chunks_late(pipeline) ? &draw_layer_late : &draw_layer;
  const Layer drawn = drawn_layer(pipeline, state.layers[layer], memory);
  return draw({pipeline, state.layers, state.shadow_maps, prepared, frame, held}, drawn, memory.placement);
}

/// Draws the chunks that are of other instants than the whole, and that the sprite does not hold yet.
void draw_missing_chunks(const Pipeline& pipeline, PipelineState& state, Instants& instants,
                         const chunker::PreparedScene& prepared, int layer, FrameReport& report) {
  LayerMemory& memory = state.memory[layer];
  if (!memory.chunks) return;
  for (std::size_t k = 1; k < memory.chunks->instants.size(); ++k) {
    if (memory.chunks->drawn[k]) continue;
    const int instant = memory.chunks->instants[k]->frame;
    const chunker::RenderedChunks drawn = draw_layer_chunks(
        {pipeline, state.layers, state.shadow_maps, prepared, instants.at(instant, instant), {}},
        state.layers[layer], placement_of(memory, k), places_of(*memory.chunks, k));
    state.sprites.replace(layer, drawn.places, drawn.chunks);
    memory.chunks->drawn[k] = 1;
    if (instant != report.frame) {
      ++report.late_renders;
      continue;
    }
    report.render += drawn.counters;
    report.render_by_layer[layer] += drawn.counters;
  }
}

/// Draws the sprites that fade out in this frame and were planned in frames that were not drawn.
void draw_missing_fades(const Pipeline& pipeline, PipelineState& state, Instants& instants,
                        const chunker::PreparedScene& prepared, FrameReport& report) {
  for (auto& [layer, fading] : state.fading) {
    if (fading.old.drawn) continue;
    state.fading_sprites.put(layer,
                             draw_remembered(pipeline, state, instants, prepared, layer, fading.old).sprite);
    fading.old.drawn = true;
    ++report.late_renders;
  }
}

/// Draws the sprites that this frame shows and the store does not hold yet.
void draw_missing_sprites(const Pipeline& pipeline, PipelineState& state, const SceneFrame& now,
                          const chunker::PreparedScene& prepared, FrameReport& report) {
  Instants instants(pipeline, report.frame, now);
  for (const ShownSprite& sprite : report.shown) {
    LayerMemory& memory = state.memory[sprite.layer];
    if (memory.drawn) {
      draw_missing_chunks(pipeline, state, instants, prepared, sprite.layer, report);
      continue;
    }
    chunker::RenderResult result = draw_remembered(pipeline, state, instants, prepared, sprite.layer, memory);
    const bool is_late = memory.frame_rendered != report.frame;
    if (const chunker::CompressionOptions* compression = compression_of(pipeline))
      keep_compressed(sprite.layer, result.sprite, *compression, state.compressed, state.sprites,
                      is_late ? nullptr : &*report.compression);
    else
      state.sprites.put(sprite.layer, std::move(result.sprite));
    memory.drawn = true;
    if (is_late) {
      ++report.late_renders;  // its counters belong to the frame for which it was planned
    } else {
      report.render += result.counters;
      report.render_by_layer[sprite.layer] = result.counters;
    }
    draw_missing_chunks(pipeline, state, instants, prepared, sprite.layer, report);
  }
  draw_missing_fades(pipeline, state, instants, prepared, report);
}

/// The stack of a frame that needs no registers.
std::vector<chunker::PlacedSprite> placed_sprites(const FrameReport& report,
                                                  const chunker::SpriteStore& sprites,
                                                  const BlendedSprites& blended) {
  std::vector<chunker::PlacedSprite> placed;
  placed.reserve(report.shown.size());
  for (const ShownSprite& sprite : report.shown) placed.push_back(placed_sprite(sprite, sprites, blended));
  return placed;
}

bool needs_registers(const FrameReport& report) {
  return !report.order.resolved.empty() || any_registers(report.layers);
}

/// Draws the chunks that this frame shows and none before did. Those of a sprite that was rendered for this frame
/// are counted with it.
void draw_shown_chunks(const Pipeline& pipeline, const PipelineState& state, const BlendedSprites& blended,
                       FrameReport& report) {
  if (!draws_chunks_late(pipeline)) return;
  const std::vector<chunker::PlacedSprite> stack = placed_sprites(report, state.sprites, blended);
  const layers::ivec2 display_px = pipeline.settings.view.display_px;
  if (needs_registers(report)) {  // what hides what is for its expressions to say
    for (const chunker::PlacedSprite& sprite : stack) chunker::draw_late_chunks({&sprite, 1}, display_px);
  } else {
    chunker::draw_late_chunks(stack, display_px);
  }
  for (const ShownSprite& shown : report.shown) {
    chunker::LateChunks* late = state.sprites.find(shown.layer)->late_chunks();
    if (late == nullptr) continue;
    const chunker::RenderCounters counters = late->rest();
    if (state.memory[shown.layer].frame_rendered != report.frame) {
      report.late_chunks += counters;
      continue;
    }
    report.render += counters;
    report.render_by_layer[shown.layer] += counters;
  }
}

chunker::CompositeResult composite_shown(const Pipeline& pipeline, const FrameReport& report,
                                         const chunker::SpriteStore& sprites, const BlendedSprites& blended) {
  const layers::ivec2 display_px = pipeline.settings.view.display_px;
  if (needs_registers(report)) {
    std::vector<LayerSprite> placed;
    for (const ShownSprite& sprite : report.shown)
      placed.push_back({sprite.layer, placed_sprite(sprite, sprites, blended),
                        report.layers[sprite.layer].base, use_of(report.layers[sprite.layer])});
    return composite_extended(placed, report.order, display_px, pipeline.scene.background);
  }
  return chunker::composite(placed_sprites(report, sprites, blended), display_px, pipeline.scene.background);
}

chunker::CacheCounters chunks_read(const Pipeline& pipeline, const FrameReport& report,
                                   const CompressedSprites& compressed) {
  std::vector<chunker::PlacedCompressed> placed;
  for (const ShownSprite& sprite : report.shown)
    placed.push_back({&compressed.at(sprite.layer), sprite.screen_from_sprite});
  return model_chunk_reads(placed, pipeline.settings.view.display_px);
}

/// Of what the frame shows. What else the store holds depends on which frames before were drawn.
std::int64_t bytes_shown(const PipelineState& state, const FrameReport& report) {
  std::int64_t sum = 0;
  for (const ShownSprite& shown : report.shown) {
    const auto compressed = state.compressed.find(shown.layer);
    const chunker::Sprite* sprite = state.sprites.find(shown.layer);
    sum += compressed != state.compressed.end() ? compressed->second.bytes() : sprite ? sprite->bytes() : 0;
    if (shown.old) sum += state.fading_sprites.find(shown.layer)->bytes();
  }
  return sum;
}

void draw(const Pipeline& pipeline, PipelineState& state, const SceneFrame& now,
          const chunker::PreparedScene& prepared, FrameReport& report) {
  chunker::CompositeResult result;
  const Stopwatch render_watch;
  if (pipeline.settings.regulator.policy == regulator::Policy::Direct) {
    const SeenParts* const seen = seen_at(pipeline, state, report.frame);
    DirectPicture picture = draw_directly(
        {pipeline, pipeline.authored, state.shadow_maps, prepared, now, {}, seen ? &seen->part : nullptr},
        report.frame, report.late ? report.late->whole_picture : layers::dmat3(1.0));
    result = std::move(picture.composite);
    report.render += picture.render;
    report.times.render_ms = render_watch.ms();
  } else if (joins_buffers(pipeline)) {
    result = draw_predicted({pipeline, pipeline.authored, state.shadow_maps, prepared, now}, state, report);
    report.times.render_ms = render_watch.ms() - report.times.composite_ms;
  } else {
    if (compression_of(pipeline)) report.compression.emplace();
    draw_missing_sprites(pipeline, state, now, prepared, report);
    const BlendedSprites blended = blended_sprites(state, report);
    draw_shown_chunks(pipeline, state, blended, report);
    report.times.render_ms = render_watch.ms();
    const Stopwatch composite_watch;
    result = composite_shown(pipeline, report, state.sprites, blended);
    report.times.composite_ms = composite_watch.ms();
    if (compression_of(pipeline)) report.compression->cache = chunks_read(pipeline, report, state.compressed);
  }
  report.picture = std::move(result.frame);
  report.composite = result.counters;
  report.sprite_bytes = bytes_shown(state, report);
}

/// Why layers that were not even looked at are not shown.
void explain_culling(const Pipeline& pipeline, PipelineState& state, FrameReport& report) {
  const std::vector<char>& culled = state.captured.at(report.frame).culled;
  if (culled.empty()) return;
  const SeenParts& seen = *seen_at(pipeline, state, report.frame);
  for (regulator::LayerDecision& decision : report.plan.decisions)
    if (culled[decision.layer] && decision.action == Action::Drop)
      decision.reason = why_culled(seen, decision.layer);
}

}  // namespace

FrameReport step(const Pipeline& pipeline, PipelineState& state, int frame,
                 const chunker::PreparedScene* prepared) {
  if (pipeline.settings.accumulate > 1)
    return accumulated_step(pipeline, frame, [&](const Pipeline& pictures, int picture) {
      return step(pictures, state, picture, prepared);
    });
  FrameReport report;
  report.frame = frame;
  report.display_px = pipeline.settings.view.display_px;

  // Decide: no pixel is touched up to and including the plan.
  const Stopwatch plan_watch;
  begin_frame(pipeline, state, frame);
  report.order = order_of(pipeline, state, frame);
  note_rest(pipeline, state, frame);
  report.layers = state.layers;
  report.render_by_layer.resize(report.layers.size());
  report.assessments.reserve(report.layers.size());
  for (const Layer& layer : report.layers) {
    report.assessments.push_back(assess(pipeline, state, layer, report));
    report.layers_assessed += report.assessments.back().in_view && report.assessments.back().has_sprite;
  }
  const regulator::RegulatorOptions options = options_now(pipeline, state);
  ShadowMapsNow maps = assess_shadow_maps(pipeline, state, report);
  if (options.policy == regulator::Policy::Budget && solver_of(state, options) == nullptr)
    fit_resolutions(pipeline, state, frame, options, report.assessments, maps.maps);
  assess_levels(pipeline, state, frame, options, report.assessments);
  report.plan = regulator::regulate({frame, state.beat ? state.beat->frame : frame}, report.assessments,
                                    options, maps.maps, solver_of(state, options));
  report.shadow_maps = shadow_map_rows(pipeline, maps, report.plan.maps);
  report.depth_complexity = options.budget.depth_complexity;
  double bookkeeping_ms = plan_watch.ms();
  report.reference = reference_cost(pipeline, state, report, maps.costs);
  if (pipeline.settings.budget_gap) report.budget_gap = gap_of(report, maps, options);
  bookkeeping_ms = plan_watch.ms() - bookkeeping_ms;
  if (measures_depth(pipeline)) measure_depth(pipeline, state, report);
  if (joins_buffers(pipeline))
    plan_predicted(pipeline, state, maps, report);
  else
    remember_renders(pipeline, state, maps, report);
  if (regulator::regroups(options)) regroup(pipeline, state, report);
  note_drawing_time(pipeline, state, report);
  const Fades fades = carry_fades(pipeline, state, report);
  explain_order(report);
  explain_culling(pipeline, state, report);
  report.shown = sprites_shown(pipeline, state, fades, report);
  show_late(pipeline, state, report);
  report.times.plan_ms = plan_watch.ms() - bookkeeping_ms;  // the yardstick is not part of the plan

  // Execute.
  if (prepared) draw(pipeline, state, scene_now(pipeline, state, frame), *prepared, report);
  return report;
}

chunker::Frame draw_direct(const Pipeline& pipeline, int frame, const chunker::PreparedScene& prepared) {
  if (is_late(pipeline)) return draw_direct(in_time(pipeline), frame, prepared);
  if (pipeline.settings.accumulate > 1)
    return accumulated_picture(pipeline, frame, [&](const Pipeline& pictures, int picture) {
      return draw_direct(pictures, picture, prepared);
    });
  ShadowMapStore maps;
  const SceneFrame now = scene_at(pipeline, frame);
  return draw_directly({pipeline, pipeline.authored, maps, prepared, now}, frame).composite.frame;
}

chunker::Frame draw_reference(const Pipeline& pipeline, int frame, const chunker::PreparedScene& prepared) {
  Pipeline reference = pipeline;
  reference.settings.regulator.policy = regulator::Policy::Reference;
  reference.culling = nullptr;
  reference.settings.regulator.lod.by = regulator::LodSelector::None;
  PipelineState fresh(reference);
  return step(reference, fresh, frame, &prepared).picture;
}

}  // namespace talisman::sequences
