// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/summary.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "regulator/profile.h"
#include "sequences/pipeline/aggregates.h"
#include "sequences/pipeline/refresh/refresh.h"
#include "sequences/pipeline/run_effects.h"
#include "sequences/results/column_json.h"
#include "sequences/results/column_tables.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

LayerSummary row_of(const std::string& name, int parts, int polygons, bool is_aggregate) {
  LayerSummary row;
  row.name = name;
  row.parts = parts;
  row.polygons = polygons;
  row.is_aggregate = is_aggregate;
  return row;
}

/// Is the effect at work when this layer is rendered? In an aggregate it is if one of the members uses it.
bool is_drawn_with(const layers::EffectCall& effect, const layers::Layer& layer) {
  if (effect.effect == layers::Effect::VisibilitySort || effect.effect == layers::Effect::ShadowMap)
    return false;  // counted by itself
  const auto uses = [&](int id) {
    return std::find(effect.layers.begin(), effect.layers.end(), id) != effect.layers.end();
  };
  return uses(layer.id) || std::any_of(layer.members.begin(), layer.members.end(), uses);
}

Json layers_json(const Summary& s) {
  static const RowJson<LayerRow> writer(layer_table());
  Json json = Json::array();
  for (const LayerSummary* row : s.rows())
    json.push_back(writer.write({*row, s.frame_count(), s.share_of_cost(*row)}));
  return json;
}

Json effects_json(const Summary& s) {
  static const RowJson<EffectRow> writer(effect_table());
  Json json = Json::object();
  for (std::size_t e = 0; e < s.effects.size(); ++e)
    json[std::string(layers::name(s.effects[e].effect))] = writer.write({s.effects[e], s.effect_passes[e]});
  return json;
}

Json audit_json(const Summary& s) {
  static const RowJson<LayerAudit> writer(audit_table());
  Json json = Json::array();
  for (const LayerAudit& layer : s.audit) json.push_back(writer.write(layer));
  return json;
}

/// Modelled time of drawing this much alone, the measure of a row's share: polygons or pixels, whichever take longer.
/// The pixels of sprites are filled as often as a budget of milliseconds takes them to be.
double render_ms(std::int64_t polygons, double pixels) {
  return regulator::modelled_time(regulator::talisman_1996(), polygons, std::llround(pixels), 0).render_ms;
}

/// The row of this name; made where there is none.
LayerSummary& row_of_name(std::vector<LayerSummary>& rows, const std::string& name, int parts, int polygons) {
  const auto found =
      std::find_if(rows.begin(), rows.end(), [&](const auto& row) { return row.name == name; });
  if (found != rows.end()) return *found;
  rows.push_back(row_of(name, parts, polygons, false));
  return rows.back();
}

/// What a frame in which it is shown adds to its row, but for the renders.
void add_decision(const regulator::LayerDecision& d, layers::ivec2 size_px, LayerSummary& row) {
  ++row.frames_shown;
  row.sum_resolution += d.resolution;
  row.sum_geometric_px += d.shown_geometric_px;
  row.max_geometric_px = std::max(row.max_geometric_px, d.shown_geometric_px);
  row.frames_deferred += d.deferred;
  row.frames_over_budget += d.over_budget;
  const bool is_larger =
      std::int64_t{size_px.x} * size_px.y > std::int64_t{row.sprite_px.x} * row.sprite_px.y;
  if (d.action == regulator::Action::Rerender && is_larger) row.sprite_px = size_px;
}

/// Was one of them put off?
bool add_shadow_maps(Summary& summary, const FrameReport& report) {
  bool any_deferred = false;
  for (const ShadowMapRow& map : report.shadow_maps) {
    LayerSummary& row =
        row_of_name(summary.shadow_maps, map.name, map.parts, static_cast<int>(map.assessment.cost.polygons));
    row.is_shadow_map = true;
    row.renders += map.pictures;
    if (map.decision.action != regulator::Action::Drop) add_decision(map.decision, map.size_px, row);
    const regulator::LayerCost& cost = map.decision.cost;
    row.render_ms += render_ms(cost.polygons, static_cast<double>(cost.pixels));
    if (map.pictures > 0) row.reasons.add(map.decision.reason);
    any_deferred = any_deferred || map.decision.deferred;
  }
  return any_deferred;
}

/// A render of a layer: its sprite, and the pictures that it mirrors, which its cost holds.
void add_render(const regulator::LayerDecision& d, const layers::Layer& drawn, layers::ivec2 size_px,
                const FrameReport& report, LayerSummary& layer, Summary& summary) {
  ++layer.renders;
  layer.reasons.add(d.reason);
  const double filled = report.depth_complexity;
  const int mirrors = static_cast<int>(mirrors_in(report.layers.set(), drawn).size());
  const std::int64_t own_pixels = mirrors > 0 ? std::int64_t{size_px.x} * size_px.y : d.cost.pixels;
  layer.render_ms += render_ms(d.cost.polygons, filled * static_cast<double>(own_pixels));
  if (mirrors == 0) return;
  LayerSummary& row = row_of_name(summary.mirrors, "mirrored by " + drawn.name, 0, 0);
  row.is_mirror = true;
  row.renders += mirrors;
  row.render_ms += render_ms(0, filled * static_cast<double>(d.cost.pixels - own_pixels));
}

