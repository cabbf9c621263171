// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What do the materials of an OBJ file look like? A library (MTL) is lines "KEYWORD VALUES"; "newmtl NAME" begins one.
///
///   drawn     Kd, Ks, Ke (r g b in sRGB, r alone: g = b = r, or "xyz x y z"), Ns, d, Tr = 1 - d, Pr and Pm;
///             illum 0: the colour as it is, 1: no highlight; map_Kd with -s, -o: u' = s u + o, and -clamp
///   named     every other map, and options of map_Kd that change the picture; reflection, refraction
///   odd       a line whose values are not what its keyword takes is named with file, line and material, and left out
///
/// Ka is taken for Kd. Source: Wavefront, "MTL material format" (1995); Pr and Pm: the extension of 2013.

#include <map>
#include <string>
#include <vector>

#include "layers/scene.h"

namespace talisman::sequences {

/// How map_Kd lies on its surface, in the coordinates of the file (v grows upwards).
struct MapPlacing {
  layers::vec2 scale{1, 1}, offset{0, 0};
  bool clamped = false;
};

struct ObjMaterial {
  layers::Material look;  ///< without its texture
  std::string map;        ///< map_Kd as it is written; empty: none
  MapPlacing placing;
  std::vector<std::string> losses;  ///< what it says and the picture has not, each once
};

/// What is drawn where no library has the material.
ObjMaterial default_obj_material();

/// Those of one library, by name. What two of one name say is one material. Throws nothing.
std::map<std::string, ObjMaterial> read_obj_materials(const std::string& path);

}  // namespace talisman::sequences
