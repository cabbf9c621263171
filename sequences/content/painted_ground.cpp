// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/painted_ground.h"

#include <cstring>
#include <optional>
#include <span>

#include "sequences/files/cache.h"
#include "sequences/files/loaded_code.h"

namespace talisman::sequences {

namespace {

constexpr const char* kGroundKind = "ground";

std::optional<ContentHash> key_of(const TerrainContent& content, const layers::HeightField& field,
                                  const std::vector<GroundWindow>& windows) {
  const auto classes = hash_of_file(content.classes_file);
  if (!classes) return std::nullopt;
  ContentHasher hasher;
  hasher.add(kGroundKind).add(hash_of_loaded_code()).add(*classes);
  for (const GroundClass& ground : content.classes) {
    for (const int value : ground.rgb) hasher.add(value);
    // The tile of a class that does not occur is not asked for, and may be missing.
    const auto tile = hash_of_file(ground.texture_file);
    hasher.add(tile.has_value()).add(tile.value_or(ContentHash{}));
  }
  hasher.add(field.columns).add(field.rows).add(content.first_row).add(content.texels_per_cell);
  hasher.add(content.cell_m).add(content.tile_m);
  for (const GroundWindow& window : windows)
    hasher.add(window.first_column).add(window.first_row).add(window.columns).add(window.rows);
  return hasher.hash();
}

std::vector<std::uint8_t> bytes_of(const std::vector<layers::Texture>& textures) {
  std::vector<std::uint8_t> bytes;
  for (const layers::Texture& texture : textures) {
    const std::int32_t size[2] = {texture.width, texture.height};
    const auto* head = reinterpret_cast<const std::uint8_t*>(size);
    bytes.insert(bytes.end(), head, head + sizeof size);
    bytes.insert(bytes.end(), texture.rgba.begin(), texture.rgba.end());
  }
  return bytes;
}

/// Empty if the bytes are not as many textures of the right size.
std::vector<layers::Texture> textures_of(std::span<const std::uint8_t> bytes,
                                         const std::vector<GroundWindow>& windows, int texels_per_cell) {
  std::vector<layers::Texture> textures;
  for (const GroundWindow& window : windows) {
    std::int32_t size[2];
    if (bytes.size() < sizeof size) return {};
    std::memcpy(size, bytes.data(), sizeof size);
    bytes = bytes.subspan(sizeof size);
    const std::size_t count = 4 * static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]);
    if (size[0] != window.columns * texels_per_cell || size[1] != window.rows * texels_per_cell ||
        count > bytes.size())
      return {};
    layers::Texture& texture = textures.emplace_back();
    texture.width = size[0];
    texture.height = size[1];
    texture.rgba.assign(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
    bytes = bytes.subspan(count);
  }
  return bytes.empty() ? textures : std::vector<layers::Texture>();
}

}  // namespace

std::vector<layers::Texture> painted_ground(const TerrainContent& content, const layers::HeightField& field,
                                            const std::vector<GroundWindow>& windows) {
  Cache& cache = program_cache();
  const auto key = cache.is_on() ? key_of(content, field, windows) : std::nullopt;
  if (key)
    if (const auto bytes = cache.load(kGroundKind, *key)) {
      std::vector<layers::Texture> textures = textures_of(*bytes, windows, content.texels_per_cell);
      if (!textures.empty()) return textures;
    }
  const GroundPainter painter(content, field);
  std::vector<layers::Texture> textures;
  if (!painter.has_textures()) return textures;
  for (const GroundWindow& window : windows)
    textures.push_back(painter.bake(window, content.texels_per_cell));
  // A picture may have been changed while it was read: then the key is not that of what was painted.
  if (key && key_of(content, field, windows) == key) cache.store(kGroundKind, *key, bytes_of(textures));
  return textures;
}

}  // namespace talisman::sequences
