// SPDX-License-Identifier: Apache-2.0
#pragma once

/// STL and PLY hold surfaces alone. What becomes of them is one for both:
///
///   sides    both are drawn: the formats' programs wind triangles as they like; where all corners of one have normals
///            that point to its other side, it is turned over
///   normals  the file's; without any, or of no length: the mean of the triangles around the place
///   look     a grey of 0.6 in sRGB; white where vertices have colours or there is a picture
///   places   far from the file's origin they are kept around a local one, which a node puts back

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "layers/scene.h"
#include "sequences/import/model_import.h"
#include "sequences/import/texture_search.h"

namespace talisman::sequences {

/// Arrays of vertices are empty or as long as `positions`.
struct BareSurface {
  std::string name;  ///< empty: that of the file
  std::vector<layers::dvec3> positions;
  std::vector<layers::vec3> normals;
  std::vector<layers::vec2> uvs;
  std::vector<layers::vec3> colors;  ///< linear
  std::vector<float> alphas;         ///< only with colours
  std::vector<std::uint32_t> indices;
};

/// Vertices at one place have one number, from 0 in the order of their first. Cost: O(n).
std::vector<std::uint32_t> place_numbers(std::span<const layers::dvec3> positions);

/// The middle of a box, where it lies so far from 0 that a float would lose what is in it; else zero.
layers::dvec3 local_origin(const layers::dvec3& lo, const layers::dvec3& hi);

/// Turns over the last triangle of a mesh where all its corners have normals on its other side.
void turn_last_to_normals(layers::Mesh& mesh);

/// The grey.
layers::Material bare_look();

/// A part for each surface that has triangles, all of one look. Throws InputError where none has.
void add_surfaces(const ModelPlace& place, const std::vector<BareSurface>& surfaces,
                  const layers::Material& look, layers::Scene& scene);

}  // namespace talisman::sequences
