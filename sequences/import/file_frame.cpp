// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/file_frame.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace talisman::sequences {

namespace {

using layers::dvec3;

int metadata(const aiScene& scene, const char* key, int otherwise) {
  int32_t value = otherwise;
  return scene.mMetaData && scene.mMetaData->Get(key, value) ? value : otherwise;
}

dvec3 axis(const aiScene& scene, const std::string& name, int otherwise) {
  dvec3 v(0);
  const int index = metadata(scene, name.c_str(), otherwise),
            sign = metadata(scene, (name + "Sign").c_str(), 1);
  v[std::clamp(index, 0, 2)] = sign < 0 ? -1 : 1;
  return v;
}

/// Rotates the file's up to +y and its front to +z.
glm::dquat upright(const aiScene& scene) {
  const dvec3 up = axis(scene, "UpAxis", 1), front = axis(scene, "FrontAxis", 2),
              right = glm::cross(up, front);
  if (!(glm::length(right) > 0.5)) return {1, 0, 0, 0};
  return glm::normalize(glm::quat_cast(glm::transpose(glm::dmat3(right, up, front))));
}

double metres_per_unit(const aiScene& scene) {
  double factor = 0;
  float narrow = 0;
  if (scene.mMetaData && scene.mMetaData->Get("UnitScaleFactor", narrow)) factor = narrow;
  if (scene.mMetaData && factor == 0) scene.mMetaData->Get("UnitScaleFactor", factor);
  return factor > 0 && std::isfinite(factor) ? factor / 100 : 1;
}

bool says_axes(const aiScene& scene) {
  return scene.mMetaData && scene.mMetaData->HasKey("UpAxis") && scene.mMetaData->HasKey("UnitScaleFactor");
}

}  // namespace

FileFrame file_frame(const aiScene& scene) {
  FileFrame frame;
  if (!says_axes(scene)) return frame;
  frame.transform.rotation = upright(scene);
  frame.transform.scale = dvec3(metres_per_unit(scene));
  return frame;
}

}  // namespace talisman::sequences
