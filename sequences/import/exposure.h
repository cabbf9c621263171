// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How bright are the lights of a file whose units are lux and candela?
///
/// One exposure per file: the largest illuminance shows 1 on a white surface that faces it.
///
///   E = lux of a directional light;  of a point or spot  I · falloff(d),  d from the lamp to the nearest part's
///   bounds, at least 0.1 of that part's radius; of a spot, of the parts whose enclosing sphere its cone touches
///
/// All lights are divided by it, so their ratios stay. The key or option `exposure` of whoever shows the file puts
/// another illuminance in its place.

#include "sequences/import/model_import.h"

namespace talisman::sequences {

/// Leaves a scene without light as it is. What was done is a note of the model. Cost: O(vertices + lights ·
/// parts).
void expose_lights(ImportedModel& model);

}  // namespace talisman::sequences
