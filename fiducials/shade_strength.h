// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How strong should an old shadow be now?
///
/// A shadow layer (layers/shading.h) holds the share q that its light has in all light on the surface: black with
/// alpha q (1 - v), as shade and atop, or 1 - Σ q (1 - v) per channel, as multiply. A light that moves or changes
/// alters q where no shadow moves at all: a second lamp that comes near makes the shadow of the first weaker. With
/// D + S what a light gives to a point, C the colour of the point, ^ at `then`:
///
///   q = Y(D_l + S_l) / Y(C unclamped)   (Y luminance; multiply: per channel)
///   F = max over points ‖C Σ_l |q_l - q̂_l|‖,   0 … √3, linear light
///
/// that is, by how much the surface is too bright or too dark where it is in full shadow (v = 0). The points are, of a
/// flat surface, where its shadows lie now and lay then, their middles and the places half way to them; of a
/// curved one, on which anything may be in shadow, all places of fiducials/lit_places.h and the characteristic
/// points: an upper bound there.

#include "fiducials/fiducials.h"
#include "layers/layer.h"
#include "layers/polyhedron.h"

namespace talisman::fiducials {

/// `shade` is a Shadow layer, `bound` its own, with the surface of its base. Multiplier and angles are those of rest.
/// Not computed, with the reason, where the bound has no surface. Cost: O(points · lights).
Photometric shade_strength_of(const layers::LayerState& then, const layers::LayerState& now,
                              const layers::LayerBound& bound, const layers::Layer& shade);

}  // namespace talisman::fiducials