void add_refresh(const regulator::LayerDecision& d, double filled, LayerSummary& layer) {
  ++*layer.refreshes;
  layer.share_refreshed += d.chunks->share();
  layer.render_ms += render_ms(d.cost.polygons, filled * static_cast<double>(d.cost.pixels));
}

}  // namespace

Summary start_summary(const Pipeline& pipeline, const std::string& sequence) {
  const Settings& settings = pipeline.settings;
  Summary summary;
  summary.sequence = sequence;
  summary.policy = regulator::name(settings.regulator.policy);
  summary.warp = warp::name(settings.curve);
  if (settings.compositor == Compositor::Extended) summary.compositor = "extended";
  summary.display_px = settings.view.display_px;
  if (settings.compression) summary.compression_quality = settings.compression->quality;
  summary.effects =
      layers::effects_called_for(pipeline.scene, pipeline.authored.set().layers, run_effects(settings));
  summary.effect_passes.assign(summary.effects.size(), 0);
  for (const layers::Layer& layer : pipeline.authored)
    summary.layers.push_back(row_of(layer.name, static_cast<int>(layer.parts.size()), layer.polygons, false));
  if (refreshes_chunks(pipeline))
    for (LayerSummary& layer : summary.layers) layer.refreshes = 0;
  return summary;
}

void add_decisions(Summary& summary, const FrameReport& report, const PipelineState& state) {
  const std::size_t authored = report.order.merged_into.size();
  const std::vector<AggregateRecord>& aggregates = state.order.history.records;
  for (std::size_t serial = summary.layers.size() - authored; serial < aggregates.size(); ++serial)
    summary.layers.push_back(
        row_of(aggregates[serial].name, aggregates[serial].parts, aggregates[serial].polygons, true));
  for (std::size_t e = 0; e < summary.effects.size(); ++e)
    if (summary.effects[e].effect == layers::Effect::VisibilitySort)
      summary.effect_passes[e] += report.order.sorted;
    else if (summary.effects[e].effect == layers::Effect::ShadowMap)
      summary.effect_passes[e] += report.shade.shadow_maps_drawn;
  bool any_deferred = add_shadow_maps(summary, report);
  for (const regulator::LayerDecision& d : report.plan.decisions) {
    if (d.action == regulator::Action::Drop) continue;
    LayerSummary& layer = summary.layers[row_in_run(state, d.layer)];
    add_decision(d, state.memory[d.layer].placement.size_px, layer);
    any_deferred = any_deferred || d.deferred;
    if (d.action == regulator::Action::Refresh) add_refresh(d, report.depth_complexity, layer);
    if (d.action != regulator::Action::Rerender) continue;
    const layers::SpritePlacement& placement = state.memory[d.layer].placement;
    layer.is_capped |= placement.resolution_reduced;
    const layers::Layer& drawn = report.layers[d.layer];
    add_render(d, drawn, placement.size_px, report, layer, summary);
    for (const int member : drawn.members) ++summary.layers[member].merged_renders;
    for (std::size_t e = 0; e < summary.effects.size(); ++e)
      summary.effect_passes[e] += is_drawn_with(summary.effects[e], drawn);
  }
  summary.frames_deferred += any_deferred;
}

std::vector<const LayerSummary*> Summary::rows() const {
  std::vector<const LayerSummary*> all;
  for (const auto* kind : {&layers, &shadow_maps, &mirrors})
    for (const LayerSummary& row : *kind) all.push_back(&row);
  return all;
}

double Summary::share_of_cost(const LayerSummary& row) const {
  double all = 0;
  for (const LayerSummary* each : rows()) all += each->render_ms;
  return all > 0 ? row.render_ms / all : 0;
}

double Summary::mean_update_rate() const {
  double sum = 0;
  int count = 0;
  for (const LayerSummary& layer : layers) {
    if (layer.is_aggregate) continue;
    sum += layer.drawn_rate(frame_count());
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

double Summary::cost_weighted_update_rate() const {
  double weighted = 0, weight = 0;
  for (const LayerSummary& layer : layers) {
    if (layer.is_aggregate) continue;
    weighted += layer.polygons * layer.drawn_rate(frame_count());
    weight += layer.polygons;
  }
  return weight > 0 ? weighted / weight : 0;
}

FrameTotals Summary::sums() const {
  FrameTotals sums = earlier;
  for (const FrameLine& line : frames) sums.add(line);
  return sums;
}

std::int64_t Summary::polygons_rendered() const {
  return total([](const FrameLine& line) { return line.polygons.rendered; });
}

std::int64_t Summary::pixels_rendered() const {
  return total([](const FrameLine& line) { return line.pixels.rendered; });
}

double Summary::plan_ms() const {
  return total([](const FrameLine& line) { return line.times.plan_ms; });
}

double Summary::planning_us_per_layer_and_frame() const {
  const double layer_frames = static_cast<double>(layers.size()) * frame_count();
  return layer_frames > 0 ? 1e3 * plan_ms() / layer_frames : 0;
}

std::string json_of(const Summary& s) {
  static const RowJson<RunRow> writer(run_table());
  Json json = writer.write(RunRow(s));
  json["layers"] = layers_json(s);
  json["effects"] = effects_json(s);
  if (!s.audit.empty()) json["audit"] = audit_json(s);
  return json.dump(2) + "\n";
}

}  // namespace talisman::sequences
