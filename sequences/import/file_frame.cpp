// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/file_frame.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include <assimp/MemoryIOWrapper.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "sequences/import/recorded_files.h"

namespace talisman::sequences {

namespace {

using layers::dvec3;

/// Coordinates larger than this many sizes keep fewer than 13 bits for the size in a float.
constexpr double kFarAway = 2000;

/// Answers one path with other bytes than the file has.
class ChangedFile : public RecordedFiles {
 public:
  ChangedFile(const ModelPlace& model, FileUses& files, std::string content)
      : RecordedFiles(model, files), path_(model.path), content_(std::move(content)) {}
  Assimp::IOStream* Open(const char* file, const char* mode = "rb") override {
    if (path_ != file) return RecordedFiles::Open(file, mode);
    return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(content_.data()),
                                      content_.size());
  }

 private:
  std::string path_, content_;
};

bool is_obj(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension == ".obj";
}

/// The place of a line "v x y z …", and where the numbers end; false for other lines.
bool read_vertex(const std::string& line, dvec3& p, std::size_t& end) {
  std::size_t at = line.find_first_not_of(" \t");
  if (at == std::string::npos || line[at] != 'v' || at + 1 >= line.size() ||
      (line[at + 1] != ' ' && line[at + 1] != '\t'))
    return false;
  ++at;
  for (int k = 0; k < 3; ++k) {
    at = line.find_first_not_of(" \t", at);
    if (at == std::string::npos) return false;
    const auto [next, error] = std::from_chars(line.data() + at, line.data() + line.size(), p[k]);
    if (error != std::errc() || !std::isfinite(p[k])) return false;
    at = static_cast<std::size_t>(next - line.data());
  }
  end = at;
  return true;
}

std::string text_of_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// The middle of all vertices, where they lie far from the file's origin; else zero.
dvec3 local_origin(const std::string& text) {
  dvec3 lo(HUGE_VAL), hi(-HUGE_VAL), p;
  std::size_t end = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (read_vertex(line, p, end)) lo = glm::min(lo, p), hi = glm::max(hi, p);
  if (!(lo.x <= hi.x)) return dvec3(0);
  const double size = glm::length(hi - lo), away = glm::length(glm::max(glm::abs(lo), glm::abs(hi)));
  return size > 0 && away > kFarAway * size ? glm::round(0.5 * (lo + hi)) : dvec3(0);
}

std::string moved_to(const dvec3& origin, const std::string& text) {
  std::string moved;
  moved.reserve(text.size());
  std::istringstream lines(text);
  dvec3 p;
  std::size_t end = 0;
  for (std::string line; std::getline(lines, line); moved += '\n') {
    if (!read_vertex(line, p, end)) {
      moved += line;
      continue;
    }
    moved += 'v';
    for (int k = 0; k < 3; ++k) {
      char number[32];
      const auto written = std::to_chars(number, number + sizeof number, p[k] - origin[k]);
      moved.append(" ").append(number, written.ptr);
    }
    moved += line.substr(end);
  }
  return moved;
}

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

dvec3 use_local_origin(Assimp::Importer& importer, const ModelPlace& model, FileUses& files) {
  if (!is_obj(model.path)) return dvec3(0);
  files.look_for(model.path);
  const std::string text = text_of_file(model.path);
  const dvec3 origin = local_origin(text);
  if (origin != dvec3(0)) importer.SetIOHandler(new ChangedFile(model, files, moved_to(origin, text)));
  return origin;
}

FileFrame file_frame(const aiScene& scene, const dvec3& origin) {
  FileFrame frame;
  frame.transform.translation = origin;
  if (!says_axes(scene)) return frame;
  frame.transform.rotation = upright(scene);
  frame.transform.scale = dvec3(metres_per_unit(scene));
  return frame;
}

}  // namespace talisman::sequences
