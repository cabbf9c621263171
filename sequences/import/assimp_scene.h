// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The inside of talisman_import: what assimp makes of a file becomes an ImportedModel. Only this program
/// links assimp.

#include <map>
#include <set>
#include <string>

#include <assimp/scene.h>

#include "sequences/import/model_import.h"

namespace talisman::sequences {

/// Reads the file. Throws InputError without the file's name, which the parent puts in front.
ImportedModel read_with_assimp(const std::string& path);

/// What the steps of one import have in common.
struct Import {
  Import(const aiScene& scene, std::string file, bool gltf, FileUses& uses)
      : from(scene), path(std::move(file)), is_gltf(gltf), files(uses) {}
  const aiScene& from;
  std::string path;
  bool is_gltf;  ///< colours are linear and cones measured from the axis; otherwise sRGB, and whole cones
  FileUses& files;
  ImportedModel model;
  std::map<const aiNode*, int> node_of;
  std::map<std::string, int> node_named;  ///< the first of that name
  std::map<std::string, int> texture_of;  ///< texture reference (see material_texture) → index or -1

  void warn(const std::string& text) { model.warnings.push_back(text); }
};

void import_materials(Import& import);  ///< import_materials.cpp
void import_motion(Import& import);     ///< import_motion.cpp: tracks of the first animation
void import_lights(Import& import);     ///< import_motion.cpp
void import_cameras(Import& import);    ///< import_motion.cpp

/// The file that a model means by a texture's name: as written, relative to the model, by its base name
/// beside the model and in ../textures and ./textures, in any letter case, with the stem cut to 8 characters,
/// and at last with another extension. Empty if there is none.
std::string find_texture(const std::string& model_path, const std::string& written, FileUses& files);

inline layers::dvec3 to_vector(const aiVector3D& v) { return {v.x, v.y, v.z}; }
inline glm::dquat to_quaternion(const aiQuaternion& q) { return {q.w, q.x, q.y, q.z}; }

}  // namespace talisman::sequences
