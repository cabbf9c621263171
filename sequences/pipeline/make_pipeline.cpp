// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/make_pipeline.h"

#include <utility>

#include "layers/advance.h"
#include "layers/animation.h"
#include "layers/effects.h"
#include "layers/polyhedron.h"
#include "sequences/pipeline/culling/culling.h"
#include "sequences/pipeline/latency/late_camera.h"
#include "sequences/pipeline/light_planning.h"
#include "sequences/pipeline/refresh/refresh.h"

namespace talisman::sequences {

Pipeline make_pipeline(const layers::Scene& scene, layers::LayerSet layers, const Settings& settings) {
  Pipeline pipeline{scene,
                    settings,
                    {},
                    {},
                    layers::calls_for_visibility_sort(layers.layers),
                    std::make_shared<const layers::SceneMotion>(scene),
                    nullptr,
                    regulator::is_late(settings.regulator.latency) ? camera_alone(scene) : nullptr};
  if (regulator::follows_light(settings.regulator)) pipeline.moving_carriers = layers::moving_carriers(scene);
  BoundTable bounds;
  for (const layers::Layer& layer : layers.layers)
    bounds.put(layer.id, following_light_and_faces(pipeline, layer,
                                                   layers::make_layer_bound(scene, layer, settings.bound,
                                                                            settings.material_points)));
  pipeline.authored = {std::move(layers), std::move(bounds)};
  if (regulator::refreshes_chunks(settings.regulator))
    pipeline.contents = std::make_shared<const std::vector<regulator::LayerContent>>(
        layer_contents(scene, pipeline.authored));
  if (settings.visibility.any())
    pipeline.culling = std::make_shared<const Culling>(scene, pipeline.authored, settings);
  return pipeline;
}

}  // namespace talisman::sequences
