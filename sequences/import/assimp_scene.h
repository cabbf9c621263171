// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The inside of talisman_import: what assimp makes of a file becomes an ImportedModel. Only this program
/// links assimp.

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include <assimp/scene.h>

#include "sequences/import/collada_maps.h"
#include "sequences/import/model_import.h"
#include "sequences/import/texture_search.h"

namespace talisman::sequences {

/// Reads the file. Throws InputError without the file's name, which the parent puts in front.
ImportedModel read_with_assimp(const ModelPlace& place);

/// What the steps of one import have in common.
struct Import {
  Import(const aiScene& scene, const ModelPlace& of, FileUses& uses) : from(scene), place(of), files(uses) {}
  const aiScene& from;
  const ModelPlace& place;
  FileUses& files;
  ImportedModel model;
  std::map<const aiNode*, int> node_of;
  std::map<std::string, int> node_named;      ///< the first of that name
  std::map<std::string, ColladaMap> collada;  ///< by material; empty for other formats
  std::map<std::string, int> texture_of;      ///< texture reference (see material_texture) → index or -1

  void warn(const std::string& text) { model.warnings.push_back(text); }
  void warn_once(const std::string& text) {
    if (std::find(model.warnings.begin(), model.warnings.end(), text) == model.warnings.end()) warn(text);
  }
};

void import_materials(Import& import);  ///< import_materials.cpp
/// By which map a material is coloured: its first one is drawn.
aiTextureType color_map_of(const aiMaterial& material);
void import_motion(Import& import);   ///< import_motion.cpp: tracks of the first animation
void import_lights(Import& import);   ///< import_motion.cpp
void import_cameras(Import& import);  ///< import_motion.cpp

inline layers::dvec3 to_vector(const aiVector3D& v) { return {v.x, v.y, v.z}; }
inline glm::dquat to_quaternion(const aiQuaternion& q) { return {q.w, q.x, q.y, q.z}; }

}  // namespace talisman::sequences
