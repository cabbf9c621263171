// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Model files in a child process (talisman_import, beside the tool): a hostile file can
/// crash, hang or exhaust nothing but its reader. The child sends the model as a byte stream
/// (scene_stream.h); the parent checks every length and every index again.
///
/// What is made of a file:
///   readers    glTF 2 and OBJ by their own (gltf_scene.h, obj_scene.h), everything else by assimp
///   geometry   triangles; where the file has no normals flat ones (glTF) or smooth ones (others); points and
///              lines are not drawn, which is said
///   colours    linear light; glTF is linear already, other formats are taken as sRGB, vertex colours too
///   places     metres, y up: FBX axes and units are applied; an OBJ far from its origin is read around a
///              local one (obj_scene.h)
///   PBR        pbr_surface.h; metalness and occlusion maps in the colour texture (gltf_baked_maps.h), roughness
///              maps as their mean; emissive maps; normal maps of glTF, with the file's tangents or those of
///              the texture coordinates (layers/tangents.h); of other formats they are not drawn, which is said
///   compressed meshopt and draco (gltf_compression.h)
///   textures   embedded, or found by the rules of texture_search.h; one that is not found is a warning and a
///              plain colour
///   motion     the first animation, ticks → seconds, looping; morph targets of glTF
///   lights     directional, point, spot (angles of glTF are from the axis, those of other formats of the
///              whole cone), ambient. Where lights fade with distance one exposure for all (exposure.h); where
///              none does and one is brighter than 1 all are divided by the brightest
///   layers     the key "layer" of a glTF node's extras is kept as a LayerTag

#include <cstdint>
#include <string>
#include <vector>

#include "layers/scene.h"
#include "sequences/files/errors.h"
#include "sequences/files/file_uses.h"

namespace talisman::sequences {

struct ImportLimits {
  int seconds = 60;               ///< ≥ 1; processor time of the child; it is waited for ten times as long
  std::int64_t megabytes = 8192;  ///< ≥ 64; address space of the child (not limited in sanitizer builds)
};

/// The limits of this program, which readers deep inside ask: the defaults until `use_import_limits`, which is called
/// before anything is read. The options --import-limit-s and --import-memory-mb set them.
const ImportLimits& import_limits();
void use_import_limits(const ImportLimits& limits);

/// The author's wish, written into the model file: this node and what is below it belong to that layer.
struct LayerTag {
  int node = -1;
  std::string layer;
};

struct ImportedModel {
  layers::Scene scene;
  std::vector<std::string> warnings;  ///< missing textures and what else the picture will lack
  std::vector<std::string> notes;     ///< what was decided where the file leaves it open
  std::vector<LayerTag> layer_tags;
  std::vector<FileUse> files = {};  ///< all that the reader asked of the file system
  double exposure_lx = 1;           ///< > 0; all lights were divided by it (exposure.h)
};

/// The files that were read for it: the model itself, parts of it, its textures.
std::vector<std::string> files_read(const ImportedModel& model);

/// Reads a model with its materials, textures, node animation, skins, cameras and lights. Throws InputError
/// that names the file and what is wrong with it (missing, truncated, crashed its reader, took longer than …,
/// not-a-number positions, indices out of range). Cost: a process start (about 0.4 s, nearly all of it for
/// loading what the image library depends on) and two copies of the scene; less where the program's cache knows
/// the model (model_cache.h).
/// `folders`: in whose trees files that the model names may lie too (texture_search.h).
ImportedModel import_model(const std::string& path, const ImportLimits& limits = import_limits(),
                           const std::vector<std::string>& folders = {});

}  // namespace talisman::sequences
