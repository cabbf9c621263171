// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Ground out of pictures: a grey image gives heights, a class image says what lies on it, and a small tile
/// texture for each class is laid out over the ground.
///
///   height = low + (high − low) · grey, then smoothed by a Gaussian of `smooth_cells`, because the steps of
///            8-bit heights (0.5 m and more) would show as terraces
///   colour = Σ weight(class) · tile(class), in linear light; the weights are bilinear between the class
///            image's pixels, so classes blend over one cell; a slow copy of the same tile varies the
///            brightness, which hides its repetition
///
/// Each terrain tile gets its own baked texture. It reaches two cells over the tile's border, so that
/// filtering at the border never sees the other side of a texture that repeats. Baking takes about 0.2 µs per
/// texel.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "layers/terrain.h"
#include "sequences/files/errors.h"

namespace talisman::sequences {

/// A class of ground: pixels of the class image nearest to `rgb` are covered with `texture_file`.
struct GroundClass {
  std::array<int, 3> rgb{0, 0, 0};
  std::string texture_file;
};

struct TerrainContent {
  std::string name = "terrain";  ///< parts are called name/0, name/1, …
  std::string heights_file;
  double cell_m = 4;               ///< > 0; distance of samples
  double low_m = 0, high_m = 150;  ///< heights of grey 0 and of white
  int first_row = 0;        ///< ≥ 0; rows of the pictures before it are left out, and it lies at z = 0
  double smooth_cells = 1;  ///< 0 … 16; standard deviation; more rounds the rocks off
  int segments = 6;    ///< 1 … rows / 2; more of them follow parallax more closely, and are more sprites
  int across = 1;      ///< 1 … 1000; tiles side by side in each segment
  int seam_cells = 1;  ///< 0 … 64; cells by which a tile reaches over each inner border
  int every = 1;       ///< 1 … 64; samples between vertices; polygons fall with its square
  std::string classes_file;  ///< as many pixels as heights; empty: one colour
  std::string list_file;     ///< that the classes were read from; empty: none
  std::vector<GroundClass> classes;
  int texels_per_cell = 6;  ///< 1 … 32; memory and baking time grow with the square
  double tile_m = 40;       ///< > 0; side of one repetition of a class texture
};

/// Classes as Extreme Tux Racer lists them: entries `*[name] n [texture] f … [col] r g b`. Textures lie
/// beside the list.
std::vector<GroundClass> read_ground_classes(const std::string& list_file);

/// Throws InputError when the picture cannot be read or is smaller than 2 × 2.
layers::HeightField read_height_field(const TerrainContent& content);

/// Height of the ground at a place, bilinear between samples; the border's height outside.
double ground_height(const layers::HeightField& field, double x_m, double z_m);

/// Adds the segments to the scene below a new node of the content's name.
void add_terrain(layers::Scene& scene, const TerrainContent& content);

}  // namespace talisman::sequences
