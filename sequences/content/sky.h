// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A sky that stands still in the world: a patch of a sphere (dome) or a flat picture (backdrop), unlit, with
/// a vertical gradient and clouds baked into one texture. Azimuth 0 is -z, positive to the right (+x);
/// elevation 0 is the horizon.

#include <string>

#include "layers/scene.h"
#include "sequences/files/errors.h"

namespace talisman::sequences {

struct SkyContent {
  enum class Kind { Dome, Backdrop } kind = Kind::Dome;
  std::string name = "sky";
  layers::dvec3 center{0, 0, 0};             ///< metres; where azimuth and elevation are measured
  double radius_m = 10000;                   ///< > 0; of the dome, or distance of the backdrop
  layers::dvec2 azimuth_deg{-90, 90};        ///< from, to; a backdrop spans less than 180
  layers::dvec2 elevation_deg{-10, 60};      ///< from, to; within -90 … 90
  layers::vec3 horizon{0.75f, 0.82f, 0.9f};  ///< linear colour at elevation 0 and below
  layers::vec3 zenith{0.1f, 0.25f, 0.6f};    ///< linear colour at the patch's upper end
  std::string clouds_file;                   ///< grey or alpha is the clouds' cover, tiled; empty: none
  double cloud_cover = 0.7;                  ///< 0 … 1; opacity of the densest cloud
  double clouds_m = 6000;           ///< > 0; side of one tile, on a plane `cloud_height_m` above the centre
  double cloud_height_m = 1500;     ///< > 0
  layers::ivec2 texels{1024, 512};  ///< 2 … 4096 each
};

/// Adds node, mesh, material, texture and part, all with the content's name. Throws InputError when the
/// clouds cannot be read.
void add_sky(layers::Scene& scene, const SkyContent& content);

}  // namespace talisman::sequences
