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

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "layers/layer.h"

namespace talisman::sequences {

/// A camera that goes round about y and looks at a place.
struct Orbit {
  layers::dvec3 center{0, 0, 0};  ///< metres
  double distance_m = 5;          ///< > 0
  double elevation_rad = 0;       ///< -π/2 … π/2; above the centre's height
  double turn_s = 5;              ///< > 0; one turn
  double fov_y_rad = 0.7, near_m = 0.1, far_m = 1e4;
};

/// An orbit around all parts. `turn_s` > 0.
Orbit orbit_around(const layers::Scene& scene, double turn_s);
void add_orbit(layers::Scene& scene, const Orbit& orbit);

/// What a sequence lacks of camera and lights. `turn_s`: one turn of the orbit, > 0.
void add_default_view(layers::Scene& scene, double turn_s);

struct ModelView {
  double turn_s = 20;      ///< > 0; one turn of the orbit
  bool stage = true;       ///< backdrop and ground, too
  double exposure_lx = 1;  ///< > 0; by which the lights that are added are divided
};

/// A disc that faces up, on which the shadow falls.
struct StageGround {
  layers::dvec3 place{0, 0, 0};  ///< of its middle
  double radius_m = 1;
  int segments = 48;         ///< around it
  layers::vec3 color{0.5f};  ///< linear light
};

/// What is added to a bare model: each is empty where the model has its own, or it was not asked for.
struct ModelStage {
  std::optional<Orbit> orbit;
  std::vector<layers::Light> lights;  ///< for an exposure of 1
  std::optional<layers::vec3> backdrop;
  std::optional<StageGround> ground;
};
ModelStage model_stage(const layers::Scene& scene, const ModelView& view);

/// What a bare model lacks. Its ground becomes a layer of its own at the end of `specs`.
void add_model_view(layers::Scene& scene, std::vector<layers::LayerSpec>& specs, const ModelView& view);

/// `name` with as many "'" behind it as make it another than those that are used.
std::string unused_name(const std::set<std::string>& used, std::string name);

/// Of the part's vertices in the world; empty without any.
layers::WorldBounds bounds_of_part(const layers::SceneFrame& frame, const layers::Part& part);
/// Grows `bounds` so that it holds `more` too.
void include(layers::WorldBounds& bounds, const layers::WorldBounds& more);
/// Bounds of all parts over the scene's duration (sampled at 9 times).
layers::WorldBounds bounds_of_scene(const layers::Scene& scene);

}  // namespace talisman::sequences
