// SPDX-License-Identifier: Apache-2.0
#include "sequences/step.h"

#include <chrono>
#include <map>

#include "layers/check.h"
#include "sequences/draw_instant.h"
#include "sequences/layer_planning.h"

namespace talisman::sequences {

namespace {

using layers::Layer;
using layers::LayerState;
using layers::SceneFrame;
using layers::SpritePlacement;
using regulator::Action;
using regulator::LayerAssessment;

class Stopwatch {
 public:
  double ms() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

std::vector<int> order_layers(const Pipeline& pipeline, const std::vector<LayerState>& states) {
  if (states.empty()) return {};
  std::vector<layers::WorldBounds> bounds;
  bounds.reserve(states.size());
  for (const LayerState& state : states) bounds.push_back(layers::bounds_of(state.world_points));
  return layers::back_to_front(layers::dvec3(states.front().camera.world_from_camera[3]),
                               pipeline.layers.layers, bounds);
}

/// What the policy `reference` would render for this frame: every layer in view, without growth.
std::int64_t reference_pixels(const Pipeline& pipeline, const std::vector<LayerState>& states) {
  std::int64_t pixels = 0;
  for (const LayerState& now : states)
    if (now.touches_display)
      pixels +=
          cost_of(pipeline.layers.layers[now.layer], placement_without_growth(pipeline, now).size_px).pixels;
  return pixels;
}

/// How far the greedy choice of this frame was from the best one, if the policy makes one.
std::optional<regulator::BudgetGap> gap_of(const Pipeline& pipeline, const FrameReport& report) {
  const regulator::RegulatorOptions& options = pipeline.settings.regulator;
  if (options.policy != regulator::Policy::Budget) return std::nullopt;
  constexpr std::size_t kMostStates = 20'000;  // some 20 ms, then the frame counts as not proved
  return regulator::budget_gap(regulator::candidates_of(report.assessments, options),
                               regulator::left_after_first_appearances(report.assessments, options),
                               kMostStates);
}

/// Chooses the instant as of which the layer is drawn, and completes the decision by how that sprite is shown
/// now. Returns the instant.
int decide_instant(const Pipeline& pipeline, PipelineState& state, int frame,
                   regulator::LayerDecision& decision) {
  const regulator::FrameRun run = choose_draw_instant(pipeline, state, decision.layer, frame);
  decision.reason += "; rendered as of frame " + std::to_string(run.instant) + ", serves " +
                     std::to_string(run.first) + "-" + std::to_string(run.last);
  if (predicts(pipeline)) decision.reason += " if the motion goes on";
  if (run.instant == frame) return frame;
  const LayerAssessment shown =
      assess_sprite(pipeline, states_at(pipeline, state, run.instant)[decision.layer],
                    placement_at(pipeline, state, decision.layer, run.instant),
                    states_at(pipeline, state, frame)[decision.layer], 0);
  decision.shown_warp = shown.fitted.warp;
  decision.shown_geometric_px = shown.fiducials.geometric.px;
  return run.instant;
}

/// Notes every layer that is to be rendered: its state and its placement, drawn or not.
void remember_renders(const Pipeline& pipeline, PipelineState& state, FrameReport& report) {
  for (regulator::LayerDecision& decision : report.plan.decisions) {
    if (decision.action == Action::Drop) continue;
    LayerMemory& memory = state.memory[decision.layer];
    if (decision.action == Action::Rerender) {
      const int instant =
          looks_ahead(pipeline) ? decide_instant(pipeline, state, report.frame, decision) : report.frame;
      memory = {states_at(pipeline, state, instant)[decision.layer],
                placement_at(pipeline, state, decision.layer, instant),
                report.frame,
                instant,
                false,
                decision.resolution,
                predicts(pipeline),
                0};
      decision.cost = cost_of(pipeline.layers.layers[decision.layer], memory.placement.size_px);
    }
    memory.frames_short_of_area = decision.short_of_area ? memory.frames_short_of_area + 1 : 0;
    decision.depicts_frame = memory.depicts_frame;
  }
}

/// The sprites of this frame, back to front, each with the map that puts it in its place.
std::vector<ShownSprite> sprites_shown(const PipelineState& state, const FrameReport& report,
                                       const std::vector<int>& order) {
  std::vector<ShownSprite> shown;
  shown.reserve(order.size());
  for (const int layer : order) {
    const regulator::LayerDecision& decision = report.plan.decisions[layer];
    const LayerMemory& memory = state.memory[layer];
    if (decision.action == Action::Drop || memory.placement.empty()) continue;
    shown.push_back({layer, decision.shown_warp.now_from_then * to_mat3(memory.placement.screen_from_sprite),
                     memory.placement.size_px, report.frame - memory.frame_rendered});
  }
  return shown;
}

/// Draws the sprites that this frame shows and the store does not hold yet.
void draw_missing_sprites(const Pipeline& pipeline, PipelineState& state, const SceneFrame& now,
                          const chunker::PreparedScene& prepared, FrameReport& report) {
  std::map<std::pair<int, int>, SceneFrame> others;  // instants other than now; by when they were expected
  for (const ShownSprite& sprite : report.shown) {
    LayerMemory& memory = state.memory[sprite.layer];
    if (memory.drawn) continue;
    const int instant = memory.depicts_frame;
    const std::pair key{memory.predicted ? memory.frame_rendered : instant, instant};
    const bool as_of_now = key == std::pair{report.frame, report.frame};
    if (!as_of_now && others.count(key) == 0)
      others.emplace(key, scene_expected(pipeline, key.first, instant));
    chunker::RenderResult result = chunker::render(
        prepared, as_of_now ? now : others.at(key), pipeline.layers.layers[sprite.layer].parts,
        pipeline.settings.view.display_px, memory.placement, pipeline.settings.render);
    state.sprites.put(sprite.layer, std::move(result.sprite));
    memory.drawn = true;
    if (memory.frame_rendered != report.frame) {
      ++report.late_renders;  // its counters belong to the frame for which it was planned
    } else {
      report.render += result.counters;
      report.render_by_layer[sprite.layer] = result.counters;
    }
  }
}

chunker::CompositeResult composite_shown(const Pipeline& pipeline, const std::vector<ShownSprite>& shown,
                                         const chunker::SpriteStore& sprites) {
  std::vector<chunker::PlacedSprite> placed;
  placed.reserve(shown.size());
  for (const ShownSprite& sprite : shown) {
    chunker::PlacedSprite p;
    p.sprite = sprites.find(sprite.layer);
    p.screen_from_sprite = sprite.screen_from_sprite;
    placed.push_back(p);
  }
  return chunker::composite(placed, pipeline.settings.view.display_px, pipeline.scene.background);
}

/// All parts in one pass of the renderer into one display-sized sprite: the picture without layers.
chunker::CompositeResult draw_in_one_pass(const Pipeline& pipeline, const SceneFrame& scene_frame,
                                          const chunker::PreparedScene& prepared,
                                          chunker::RenderCounters& counters) {
  std::vector<int> parts;
  for (const Layer& layer : pipeline.layers.layers)
    parts.insert(parts.end(), layer.parts.begin(), layer.parts.end());
  SpritePlacement whole_display;
  whole_display.size_px = pipeline.settings.view.display_px;
  const chunker::RenderResult result =
      chunker::render(prepared, scene_frame, parts, pipeline.settings.view.display_px, whole_display,
                      pipeline.settings.render);
  counters += result.counters;
  chunker::PlacedSprite placed;
  placed.sprite = &result.sprite;
  return chunker::composite({&placed, 1}, pipeline.settings.view.display_px, pipeline.scene.background);
}

void draw(const Pipeline& pipeline, PipelineState& state, const SceneFrame& now,
          const chunker::PreparedScene& prepared, FrameReport& report) {
  chunker::CompositeResult result;
  const Stopwatch render_watch;
  if (pipeline.settings.regulator.policy == regulator::Policy::Direct) {
    result = draw_in_one_pass(pipeline, now, prepared, report.render);
    report.times.render_ms = render_watch.ms();
  } else {
    draw_missing_sprites(pipeline, state, now, prepared, report);
    report.times.render_ms = render_watch.ms();
    const Stopwatch composite_watch;
    result = composite_shown(pipeline, report.shown, state.sprites);
    report.times.composite_ms = composite_watch.ms();
  }
  report.picture = std::move(result.frame);
  report.composite = result.counters;
  report.sprite_bytes = state.sprites.bytes();
}

}  // namespace

Pipeline::Pipeline(const layers::Scene& scene_in, const layers::LayerSet& layers_in,
                   const Settings& settings_in)
    : scene(scene_in), layers(layers_in), settings(settings_in) {
  for (const Layer& layer : layers.layers)
    bounds.push_back(layers::make_layer_bound(scene, layer, settings.bound));
}

FrameReport step(const Pipeline& pipeline, PipelineState& state, int frame,
                 const chunker::PreparedScene* prepared) {
  TALISMAN_CHECK_EQ(state.memory.size(), pipeline.layers.layers.size());
  FrameReport report;
  report.frame = frame;
  report.render_by_layer.resize(state.memory.size());

  // Decide: no pixel is touched up to and including the plan.
  const Stopwatch plan_watch;
  begin_frame(pipeline, state, frame);
  const std::vector<LayerState>& states = states_at(pipeline, state, frame);
  const std::vector<int> order = order_layers(pipeline, states);
  report.assessments.reserve(pipeline.layers.layers.size());
  for (const Layer& layer : pipeline.layers.layers) {
    report.assessments.push_back(assess_layer(pipeline, state, layer.id, frame));
    report.layers_assessed += report.assessments.back().in_view && report.assessments.back().has_sprite;
  }
  if (pipeline.settings.regulator.policy == regulator::Policy::Budget)
    fit_resolutions(pipeline, state, frame, report.assessments);
  report.plan = regulator::regulate(frame, report.assessments, pipeline.settings.regulator);
  double bookkeeping_ms = plan_watch.ms();
  report.pixels_reference = reference_pixels(pipeline, states);
  if (pipeline.settings.budget_gap) report.budget_gap = gap_of(pipeline, report);
  bookkeeping_ms = plan_watch.ms() - bookkeeping_ms;
  remember_renders(pipeline, state, report);
  report.shown = sprites_shown(state, report, order);
  report.times.plan_ms = plan_watch.ms() - bookkeeping_ms;  // the yardstick is not part of the plan

  // Execute.
  if (prepared) draw(pipeline, state, pipeline.scene.at(time_of(pipeline, frame)), *prepared, report);
  return report;
}

chunker::Frame draw_direct(const Pipeline& pipeline, int frame, const chunker::PreparedScene& prepared) {
  chunker::RenderCounters ignored;
  return draw_in_one_pass(pipeline, pipeline.scene.at(time_of(pipeline, frame)), prepared, ignored).frame;
}

chunker::Frame draw_reference(const Pipeline& pipeline, int frame, const chunker::PreparedScene& prepared) {
  Pipeline reference = pipeline;
  reference.settings.regulator.policy = regulator::Policy::Reference;
  PipelineState fresh(reference);
  return step(reference, fresh, frame, &prepared).picture;
}

}  // namespace talisman::sequences
