// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/frame_lines.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "regulator/profile.h"
#include "sequences/files/number_text.h"
#include "sequences/pipeline/aggregates.h"
#include "sequences/pipeline/run_effects.h"
#include "sequences/results/compression_json.h"
#include "sequences/results/visibility_fields.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Quality& q) {
  return {{"psnr_db", number_or_null(q.psnr_db)},
          {"ssim", q.ssim},
          {"flip", q.flip},
          {"max_difference", q.max_difference},
          {"changed_pixels", q.changed_pixels}};
}

Quality quality_from(const Json& json) {
  Quality q;
  q.psnr_db = json.at("psnr_db").is_null() ? INFINITY : json.at("psnr_db").get<double>();
  q.ssim = json.at("ssim");
  q.flip = json.at("flip");
  q.max_difference = json.at("max_difference");
  q.changed_pixels = json.at("changed_pixels");
  return q;
}

/// The six numbers of an affine map or the nine of a perspective one, row by row.
Json json_of(const warp::Warp& w) {
  const layers::dmat3& m = w.now_from_then;
  Json json = {m[0][0], m[1][0], m[2][0], m[0][1], m[1][1], m[2][1]};
  if (!w.is_affine())
    for (const int column : {0, 1, 2}) json.push_back(m[column][2]);
  return json;
}

Json json_of(const regulator::LayerCost& cost) {
  return {
      {"polygons", cost.polygons}, {"pixels", cost.pixels}, {"chunks", cost.chunks}, {"bytes", cost.bytes}};
}

Json json_of(const layers::dvec3& v) { return {v.x, v.y, v.z}; }

Json json_of(const fiducials::LightRef& light) {
  if (light.index == fiducials::LightRef::kEye) return "eye (highlights)";
  return light.index >= 0 ? Json(light.name) : Json(nullptr);
}

Json json_of(const fiducials::Photometric& p) {
  if (!p.computed) return {{"why_not", p.why_not}};
  return {{"color", p.color},
          {"multiplier", json_of(p.multiplier)},
          {"worst_at_px", {p.where_px.x, p.where_px.y}},
          {"light", json_of(p.color_light)},
          {"light_angle_rad", p.light_angle_rad},
          {"angle_light", json_of(p.angle_light)},
          {"light_distance", p.light_distance}};
}

Json json_of(const regulator::LayerAssessment& a) {
  const fiducials::Report& f = a.fiducials;
  return {{"warp_geometric_px", f.geometric.px},
          {"held_geometric_px", a.held_geometric_px},
          {"worst_at_px", {f.geometric.where_px.x, f.geometric.where_px.y}},
          {"magnification", f.sampling.magnification},
          {"minification", f.sampling.minification},
          {"anisotropy", f.sampling.anisotropy},
          {"uncovered_px", f.visibility.computed ? Json(f.visibility.uncovered_px) : Json(nullptr)},
          {"uncovered_why_not", f.visibility.why_not},
          {"photometric", json_of(f.photometric)},
          {"turned_px", f.turned.computed ? Json(f.turned.px) : Json(nullptr)},
          {"turned_faces", f.turned.count},
          {"shade_px", f.shade.computed ? Json(f.shade.px) : Json(nullptr)},
          {"matched_points", a.matched_points},
          {"fit", warp::name(a.fitted.status)},
          {"frames_since_render", a.frames_since_render}};
}

/// The integer and real fields of a frame line, named once for writing and reading.
struct IntField {
  const char* name;
  std::int64_t FrameLine::*field;
};
struct RealField {
  const char* name;
  double FrameLine::*field;
};
struct CountField {
  const char* name;
  int FrameLine::*field;
};
constexpr CountField kCounts[] = {{"layers_in_view", &FrameLine::layers_in_view},
                                  {"renders", &FrameLine::renders},
                                  {"reuses", &FrameLine::reuses},
                                  {"layers_assessed", &FrameLine::layers_assessed},
                                  {"shadow_maps_drawn", &FrameLine::shadow_maps_drawn},
                                  {"shadow_maps_reused", &FrameLine::shadow_maps_reused},
                                  {"reflections_drawn", &FrameLine::reflections_drawn}};
