// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Small workloads, defined once for tests, benchmarks and the tool's experiments.
///
/// Every function returns a complete scene without defects: a camera that sees the content, an ambient and a
/// directional light, parts named as layers/scene.h says. Units are metres and seconds. All scenes are
/// watertight: vertices that lie on each other (texture seams, poles) have bit-identical positions.

#include <vector>

#include "layers/layer.h"
#include "layers/scene.h"

namespace talisman::tests {

// --- Meshes
// -------------------------------------------------------------------------------------------------

/// A cube around the origin: 24 vertices, 12 triangles, flat normals, each face with uv 0 … 1.
layers::Mesh cube_mesh(double side_m = 1);

/// A square in the plane z = 0 that faces +z: cells² · 2 triangles, uv 0 … `repeats` with v downwards.
layers::Mesh quad_mesh(double side_m = 1, int cells = 1, double repeats = 1);

/// A sphere of latitude-longitude cells: rings · segments cells, 2 · segments · (rings − 1) triangles.
/// rings ≥ 2, segments ≥ 3. `bumps_m` is the amplitude of a smooth displacement along the radius, 0: a true
/// sphere.
layers::Mesh sphere_mesh(int rings, int segments, double radius_m = 1, double bumps_m = 0);

/// A checkerboard of sRGB 230 and 60 greys, cells · texels_per_cell texels on each side.
layers::Texture checker_texture(int cells = 8, int texels_per_cell = 8);

// --- Scenes
// -------------------------------------------------------------------------------------------------

/// One grey unit cube at rest, seen from 4 m in front and a little above. Part "cube".
layers::Scene cube_scene();

/// One checkered square of 2 m that faces the camera from 3 m away: perspective has no foreshortening. Part
/// "quad".
layers::Scene textured_quad_scene();

/// A smooth, textured sphere of radius 1 m, 24 × 48 cells. Part "sphere".
layers::Scene sphere_scene();

/// A sphere with bumps of about `triangles` triangles (nearest latitude-longitude grid: 0.5 % off at 10,000,
/// less above; at least 8), turning about y at 0.5 rad/s. For benchmarks. Part "ball".
layers::Scene displaced_sphere_scene(int triangles);

/// A checkered ground at rest, a cube that spins in place and a sphere that orbits it, seen by a camera that
/// flies past for 4 s with its eye on the cube. Parts "ground", "cube", "orbit/moon".
layers::Scene moving_scene();

/// A bar of 2 m that bends at its middle by 60° and back in 2 s: two joints, linear-blend weights. Part
/// "bar".
layers::Scene skinned_bar_scene();

/// The same scene with every length multiplied by `factor` > 0: it must look the same from its camera.
layers::Scene scaled(layers::Scene scene, double factor);

/// moving_scene at a scale of 1e-4 and of 1e6.
layers::Scene tiny_scene();
layers::Scene huge_scene();

/// One layer per part, in the order and with the names of the parts.
std::vector<layers::LayerSpec> one_layer_per_part(const layers::Scene& scene);

}  // namespace talisman::tests
