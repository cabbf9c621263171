// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The few scenes in which hard cases are drawn, and how their pictures are compared.

#include <vector>

#include "chunker/multipass.h"
#include "chunker/render.h"
#include "layers/layer.h"
#include "layers/scene.h"

namespace talisman::sequences {

/// One camera at the origin that looks along -z, `fov_rad` high, and nothing else.
layers::Scene hard_view(double fov_rad = 1.5707963267948966, double near_m = 0.01);

/// Adds a part with a node of its own, and returns its index.
int add_hard_part(layers::Scene& scene, layers::Mesh mesh, const layers::Material& material,
                  layers::dvec3 position = {0, 0, 0});

/// One triangle that fills a square display seen under 90°, `depth_m` before the eye and facing it: each texel is shaded
/// once, at its centre. Its coordinates are 0 … `repeats` over the display.
layers::Mesh filling_triangle(double depth_m, double repeats = 1);
/// A square in y = 0 that faces up.
layers::Mesh level_square(double side_m);

layers::Material hard_material(layers::vec3 color);

/// A scene with everything: a checkered floor, a box that spins, a ball that circles it, an ambient light, a sun that
/// casts shadows, a lamp with a range, a camera that flies past for 4 s. `scale`: of every length. `origin`: where it lies,
/// in its own units.
layers::Scene hard_world(double scale = 1, layers::dvec3 origin = {0, 0, 0});

/// One layer per part.
layers::LayerSet layers_of_parts(const layers::Scene& scene);

/// All parts on a display of `size`, texel on pixel, at `t_s`. With shadows where lights cast them.
struct HardPicture {
  chunker::LinearImage linear;
  chunker::Sprite sprite;
  chunker::Sprite reference;  ///< of the slow renderer; only where asked for
};
HardPicture draw_hard(const layers::Scene& scene, layers::ivec2 size,
                      const chunker::RenderOptions& options = {}, bool with_reference = false,
                      double t_s = 0);

/// Nothing merges: the fast renderer then must equal the slow one.
chunker::RenderOptions unmerged();

/// Largest difference of any channel, code values; of sprites of one size.
int largest_code_difference(const chunker::Sprite& a, const chunker::Sprite& b);
/// The share of the texels in which some channel differs by more than `allowed` code values.
double share_that_differs(const chunker::Sprite& a, const chunker::Sprite& b, int allowed);

}  // namespace talisman::sequences
