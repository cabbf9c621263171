// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How is something shown that says nothing about it?
///
///   camera   an orbit around all parts, slightly from above; any unit scale is framed
///   lights   of a sequence: a sun and ambient light; of a bare model: a key light, and a sky of light from above and
///            from everywhere
///   stage    of a bare model without a camera of its own: a grey backdrop, before which what no light reaches is seen
///            as well; without lights of its own, too: a ground on which the key light throws the model's shadow. The
///            ground has the backdrop's colour where it is lit: but for the shadow it is not seen.

#include <vector>

#include "layers/layer.h"

namespace talisman::sequences {

/// What a sequence lacks of camera and lights. `turn_s`: one turn of the orbit, > 0.
void add_default_view(layers::Scene& scene, double turn_s);

struct ModelView {
  double turn_s = 20;      ///< > 0; one turn of the orbit
  bool stage = true;       ///< backdrop and ground, too
  double exposure_lx = 1;  ///< > 0; by which the lights that are added are divided
};

/// What a bare model lacks. Its ground becomes a layer of its own at the end of `specs`.
void add_model_view(layers::Scene& scene, std::vector<layers::LayerSpec>& specs, const ModelView& view);

/// Bounds of all parts over the scene's duration (sampled at 9 times).
layers::WorldBounds bounds_of_scene(const layers::Scene& scene);

}  // namespace talisman::sequences
