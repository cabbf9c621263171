// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/studio_cameras.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <string_view>

namespace talisman::sequences {

namespace {

constexpr unsigned kFile = 0x4D4D, kEditor = 0x3D3D, kObject = 0x4000, kCamera = 0x4700;
constexpr std::size_t kHead = 6, kCameraBytes = 8 * sizeof(float);
constexpr double kDegreesTimesLens = 2400, kDefaultFov_deg = 45, kWidestFov_deg = 170;

/// 3DS is little-endian, as every machine that this runs on.
template <typename T>
T value_at(std::string_view bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

StudioCamera camera_of(std::string_view content, const std::string& name) {
  float v[8];
  std::memcpy(v, content.data(), kCameraBytes);
  StudioCamera camera;
  camera.name = name;
  camera.eye = {v[0], v[1], v[2]};
  camera.target = {v[3], v[4], v[5]};
  camera.bank_rad = v[6] * std::numbers::pi / 180;
  const double fov_deg = kDegreesTimesLens / v[7];
  camera.fov_rad =
      (fov_deg >= 1 && fov_deg <= kWidestFov_deg ? fov_deg : kDefaultFov_deg) * std::numbers::pi / 180;
  return camera;
}

bool is_finite(const StudioCamera& c) {
  return std::isfinite(glm::length(c.eye)) && std::isfinite(glm::length(c.target)) &&
         std::isfinite(c.bank_rad);
}

/// `name`: of the object that the chunks belong to; `outer`: the chunk around them.
void collect(std::string_view chunks, unsigned outer, const std::string& name,
             std::vector<StudioCamera>& cameras) {
  while (chunks.size() >= kHead) {
    const unsigned id = value_at<std::uint16_t>(chunks, 0);
    const std::size_t length = value_at<std::uint32_t>(chunks, 2);
    if (length < kHead || length > chunks.size()) return;
    const std::string_view content = chunks.substr(kHead, length - kHead);
    chunks.remove_prefix(length);
    if ((id == kFile && outer == 0) || (id == kEditor && outer == kFile)) collect(content, id, name, cameras);
    if (id == kObject && outer == kEditor) {
      const std::size_t end = content.find('\0');
      if (end != std::string_view::npos)
        collect(content.substr(end + 1), id, std::string(content.substr(0, end)), cameras);
    }
    if (id != kCamera || outer != kObject || content.size() < kCameraBytes) continue;
    const StudioCamera camera = camera_of(content, name);
    if (is_finite(camera)) cameras.push_back(camera);
  }
}

}  // namespace

std::vector<StudioCamera> studio_cameras(const std::string& bytes) {
  std::vector<StudioCamera> cameras;
  collect(bytes, 0, {}, cameras);
  return cameras;
}

}  // namespace talisman::sequences
