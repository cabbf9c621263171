// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How does a spot fade between its inner and its outer cone?
///
/// With t = (cos θ - cos outer) / (cos inner - cos outer), clamped to 0 … 1:
///
///   of an author      t² (3 - 2 t)    smooth at both cones
///   of a foreign file t²              as KHR_lights_punctual has it; known by its 1/d², which no key gives
///
/// The second is darker by up to 0.3 of the full light (0.44 instead of 0.74 at t = 2/3).

#include <cmath>

#include "layers/scene.h"

namespace talisman::layers {

/// t² (constant - slope · t).
struct ConeRamp {
  double constant = 3, slope = 2;
  double at(double t) const { return t * t * (constant - slope * t); }
  /// The t at which half of the light is left.
  double half() const { return slope == 0 ? std::sqrt(0.5) : 0.5; }
};

inline ConeRamp cone_ramp(const LightState& light) {
  return light.attenuation == dvec3(0, 0, 1) ? ConeRamp{1, 0} : ConeRamp{};
}

}  // namespace talisman::layers
