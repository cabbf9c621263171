// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What moves in the comparison of warps, and how? [LS97 4.2]
///
/// The objects of the paper's experiment are a teapot and the same teapot scaled to 5 % "along its axis of
/// bilateral symmetry": across the mirror plane that handle and spout lie in. Beside them two round bodies, a
/// thin one, and three that need no content at all. Only the characteristic polyhedron of an object matters
/// for the update rates; its triangles are for the pictures.
///
/// Every object is centred at the origin with its farthest vertex at a distance of 1 m (a flattened object
/// keeps the scale of the one it comes from), and stands with y up. The camera looks along -z from the origin
/// with a vertical field of view of 45°; unless a motion says otherwise the object is at (0, 0, -5), where it
/// is about 500 of 1024 pixels across.

#include <optional>
#include <string>
#include <vector>

#include "layers/scene.h"

namespace talisman::sequences {

struct WarpObject {
  std::string name;   ///< as on the command line: "teapot", "flat-teapot", …
  std::string title;  ///< in figures
  layers::Mesh mesh;  ///< with normals; with uvs where a checker pattern is put on
};

/// An object whose content is not there, and what to do about it.
struct MissingObject {
  std::string name, why;
};

/// Names in the order of the report: teapot, flat-teapot, bunny, asteroid, fighter, vase, box, flat-box.
std::vector<std::string> warp_object_names();

/// One of these, or the object in a file: BEZ patches, or a model that the importer reads. Throws InputError:
/// no such name or file, or (missing content) with the command that fetches it.
WarpObject load_warp_object(const std::string& name_or_file);

/// All objects whose content is there; the others are named in `missing`.
std::vector<WarpObject> load_warp_objects(std::vector<MissingObject>& missing);

/// Geomview's BEZ format with its header BBP: bicubic Bézier patches of 16 points in space each, as plain
/// text [geomview manual, "BEZ"]. Each patch becomes cells² · 2 triangles, uv 0 … 1 over the patch; z is
/// taken as up. Throws InputError: another header, no patch, a half patch, a number that is not finite.
layers::Mesh read_bezier_patches(const std::string& file, int cells = 8);

/// One way to move. Times run from 0 to kMotion_s.
struct WarpMotion {
  std::string name;                   ///< "rotate-translate", "head-turn", "translate", "spin-x-5", …
  std::string title;                  ///< in words
  std::vector<layers::Track> tracks;  ///< of kObjectNode and kCameraNode
};

inline constexpr int kCameraNode = 0, kObjectNode = 1;
inline constexpr double kMotion_s = 10, kMotion_fps = 30;
inline constexpr int kMotion_frames = 300;

/// Rotating and translating first, which is the paper's figure; then head turning, translation, and rotation
/// about x, y and z at 5, 20 and 80 degrees per second (0.17, 0.67 and 2.7 degrees per frame).
std::vector<WarpMotion> warp_motions();

/// The scene of one object in one motion: nodes "camera" and "object", an ambient and a directional light.
layers::Scene stage(const WarpObject& object, const WarpMotion& motion);

}  // namespace talisman::sequences
