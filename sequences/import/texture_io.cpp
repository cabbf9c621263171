// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/texture_io.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <vector>

#include "sequences/files/picture_codec.h"

namespace talisman::sequences {

namespace {

constexpr int kMaxSide = 16384;  // a larger side is taken for a damaged header rather than a texture

/// Grey, grey + alpha, RGB and RGBA become RGBA; further channels are left out.
void spread_channels(const std::vector<std::uint8_t>& pixels, int channels, layers::Texture& texture) {
  const std::size_t count = static_cast<std::size_t>(texture.width) * texture.height;
  texture.rgba.resize(4 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* from = &pixels[i * channels];
    std::uint8_t* to = &texture.rgba[4 * i];
    const bool grey = channels < 3;
    for (int k = 0; k < 3; ++k) to[k] = from[grey ? 0 : k];
    to[3] = channels == 2 ? from[1] : channels >= 4 ? from[3] : 255;
    texture.has_alpha |= to[3] < 255;
  }
}

/// Of the address space of this process: how much it may take, and takes; nothing where there is no limit.
std::optional<std::int64_t> bytes_left() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return std::nullopt;
  std::ifstream in("/proc/self/statm");
  std::int64_t pages = 0;
  in >> pages;
  return static_cast<std::int64_t>(limit.rlim_cur) - pages * ::sysconf(_SC_PAGESIZE);
}

/// The samples as they are decoded, and four bytes for each texel. Not an InputError: without its texture a model would
/// be another one, and the limit can be raised.
void require_room(const PictureInfo& info, const std::string& name) {
  const std::optional<std::int64_t> left = bytes_left();
  const std::int64_t needed = std::int64_t{info.width} * info.height * (info.channels + 4);
  if (left && needed > *left)
    throw std::runtime_error("texture '" + name + "' of " + std::to_string(info.width) + " × " +
                             std::to_string(info.height) + " × " + std::to_string(info.channels) + " takes " +
                             std::to_string((needed >> 20) + 1) +
                             " MB to decode, and of the memory that its reader may take " +
                             std::to_string(std::max<std::int64_t>(*left, 0) >> 20) +
                             " MB are left; --import-memory-mb raises that");
}

layers::Texture read_opened(OpenedPicture opened, const std::string& name) {
  if (!opened.reader) throw InputError("not an image that can be read: " + opened.error, name);
  const PictureInfo& info = opened.reader->info();
  if (info.width < 1 || info.height < 1 || info.width > kMaxSide || info.height > kMaxSide ||
      info.channels < 1)
    throw InputError("image of " + std::to_string(info.width) + " × " + std::to_string(info.height) + " × " +
                         std::to_string(info.channels) + ", rule: sides from 1 to " +
                         std::to_string(kMaxSide),
                     name);
  require_room(info, name);
  layers::Texture texture;
  texture.name = name;
  texture.width = info.width;
  texture.height = info.height;
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(info.width) * info.height * info.channels);
  const std::string error = opened.reader->read(pixels.data());
  if (!error.empty()) throw InputError("damaged image: " + error, name);
  spread_channels(pixels, info.channels, texture);
  return texture;
}

}  // namespace

layers::Texture read_texture(const std::string& path) {
  return read_opened(picture_codec().open(path, AlphaKind::Straight), path);
}

layers::Texture read_texture_from_bytes(std::span<const std::uint8_t> bytes, const std::string& name,
                                        const std::string& format) {
  return read_opened(picture_codec().open_bytes(bytes, format, AlphaKind::Straight), name);
}

bool is_all_clear(const layers::Texture& texture) {
  for (std::size_t i = 3; i < texture.rgba.size(); i += 4)
    if (texture.rgba[i] > 0) return false;
  return texture.has_alpha;
}

void make_opaque(layers::Texture& texture) {
  for (std::size_t i = 3; i < texture.rgba.size(); i += 4) texture.rgba[i] = 255;
  texture.has_alpha = false;
}

}  // namespace talisman::sequences