constexpr IntField kTotals[] = {{"polygons_rendered", &FrameLine::polygons_rendered},
                                {"polygons_reference", &FrameLine::polygons_reference},
                                {"pixels_rendered", &FrameLine::pixels_rendered},
                                {"pixels_reference", &FrameLine::pixels_reference}};
constexpr IntField kMeasured[] = {{"pixels_filled", &FrameLine::pixels_filled},
                                  {"pixels_composited", &FrameLine::pixels_composited},
                                  {"chunks_rendered", &FrameLine::chunks_rendered},
                                  {"chunks_clear", &FrameLine::chunks_clear},
                                  {"fragments", &FrameLine::fragments},
                                  {"texture_samples", &FrameLine::texture_samples},
                                  {"sprite_bytes", &FrameLine::sprite_bytes}};
constexpr RealField kTimes[] = {{"plan_ms", &FrameLine::plan_ms},
                                {"render_ms", &FrameLine::render_ms},
                                {"composite_ms", &FrameLine::composite_ms},
                                {"io_ms", &FrameLine::io_ms},
                                {"modelled_ms", &FrameLine::modelled_ms}};

struct ResolvedField {
  const char* name;
  int ResolvedCounters::*field;
};
constexpr ResolvedField kResolved[] = {{"resolved_components", &ResolvedCounters::components},
                                       {"resolved_layers", &ResolvedCounters::layers},
                                       {"expression_registers", &ResolvedCounters::registers},
                                       {"expression_reads", &ResolvedCounters::reads}};

Json json_of(const VisibilityLine& line) {
  Json json = Json::object();
  for (const VisibilityField& f : kVisibilityFields) json[f.name] = line.counters.*f.field;
  for (const ResolvedField& f : kResolved) json[f.name] = line.resolved.*f.field;
  json["merged_parts"] = line.merged_parts;
  json["sort_ms"] = line.sort_ms;
  return json;
}

VisibilityLine visibility_from(const Json& json) {
  VisibilityLine line;
  for (const VisibilityField& f : kVisibilityFields) json.at(f.name).get_to(line.counters.*f.field);
  for (const ResolvedField& f : kResolved) json.at(f.name).get_to(line.resolved.*f.field);
  json.at("merged_parts").get_to(line.merged_parts);
  json.at("sort_ms").get_to(line.sort_ms);
  return line;
}

}  // namespace

