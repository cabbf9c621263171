// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where do the cameras of a 3DS file stand, and where do they look? assimp reads that and drops it again.
///
///   chunk: id (2 bytes), length with this head (4 bytes), content; in 0x4D4D and 0x3D3D lie objects, 0x4000: a name up to
///   a zero byte, then chunks; of a camera 0x4700: eye x y z, target x y z, bank (degrees), lens (mm), all floats
///
/// z is up. The lens is that of a film on which 2400 / lens degrees are seen across (lib3ds: camera.c).
/// Source: M. Rosenfelder, "3D Studio file format", 1994.

#include <string>
#include <vector>

#include "layers/scene.h"

namespace talisman::sequences {

struct StudioCamera {
  std::string name;
  layers::dvec3 eye{0}, target{0};  ///< in the file's units and axes
  double bank_rad = 0;              ///< counter-clockwise about the way it looks
  double fov_rad = 0;               ///< across
};

/// Those of the bytes of a file; chunks that reach beyond their parent are left out with what follows them.
std::vector<StudioCamera> studio_cameras(const std::string& bytes);

}  // namespace talisman::sequences
