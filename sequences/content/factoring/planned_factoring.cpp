// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/factoring/planned_factoring.h"

#include <algorithm>
#include <set>

#include "regulator/profile.h"
#include "sequences/pipeline/aggregates.h"
#include "sequences/pipeline/layer_planning.h"
#include "sequences/pipeline/make_pipeline.h"
#include "sequences/pipeline/step.h"

namespace talisman::sequences {

namespace {

constexpr double kRefreshRate_per_s = 75;  // of the published machine
constexpr double kTooLate = 10;            // factor of the time by which the compositor is late

/// By id: the index of the spec that a layer, or its base, was made of; -1: of none.
std::vector<int> specs_by_id(const layers::LayerSet& set) {
  std::vector<int> specs;
  int next = 0;
  for (const layers::Layer& layer : set.layers)
    specs.push_back(layer.base >= 0 ? specs[static_cast<std::size_t>(layer.base)] : next++);
  return specs;
}

double shown_area_px(const FrameReport& report, layers::ivec2 display_px) {
  double sum = 0;
  for (const ShownSprite& sprite : report.shown) {
    layers::RectD box;
    for (const auto& corner : {layers::dvec2(0, 0), layers::dvec2(sprite.size_px.x, 0),
                               layers::dvec2(0, sprite.size_px.y), layers::dvec2(sprite.size_px)}) {
      const layers::dvec3 at = sprite.screen_from_sprite * layers::dvec3(corner, 1);
      if (at.z != 0) box.include({at.x / at.z, at.y / at.z});
    }
    box.lo = glm::max(box.lo, layers::dvec2(0));
    box.hi = glm::min(box.hi, layers::dvec2(display_px));
    sum += box.width() * box.height();
  }
  return sum;
}

}  // namespace

double PlannedFactoring::polygon_ms() const {
  return 1e3 * static_cast<double>(polygons) / regulator::talisman_1996().polygons_per_s;
}

double PlannedFactoring::pixel_ms() const {
  return 1e3 * static_cast<double>(pixels) / regulator::talisman_1996().renderer_pixels_per_s;
}

double PlannedFactoring::work_ms() const {
  const double shown_ms = 1e3 * shown_px / regulator::talisman_1996().compositor_pixels_per_s;
  const double late_ms = std::max(0.0, shown_ms - frames * 1e3 / kRefreshRate_per_s);
  return polygon_ms() + pixel_ms() + kTooLate * late_ms;
}

std::vector<layers::ExplicitPair> ids_of(std::span<const SpecPair> order, const layers::LayerSet& set) {
  std::vector<int> id_of;
  for (const layers::Layer& layer : set.layers)
    if (layer.base < 0) id_of.push_back(layer.id);
  std::vector<layers::ExplicitPair> pairs;
  for (const auto& [behind, front] : order) pairs.push_back({id_of[behind], id_of[front]});
  return pairs;
}

namespace {

/// Geometry layers, one for each spec whatever the others take, each in a group of its own.
layers::LayerSet layers_apart(const layers::Scene& scene, std::span<const layers::LayerSpec> specs) {
  layers::LayerSet all;
  for (layers::LayerSpec spec : specs) {
    spec.shading = {};
    layers::Layer layer = layers::factor(scene, std::span(&spec, 1)).layers.front();
    layer.id = static_cast<int>(all.layers.size());
    layer.group = static_cast<layers::OrderGroup>(layer.id);
    layer.holds = {};
    layer.casters.clear();
    layer.reflected.clear();
    all.layers.push_back(std::move(layer));
  }
  return all;
}

void add(const regulator::LayerDecision& decision, PlannedFactoring& plan) {
  plan.renders += decision.action == regulator::Action::Rerender;
  plan.polygons += decision.cost.polygons;
  plan.pixels += decision.cost.pixels;
}

}  // namespace

std::vector<PlannedFactoring> plans_apart(const layers::Scene& scene,
                                          std::span<const layers::LayerSpec> specs, const Settings& settings,
                                          int frames) {
  std::vector<PlannedFactoring> plans(specs.size());
  Settings own = settings;
  own.explicit_order.clear();
  const Pipeline pipeline = make_pipeline(scene, layers_apart(scene, specs), own);
  PipelineState state(pipeline);
  for (int frame = 0; frame < frames; ++frame) {
    const FrameReport report = step(pipeline, state, frame, nullptr);
    for (std::size_t i = 0; i < plans.size(); ++i) {
      ++plans[i].frames;
      add(report.plan.decisions[i], plans[i]);
    }
  }
  return plans;
}

namespace {

/// The layers without what is of no account for their order.
layers::LayerSet only_shapes(const layers::LayerSet& set) {
  layers::LayerSet shapes = set;
  for (layers::Layer& layer : shapes.layers) {
    layer.holds = {};
    layer.casters.clear();
    layer.reflected.clear();
  }
  return shapes;
}

}  // namespace

Sharing sharing_of(const layers::Scene& scene, const layers::LayerSet& set, std::span<const SpecPair> order,
                   const Settings& settings, std::span<const int> frames) {
  const std::vector<int> spec_of = specs_by_id(set);
  const int specs = spec_of.empty() ? 0 : 1 + *std::max_element(spec_of.begin(), spec_of.end());
  Sharing sharing{{}, std::vector<int>(static_cast<std::size_t>(specs))};
  if (!set.defect.empty()) return sharing;
  Settings own = settings;
  own.explicit_order = ids_of(order, set);
  const Pipeline pipeline = make_pipeline(scene, only_shapes(set), own);
  PipelineState state(pipeline);
  for (const int frame : frames) {
    begin_frame(pipeline, state, frame);
    std::set<int> shown;
    for (const layers::LayerState& layer : captured_states(pipeline, state, frame))
      if (layer.touches_display && static_cast<std::size_t>(layer.layer) < spec_of.size())
        shown.insert(spec_of[layer.layer]);
    std::set<SpecPair> shared;
    for (const Merger& merger : order_layers(pipeline, state, frame).mergers)
      for (const int a : state.layers[merger.layer].members)
        for (const int b : state.layers[merger.layer].members)
          if (spec_of[a] < spec_of[b]) shared.insert({spec_of[a], spec_of[b]});
    for (const SpecPair& pair : shared) ++sharing.frames[pair];
    for (const int spec : shown) ++sharing.frames_shown[spec];
  }
  return sharing;
}

void add_frame(const FrameReport& report, layers::ivec2 display_px, PlannedFactoring& plan) {
  ++plan.frames;
  for (const regulator::LayerDecision& decision : report.plan.decisions) add(decision, plan);
  plan.polygons += report.shade.shadow_polygons;
  plan.pixels += report.shade.shadow_pixels;
  plan.shown_px += shown_area_px(report, display_px);
}

PlannedFactoring plan_of(const layers::Scene& scene, const layers::LayerSet& set,
                         std::span<const SpecPair> order, const Settings& settings, int frames,
                         double enough_ms) {
  PlannedFactoring result;
  if (!set.defect.empty()) return result;
  Settings own = settings;
  own.explicit_order = ids_of(order, set);
  const Pipeline pipeline = make_pipeline(scene, set, own);
  PipelineState state(pipeline);
  for (int frame = 0; frame < frames && result.polygon_ms() + result.pixel_ms() <= enough_ms; ++frame)
    add_frame(step(pipeline, state, frame, nullptr), settings.view.display_px, result);
  return result;
}

}  // namespace talisman::sequences