std::string hash_of(const chunker::Frame& picture) {
  std::uint64_t hash = 1469598103934665603ull;
  const auto add = [&hash](std::uint64_t byte) { hash = (hash ^ byte) * 1099511628211ull; };
  for (const chunker::Linear16& p : picture.pixels)
    for (const std::uint16_t channel : {p.r, p.g, p.b, p.a}) {
      add(channel & 255u);
      add(channel >> 8);
    }
  char text[24];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

FrameLine line_of(const FrameReport& report) {
  FrameLine line;
  line.frame = report.frame;
  line.layers_assessed = report.layers_assessed;
  for (const regulator::LayerDecision& d : report.plan.decisions) {
    line.renders += d.action == regulator::Action::Rerender;
    line.reuses += d.action == regulator::Action::Reuse;
    line.polygons_rendered += d.cost.polygons;
    line.pixels_rendered += d.cost.pixels;
    if (d.action == regulator::Action::Drop) continue;
    ++line.layers_in_view;
    line.polygons_reference += report.layers[d.layer].polygons;
  }
  line.shadow_maps_drawn = report.shade.shadow_maps_drawn;
  line.shadow_maps_reused = report.shade.shadow_maps_reused;
  line.reflections_drawn = report.shade.reflections_drawn;
  line.polygons_rendered += report.shade.shadow_polygons;
  line.polygons_reference += report.shade.shadow_polygons;  // drawn for the layers of this frame
  line.pixels_reference = report.pixels_reference;
  line.plan_ms = report.times.plan_ms;
  if (report.order.sorted)
    line.visibility = {report.order.counters, report.order.merged_parts, report.order.sort_ms,
                       report.order.resolved_counters()};
  line.budget_gap = report.budget_gap;
  if (report.picture.pixels.empty()) return line;
  line.frame_hash = hash_of(report.picture);
  line.pixels_filled = report.render.pixels_filled;
  line.pixels_composited = report.composite.pixels_composited;
  line.chunks_rendered = report.render.chunks_rendered;
  line.chunks_clear = report.render.chunks_clear;
  line.fragments = report.render.fragments;
  line.texture_samples = report.render.texture_samples;
  line.sprite_bytes = report.sprite_bytes;
  line.compression = report.compression;
  line.render_ms = report.times.render_ms;
  line.composite_ms = report.times.composite_ms;
  line.modelled_ms = regulator::modelled_time(regulator::talisman_1996(), line.polygons_rendered,
                                              line.pixels_filled, line.pixels_composited)
                         .frame_ms;
  return line;
}

std::string json_of(const FrameLine& line) {
  const bool drawn = !line.frame_hash.empty();
  Json json = {{"schema", "talisman.frame/1"}, {"frame", line.frame}};
  json["frame_hash"] = drawn ? Json(line.frame_hash) : Json(nullptr);
  for (const auto& f : kCounts) json[f.name] = line.*f.field;
  for (const auto& f : kTotals) json[f.name] = line.*f.field;
  for (const auto& f : kMeasured) json[f.name] = drawn ? Json(line.*f.field) : Json(nullptr);
  for (const auto& f : kTimes)
    json[f.name] = drawn || f.field == &FrameLine::plan_ms ? Json(line.*f.field) : Json(nullptr);
  if (line.compression) json["compression"] = compression_json(*line.compression);
  json["visibility"] = line.visibility ? json_of(*line.visibility) : Json(nullptr);
  if (line.budget_gap)
    json["budget_gap"] = {{"greedy_px", line.budget_gap->greedy_px},
                          {"optimal_px", line.budget_gap->optimal_px},
                          {"gap", line.budget_gap->gap()},
                          {"exact", line.budget_gap->exact}};
  if (line.quality)
    json["quality"] = {{"total", json_of(line.quality->total)},
                       {"reuse", json_of(line.quality->reuse)},
                       {"resampling", json_of(line.quality->resampling)}};
  return json.dump();
}

std::optional<FrameLine> frame_line_from_json(const std::string& text) try {
  const Json json = Json::parse(text);
  FrameLine line;
  line.frame = json.at("frame");
  if (!json.at("frame_hash").is_null()) line.frame_hash = json.at("frame_hash");
  const auto read = [&json](const char* name, auto& value) {
    if (!json.at(name).is_null()) json.at(name).get_to(value);
  };
  for (const auto& f : kCounts) read(f.name, line.*f.field);
  for (const auto& f : kTotals) read(f.name, line.*f.field);
  for (const auto& f : kMeasured) read(f.name, line.*f.field);
  for (const auto& f : kTimes) read(f.name, line.*f.field);
  if (json.contains("compression")) line.compression = compression_from_json(json["compression"]);
  if (!json.at("visibility").is_null()) line.visibility = visibility_from(json["visibility"]);
  if (json.contains("budget_gap")) {
    const Json& gap = json["budget_gap"];
    line.budget_gap = regulator::BudgetGap{gap.at("greedy_px"), gap.at("optimal_px"), gap.at("exact")};
  }
  if (json.contains("quality"))
    line.quality =
        FrameQuality{quality_from(json["quality"].at("total")), quality_from(json["quality"].at("reuse")),
                     quality_from(json["quality"].at("resampling"))};
  return line;
} catch (const Json::exception&) {
  return std::nullopt;
}

std::string json_of(const FrameReport& report, const regulator::LayerDecision& d) {
  const Json json = {
      {"schema", "talisman.decision/1"},
      {"frame", report.frame},
      {"layer", report.layers[d.layer].name},
      {"decision", regulator::name(d.action)},
      {"reason", d.reason},
      {"warp", json_of(d.shown_warp)},
      {"geometric_px", d.shown_geometric_px},
      {"color", json_of(d.shown_color)},
      {"resolution", d.resolution},
      {"depicts_frame", d.depicts_frame >= 0 ? Json(d.depicts_frame) : Json(nullptr)},
      {"fiducials", report.assessments[d.layer].has_sprite && report.assessments[d.layer].in_view
                        ? json_of(report.assessments[d.layer])
                        : Json(nullptr)},
      {"cost", json_of(d.cost)}};
  return json.dump();
}

namespace {

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
  for (const regulator::LayerDecision& d : report.plan.decisions) {
    if (d.action == regulator::Action::Drop) continue;
    LayerSummary& layer = summary.layers[row_in_run(state, d.layer)];
    ++layer.frames_shown;
    layer.sum_resolution += d.resolution;
    layer.sum_geometric_px += d.shown_geometric_px;
    layer.max_geometric_px = std::max(layer.max_geometric_px, d.shown_geometric_px);
    if (d.action != regulator::Action::Rerender) continue;
    ++layer.renders;
    const layers::ivec2 size = state.memory[d.layer].placement.size_px;
    if (std::int64_t{size.x} * size.y > std::int64_t{layer.sprite_px.x} * layer.sprite_px.y)
      layer.sprite_px = size;
    const layers::Layer& drawn = report.layers[d.layer];
    for (const int member : drawn.members) ++summary.layers[member].merged_renders;
    for (std::size_t e = 0; e < summary.effects.size(); ++e)
      summary.effect_passes[e] += is_drawn_with(summary.effects[e], drawn);
  }
}

double Summary::mean_update_rate() const {
  double sum = 0;
  int count = 0;
  for (const LayerSummary& layer : layers) {
    if (layer.is_aggregate) continue;
    sum += layer.drawn_rate(static_cast<int>(frames.size()));
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

double Summary::cost_weighted_update_rate() const {
  double weighted = 0, weight = 0;
  for (const LayerSummary& layer : layers) {
    if (layer.is_aggregate) continue;
    weighted += layer.polygons * layer.drawn_rate(static_cast<int>(frames.size()));
    weight += layer.polygons;
  }
  return weight > 0 ? weighted / weight : 0;
}

std::int64_t Summary::total(std::int64_t FrameLine::*field) const {
  std::int64_t sum = 0;
  for (const FrameLine& line : frames) sum += line.*field;
  return sum;
}

double Summary::total(double FrameLine::*field) const {
  double sum = 0;
  for (const FrameLine& line : frames) sum += line.*field;
  return sum;
}

GapSummary Summary::budget_gap() const {
  GapSummary gap;
  for (const FrameLine& line : frames) {
    if (!line.budget_gap) continue;
    ++gap.frames;
    if (!line.budget_gap->exact) continue;  // nothing is known of it
    ++gap.exact_frames;
    gap.mean += line.budget_gap->gap();
    gap.max = std::max(gap.max, line.budget_gap->gap());
  }
  if (gap.exact_frames > 0) gap.mean /= gap.exact_frames;
  return gap;
}

double Summary::planning_us_per_layer_and_frame() const {
  const double layer_frames = static_cast<double>(layers.size() * frames.size());
  return layer_frames > 0 ? 1e3 * total(&FrameLine::plan_ms) / layer_frames : 0;
}

}  // namespace talisman::sequences
