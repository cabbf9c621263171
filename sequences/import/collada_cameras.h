// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What do the cameras of a COLLADA file see? assimp takes the angle of one that says yfov alone for a default, in the
/// wrong unit, and drops the planes.
///
///   <camera id=C><optics><technique_common><perspective> xfov | yfov | xfov yfov | xfov|yfov aspect_ratio, znear, zfar
///   <node id=N> … <instance_camera url="#C"/>
///
/// Angles are degrees; aspect_ratio is that of the fields of view, x over y. An orthographic camera has xmag, ymag.
/// Source: Khronos, "COLLADA Digital Asset Schema Release 1.4.1", chapter 5 (camera, optics, perspective).

#include <optional>
#include <string>
#include <vector>

namespace talisman::sequences {

struct ColladaCamera {
  std::string node;                     ///< id, sid or name, the first that is there: as assimp names it
  double fov_y_rad = 0;                 ///< > 0; 0: says none that can be
  std::optional<double> near_m, far_m;  ///< in the file's units
  bool is_orthographic = false;
};

/// One for each node that shows a camera, in the order of the file. None of what is no XML. Where only the field across
/// is said and no aspect, the picture is taken to be as wide as high.
std::vector<ColladaCamera> collada_cameras(const std::string& text);

}  // namespace talisman::sequences
