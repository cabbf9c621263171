// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/frame_lines.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "regulator/profile.h"
#include "sequences/files/content_hash.h"
#include "sequences/pipeline/lod/levels_now.h"
#include "sequences/results/column_json.h"
#include "sequences/results/column_tables.h"

namespace talisman::sequences {

namespace {

std::optional<double> light_beside_px_of(const FrameReport& report) {
  std::optional<double> px;
  for (const ShownSprite& shown : report.shown)
    if (shown.beside_base_px) px = std::max(px.value_or(0), *shown.beside_base_px);
  return px;
}

/// What is known of a frame that was drawn.
void add_drawing(FrameLine& line, const FrameReport& report) {
  line.frame_hash = hash_of(report.picture);
  line.pixels.filled = report.render.pixels_filled + report.shade.shadow_pixels + report.blended_pixels;
  line.pixels.registers =
      report.order.resolved_counters().operators * static_cast<std::int64_t>(report.picture.pixels.size());
  line.pixels.composited = report.composite.pixels_composited;
  line.chunks = {report.render.chunks_rendered, report.render.chunks_clear};
  line.fragments = report.render.fragments;
  line.texture_samples = report.render.texture_samples;
  line.sprite_bytes = report.sprite_bytes;
  line.compression = report.compression;
  if (line.compression) line.times.compress_ms = line.compression->compress_ms;
  line.times.render_ms = report.times.render_ms;
  line.times.composite_ms = report.times.composite_ms;
  line.times.late_pixels = report.late_chunks.pixels_filled;
  line.modelled_ms =
      regulator::modelled_time(regulator::talisman_1996(), line.polygons.rendered, line.pixels.filled,
                               line.pixels.composited + line.pixels.registers, line.upload_bytes.value_or(0))
          .frame_ms;
}

const RowJson<FrameLine>& frame_json() {
  static const RowJson<FrameLine> json(frame_table());
  return json;
}

}  // namespace

std::string hash_of(const chunker::Frame& picture) {
  static_assert(sizeof(chunker::Linear16) == 8);
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(picture.pixels.data());
  return hash_of(std::span<const std::uint8_t>(bytes, 8 * picture.pixels.size())).hex();
}

FrameLine line_of(const FrameReport& report) {
  FrameLine line;
  line.frame = report.frame;
  line.layers_assessed = report.layers_assessed;
  for (const regulator::LayerDecision& d : report.plan.decisions) {
    line.renders += d.action == regulator::Action::Rerender;
    line.reuses += d.action == regulator::Action::Reuse;
    line.polygons.rendered += d.cost.polygons;
    line.pixels.rendered += d.cost.pixels;
    line.layers_in_view += d.action != regulator::Action::Drop;
  }
  line.error = error_of(report);
  line.passes = {report.shade.shadow_maps_drawn, report.shade.shadow_maps_reused,
                 report.shade.reflections_drawn};
  line.polygons.rendered += report.shade.shadow_polygons;
  line.pixels.rendered += report.shade.shadow_pixels;
  line.depth_complexity = report.depth_complexity;
  line.modelled_drawing_ms = planned_drawing_ms(report);
  line.polygons.reference = report.reference.polygons;
  line.pixels.reference = report.reference.pixels;
  line.times.plan_ms = report.times.plan_ms;
  if (report.order.sorted) {
    line.visibility = {report.order.counters, report.order.merged_parts, report.order.resolved_counters()};
    line.times.sort_ms = report.order.sort_ms;
  }
  line.light_beside_px = light_beside_px_of(report);
  line.budget_gap = report.budget_gap;
  line.lod = report.plan.lod;
  line.lookahead = report.lookahead;
  line.refresh = report.refresh;
  line.predictive = report.predictive;
  if (line.predictive) {  // the rest depends on which frames were drawn
    line.predictive->buffer_bytes = 0;
    line.predictive->joined = {};
  }
  if (report.late) line.latency = report.late->report;
  line.upload_bytes = report.upload_bytes;
  if (!report.picture.pixels.empty()) add_drawing(line, report);
  return line;
}

std::string json_of(const FrameLine& line) { return frame_json().write(line).dump(); }

std::optional<FrameLine> frame_line_from_json(const std::string& text) try {
  FrameLine line;
  line.error = {warp::kHugePx, warp::kHugePx};  // null when read
  frame_json().read(nlohmann::ordered_json::parse(text), line);
  return line;
} catch (const nlohmann::json::exception&) {
  return std::nullopt;
} catch (const std::invalid_argument&) {
  return std::nullopt;
}

std::string json_of(const DecisionRow& row) {
  static const RowJson<DecisionRow> json(decision_table());
  return json.write(row).dump();
}

std::string json_of(const FrameReport& report, const regulator::LayerDecision& of_layer) {
  return json_of(DecisionRow(report, of_layer));
}

}  // namespace talisman::sequences
