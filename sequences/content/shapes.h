// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Simple bodies that a sequence file describes itself, so that a scene needs no model file: boxes, spheres,
/// cylinders (and cones), planes and discs, in one colour or with a texture.
///
/// Every shape is centred on its own origin: a box and a plane by their sizes, a cylinder along y, a plane and a
/// disc in y = 0 facing up. Meshes are watertight: vertices that lie on each other (seams, poles, edges) have
/// bit-identical positions. Texture coordinates are 0 … 1 over each face of a box, over a plane or the
/// square around a disc, around and along a cylinder, and by longitude and latitude.

#include <string>

#include "layers/scene.h"

namespace talisman::sequences {

struct ShapeContent {
  enum class Kind { Box, Sphere, Cylinder, Plane, Disc };
  Kind kind = Kind::Box;
  layers::dvec3 size_m{1, 1, 1};  ///< > 0; box: its sides; plane, disc: x and z; sphere: diameters; cylinder:
                                  ///< diameters of its bottom in x and z, and its height in y
  double taper = 1;               ///< cylinder: its top over its bottom, 0 … 1; 0 is a cone
  /// sphere, cylinder and disc: 3 … 512 around; box and plane: 1 … 512 per side; triangles grow with it (sphere, box,
  /// plane: with its square), and lights per vertex are the more exact
  int segments = 32;
  layers::Material material;
  std::string texture_file;         ///< empty: none
  std::string second_texture_file;  ///< Material::texture2, likewise
};

/// The surface in the shape's own space, counter-clockwise from outside, with normals and texture
/// coordinates.
layers::Mesh shape_mesh(const ShapeContent& shape);

}  // namespace talisman::sequences
