// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Places on a layer at which its light is compared, beside its characteristic points: the material points
/// (layers/surface_samples.h) and, of each light that moves against a body, what it draws there then and now
/// (layers/light_places.h), carried by the motion of the body. Only what is on the display now counts.

#include <vector>

#include "fiducials/fiducials.h"
#include "layers/polyhedron.h"

namespace talisman::fiducials {

/// A material place as it is shaded in the two states.
struct LitPair {
  layers::SurfacePoint then, now;
  dvec3 then_color{0, 0, 0}, now_color{0, 0, 0};
};

/// Empty where the bound has no surface. Cost: O(material points + lights that move · triangles · rays).
std::vector<LitPair> lit_pairs(const layers::LayerState& then, const layers::LayerState& now,
                               const layers::LayerBound& bound);

/// The light whose share at the place a multiplier of the old colours follows worst: an index, or LightRef::kNone.
int light_that_changed(const layers::LayerState& then, const layers::LayerState& now,
                       const layers::MeanSurface& surface, const layers::SurfacePoint& then_at,
                       const layers::SurfacePoint& now_at, const dvec3& multiplier);

/// Where a point of the world is on the display; what is not before the eye: the middle of the layer.
dvec2 place_on_display(const layers::LayerState& state, const dvec3& position);

}  // namespace talisman::fiducials
