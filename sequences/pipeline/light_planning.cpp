// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/light_planning.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "fiducials/photometric.h"
#include "fiducials/shade_drift.h"
#include "fiducials/shade_strength.h"
#include "fiducials/turned_faces.h"
#include "layers/animation.h"
#include "layers/built_effects.h"
#include "layers/light_change.h"
#include "sequences/pipeline/shade_memory.h"

namespace talisman::sequences {

namespace {

void name(const layers::Scene& scene, fiducials::LightRef& light) {
  if (light.index >= 0) light.name = scene.lights[light.index].name;
}

/// "light 'key'", "light 2".
std::string light_in_words(const layers::Scene& scene, int light) {
  const std::string& name = scene.lights[static_cast<std::size_t>(light)].name;
  return name.empty() ? "light " + std::to_string(light) : "light '" + name + "'";
}

/// Calls visit(weight over time) for the textures of a layer that the compositor blends.
template <typename Visit>
void for_each_blend(const layers::LayerSet& set, int layer, const Visit& visit) {
  const auto visit_gain = [&](const layers::Layer& held) {
    if (!held.gain.values.empty()) visit(held.gain);
  };
  visit_gain(set.layers[static_cast<std::size_t>(layer)]);
  for_each_shade(set, layer, [&](const layers::Layer& shade) {
    if (shade.kind == layers::LayerKind::Texture) visit_gain(shade);
  });
}

/// Do textures that are blended inside the layer's sprite fade into each other over time?
bool blends_vary(const layers::LayerSet& set, const layers::Layer& layer) {
  bool vary = false;
  if constexpr (layers::is_built(layers::Effect::TextureLayers))
    for (const int member : layer.members)
      for_each_blend(set, member,
                     [&](const layers::Keys<double>& blend) { vary |= blend.values.size() > 1; });
  return vary;
}

/// Of the factors of a member's textures, in all.
double change_of_blends(const layers::LayerSet& set, const layers::Layer& aggregate, double then_s,
                        double now_s) {
  double largest = 0;
  for (const int member : aggregate.members) {
    double change = 0;
    for_each_blend(set, member, [&](const layers::Keys<double>& blend) {
      change += std::fabs(layers::value_at(blend, now_s) - layers::value_at(blend, then_s));
    });
    largest = std::max(largest, change);
  }
  return largest;
}

void add_change_of_blends(const LayerTable& layers, const layers::LayerState& then,
                          const layers::LayerState& now, fiducials::Photometric& photometric) {
  const layers::Layer& layer = layers[static_cast<std::size_t>(now.layer)];
  const double change = change_of_blends(layers.set(), layer, then.time_s, now.time_s);
  double brightest = 0;
  for (const layers::dvec3& color : now.point_colors) brightest = std::max(brightest, glm::length(color));
  photometric.color += change * brightest;
}

}  // namespace

layers::LayerBound following_light_and_faces(const Pipeline& pipeline, const layers::Layer& layer,
                                             layers::LayerBound bound) {
  const regulator::RegulatorOptions& options = pipeline.settings.regulator;
  bound.follows_faces = options.thresholds.turned_px > 0;
  bound.surface.reset();
  bound.surface_why_not = "no option follows the light";
  if (!regulator::follows_light(options)) return bound;
  bound.surface_why_not = "a shade layer follows where its term lies";
  const bool is_light = layer.kind == layers::LayerKind::Light;
  const bool is_shadow = layer.kind == layers::LayerKind::Shadow;
  if (layer.base >= 0 && !is_light && !is_shadow) return bound;
  const layers::LightChange change = layers::light_change_of(pipeline.scene, layer, pipeline.moving_carriers);
  bound.surface_why_not = change.why_not;
  if (!layers::is_built(layers::Effect::ColorWarp)) return bound;
  if (!change.possible() && !blends_vary(pipeline.authored.set(), layer)) return bound;
  bound.surface = layers::mean_surface(pipeline.scene, layer);
  if (is_light) bound.surface->constant = layers::dvec3(0.0);
  if (!is_shadow)  // which has the points of its base
    layers::add_light_samples(pipeline.scene, pipeline.settings.material_points, bound);
  if (layer.factored.specular) bound.surface->specular = layers::dvec3(0.0);  // in a sprite of its own
  return bound;
}

void assess_light_and_faces(const Pipeline& pipeline, const LayerTable& layers,
                            const layers::LayerState& then, const layers::LayerState& now,
                            fiducials::Report& report) {
  const layers::Layer& layer = layers[static_cast<std::size_t>(now.layer)];
  const layers::LayerBound& bound = layers.bound(static_cast<std::size_t>(now.layer));
  report.photometric = layer.kind == layers::LayerKind::Shadow
                           ? fiducials::shade_strength_of(then, now, bound, layer)
                           : fiducials::photometric_of(
                                 then, now, bound, {.color_warp = pipeline.settings.regulator.color_warp});
  if (report.photometric.computed) {
    if (layer.is_aggregate()) add_change_of_blends(layers, then, now, report.photometric);
    name(pipeline.scene, report.photometric.color_light);
    name(pipeline.scene, report.photometric.angle_light);
  }
  if (bound.follows_faces) report.turned = fiducials::turned_faces_of(then, now, bound.hull);
}

std::string shade_in_words(const Pipeline& pipeline, const LayerTable& layers, const layers::LayerState& now,
                           const fiducials::ShadeMotion& motion) {
  using Kind = layers::ShadeTrace::Kind;
  if (motion.trace < 0 || static_cast<std::size_t>(motion.trace) >= now.traces.size())
    return "shades whose places are not known";
  const layers::ShadeTrace& trace = now.traces[static_cast<std::size_t>(motion.trace)];
  const std::string kind(fiducials::name(trace.kind));
  const std::string light = trace.light >= 0 ? light_in_words(pipeline.scene, trace.light) : "";
  if (trace.kind == Kind::Highlight) return "the highlight of " + light;
  const layers::Layer& layer = layers[static_cast<std::size_t>(now.layer)];
  const bool is_own = trace.source == layer.id || (trace.source >= 0 && trace.source == layer.base);
  const std::string whose =
      is_own ? "its own " + kind
             : "the " + kind + " of '" + layers[static_cast<std::size_t>(trace.source)].name + "'";
  return light.empty() ? whose : whose + " in " + light;
}

}  // namespace talisman::sequences
