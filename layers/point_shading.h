// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which colour has a point of a layer, without drawing it? Characteristic points with normals [LS97 4.3,
/// 5.2].
///
///   share of a light = base · colour                                         ambient
///                    = base · colour · max(0, N·L) + specular · colour · max(0, N·H)ⁿ      where N·L > 0
///   colour           = min(1, constant + Σ shares)        linear light, premultiplied, 1 is white
///
/// The formula of chunker/shade.h, for one surface that stands for the whole layer: the mean of the materials
/// of its parts. It is limited to 1 as the texels of a sprite are, so that what is white and gets more light
/// does not count as changed. A light that is not finite gives nothing. Normal maps are left out: with one the colour
/// of a point is an estimate of the mean about it.

#include <span>
#include <vector>

#include "layers/layer.h"

namespace talisman::layers {

/// What a layer's materials are on average, weighted by the area of their triangles. Colours are linear and
/// carry the opacity.
struct MeanSurface {
  dvec3 base{0, 0, 0};      ///< of the lit parts: base colour · vertex colour · texture
  dvec3 constant{0, 0, 0};  ///< what no light changes: emissive, and the whole colour of unlit parts
  dvec3 specular{0, 0, 0};
  double shininess = 0;  ///< Blinn-Phong exponent, weighted by the highlights' strength too
  bool has_specular() const { return specular.x > 0 || specular.y > 0 || specular.z > 0; }
  bool operator==(const MeanSurface&) const = default;
};

/// A layer without area is weighted by its triangles alike; one without triangles is black. Of a texture at
/// most 65,536 texels are read. Cost: O(triangles + texels), once per layer.
MeanSurface mean_surface(const Scene& scene, const Layer& layer);

/// A point with a normal of unit length, or zero (ambient light only), in the world, and who looks at it.
struct SurfacePoint {
  dvec3 position{0, 0, 0};
  dvec3 normal{0, 0, 0};
  dvec3 eye{0, 0, 0};
};

/// What one light adds to the colour of the point. Cost: 20 ns, with specular 50 ns.
dvec3 share_of_light(const MeanSurface& surface, const LightState& light, const SurfacePoint& point);

/// The colour of the point under all lights, each channel 0 … 1.
dvec3 shaded_color(const MeanSurface& surface, std::span<const LightState> lights, const SurfacePoint& point);

}  // namespace talisman::layers
