// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/tuning/thresholds.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include <glm/matrix.hpp>

#include "regulator/profile.h"
#include "sequences/content/seams.h"
#include "sequences/experiments/effect_removal.h"
#include "sequences/files/content_hash.h"
#include "sequences/files/number_text.h"
#include "sequences/pipeline/make_pipeline.h"
#include "sequences/pipeline/step.h"
#include "sequences/results/frame_lines.h"

namespace talisman::sequences {

namespace {

/// How much of the display may be wrong, and by how far: what a picture error grows with.
double suspicion_of(const FrameReport& report, layers::ivec2 display_px) {
  constexpr double kSaturated_px = 8;
  const double display = double(display_px.x) * display_px.y;
  double sum = 0;
  for (const ShownSprite& shown : report.shown) {
    const double px = report.plan.decisions[shown.layer].shown_geometric_px;
    const double area =
        std::abs(glm::determinant(shown.screen_from_sprite)) * shown.size_px.x * shown.size_px.y;
    if (px > 0) sum += std::min(px, kSaturated_px) * std::min(std::isfinite(area) ? area : display, display);
  }
  return sum;
}

}  // namespace

double as_printed(double value) { return std::strtod(formatted("%.3g", value).c_str(), nullptr); }

std::vector<double> tuned_grid() {
  constexpr double kCoarsest_px = 64, kPerOctave = 6;
  std::vector<double> grid{0};
  for (int k = kTunedGrid - 2; k >= 0; --k)
    grid.push_back(as_printed(kCoarsest_px * std::exp2(-k / kPerOctave)));
  return grid;
}

Variant with_thresholds(const Sequence& sequence, const Settings& settings,
                        const TriedThresholds& thresholds) {
  Variant variant{sequence, settings};
  variant.settings.regulator.thresholds.geometric_px = thresholds.geometric_px;
  bool is_other = false;
  for (std::size_t k = 0; k < thresholds.weights.size(); ++k) {
    double& weight = variant.sequence.layer_specs[k].preferences.importance.geometric;
    is_other = is_other || weight != thresholds.weights[k];
    weight = thresholds.weights[k];
  }
  if (is_other) factor_again(variant);
  variant.sequence = with_seams_for(std::move(variant.sequence), variant.settings);
  return variant;
}

namespace {

double drawing_ms(const regulator::LayerCost& cost, double depth_complexity) {
  return regulator::modelled_time(regulator::talisman_1996(), cost.polygons,
                                  std::llround(double(cost.pixels) * depth_complexity), 0)
      .render_ms;
}

void add_decisions_to(ContentHasher& hash, const FrameReport& report) {
  for (const regulator::LayerDecision& d : report.plan.decisions) {
    hash.add(static_cast<int>(d.action));
    hash.add(d.depicts_frame);
  }
  for (const ShadowMapRow& map : report.shadow_maps) hash.add(map.pictures);
}

/// Of the geometry layers, which stand in the order of their specs.
void add_layer_times(const FrameReport& report, std::size_t authored, std::vector<double>& layer_ms) {
  std::size_t spec = 0;
  for (std::size_t id = 0; id < authored; ++id)
    if (report.layers[static_cast<int>(id)].kind == layers::LayerKind::Geometry)
      layer_ms[spec++] += drawing_ms(report.plan.decisions[id].cost, report.depth_complexity);
}

}  // namespace

PlannedThresholds plan_of(const Sequence& sequence, const Settings& settings, const FrameRange& range,
                          const TriedThresholds& thresholds) {
  const Variant variant = with_thresholds(sequence, settings, thresholds);
  PlannedThresholds plan;
  plan.thresholds = thresholds;
  plan.layer_ms.assign(sequence.layer_specs.size(), 0);
  ContentHasher hash;
  const Pipeline pipeline = make_pipeline(*variant.sequence.scene, variant.sequence.layers, variant.settings);
  PipelineState state(pipeline);
  for (int frame = 0; frame <= range.last; ++frame) {
    const FrameReport report = step(pipeline, state, frame, nullptr);
    add_decisions_to(hash, report);
    if (frame < range.first) continue;
    plan.frame_ms.push_back(line_of(report).modelled_drawing_ms);
    plan.cost_ms += plan.frame_ms.back();
    plan.suspicion.push_back(suspicion_of(report, settings.view.display_px));
    add_layer_times(report, sequence.layers.layers.size(), plan.layer_ms);
  }
  plan.decisions = hash.hash().low;
  return plan;
}

}  // namespace talisman::sequences
