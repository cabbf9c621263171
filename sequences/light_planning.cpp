// SPDX-License-Identifier: Apache-2.0
#include "sequences/light_planning.h"

#include "fiducials/photometric.h"
#include "fiducials/turned_faces.h"
#include "layers/animation.h"
#include "layers/built_effects.h"
#include "layers/light_change.h"

namespace talisman::sequences {

namespace {

void name(const layers::Scene& scene, fiducials::LightRef& light) {
  if (light.index >= 0) light.name = scene.lights[light.index].name;
}

}  // namespace

void follow_light_and_faces(const layers::Scene& scene, const layers::LayerSet& layers,
                            const regulator::RegulatorOptions& options,
                            std::vector<layers::LayerBound>& bounds) {
  const bool light = regulator::follows_light(options);
  const std::vector<int> carriers = light ? layers::moving_carriers(scene) : std::vector<int>();
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    if (bounds[i].surface_why_not != layers::LayerBound{}.surface_why_not) continue;  // equipped before
    bounds[i].follows_faces = options.turned_px > 0;
    bounds[i].surface_why_not = "no option follows the light";
    if (!light) continue;
    const layers::Layer& layer = layers.layers[i];
    if (layer.base >= 0) {
      bounds[i].surface_why_not = "a shade layer follows where its term lies";
      continue;
    }
    const layers::LightChange change = layers::light_change_of(scene, layer, carriers);
    bounds[i].surface_why_not = change.why_not;
    if (!layers::is_built(layers::Effect::ColorWarp) || !change.possible()) continue;
    bounds[i].surface = layers::mean_surface(scene, layer);
    if (layer.factored.specular) bounds[i].surface->specular = layers::dvec3(0.0);  // in a sprite of its own
  }
}

void assess_light_and_faces(const Pipeline& pipeline, const layers::LayerState& then,
                            const layers::LayerState& now, fiducials::Report& report) {
  const layers::LayerBound& bound = pipeline.bounds[now.layer];
  report.photometric =
      fiducials::photometric_of(then, now, bound, {.color_warp = pipeline.settings.regulator.color_warp});
  if (report.photometric.computed) {
    name(pipeline.scene, report.photometric.color_light);
    name(pipeline.scene, report.photometric.angle_light);
  }
  if (bound.follows_faces) report.turned = fiducials::turned_faces_of(then, now, bound.hull);
}

}  // namespace talisman::sequences
