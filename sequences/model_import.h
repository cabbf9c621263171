// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Model files through assimp, in a child process (talisman_import, beside the tool): a hostile file can
/// crash, hang or exhaust nothing but its reader. The child sends the scene as a byte stream; the parent
/// checks every length and index again.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "layers/scene.h"
#include "sequences/errors.h"

namespace talisman::sequences {

struct ImportLimits {
  int seconds = 60;               ///< wall time of the child
  std::int64_t megabytes = 8192;  ///< address space of the child (not limited in sanitizer builds)
};

struct ImportedModel {
  layers::Scene scene;
  std::vector<std::string> warnings;  ///< missing textures
};

/// Reads a model with its materials, textures, node animation, skins, cameras and lights. Throws InputError
/// that names the file and what is wrong with it (missing, truncated, crashed its reader, took longer than …,
/// not-a-number positions, indices out of range).
ImportedModel import_model(const std::string& path, const ImportLimits& limits = {});

/// The stream between child and parent. `scene_from_bytes` throws InputError on anything malformed.
std::vector<std::uint8_t> bytes_from_scene(const layers::Scene& scene);
layers::Scene scene_from_bytes(std::span<const std::uint8_t> bytes);

/// Reads an image file into a texture (sRGB bytes). Throws InputError.
layers::Texture read_texture(const std::string& path);

}  // namespace talisman::sequences
