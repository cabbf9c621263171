// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What is a surface of metalness m and roughness r, GGX over Lambert (glTF 2.0, appendix B), in a shading that has
/// one Lambert colour for all light and one Blinn-Phong highlight?
///
///   colour     base · (1 − m + 0.45 m²)                a metal mirrors what surrounds it, of which ambient light is all
///                                                      that we know: about half of it is left as if it were Lambert
///   highlight  F · min(2.5, (n + 2) / 8) · (1 − r²)    F = mix(dielectric, base, m), the reflectance at normal
///                                                      incidence; (n + 2) / 8 makes a lobe of exponent n as bright
///                                                      in its middle as GGX
///   exponent   n = 2 / r⁴ − 2, from 1 to 1024          the lobe of about the same width
///
/// The numbers 0.45, 2.5 and r² were chosen for the least mean error in sRGB over a grid of m and r
/// (docs/models.md has it).

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include "layers/scene.h"
#include "sequences/import/limits.h"

namespace talisman::sequences {

struct PbrSurface {
  layers::vec3 color{0}, specular{0};
  float shininess = 1;
};

/// The share of the base colour that a surface of metalness 0 … 1 shows under light from everywhere.
inline double pbr_color_share(double metallic) { return 1 - metallic + 0.45 * metallic * metallic; }

/// `roughness` and `metallic` are clamped to 0 … 1. `dielectric`: reflectance of what is no metal.
inline PbrSurface pbr_surface(const layers::vec3& base, const layers::vec3& dielectric, double metallic,
                              double roughness) {
  const double m = std::clamp(metallic, 0.0, 1.0), r = std::clamp(roughness, 0.05, 1.0);
  const double exponent = std::clamp(2 / std::pow(r, 4.0) - 2, 1.0, double{kMaxShininess});
  const double strength = std::min(2.5, (exponent + 2) / 8) * (1 - r * r);
  return {base * static_cast<float>(pbr_color_share(m)),
          glm::mix(dielectric, base, static_cast<float>(m)) * static_cast<float>(strength),
          static_cast<float>(exponent)};
}

}  // namespace talisman::sequences
