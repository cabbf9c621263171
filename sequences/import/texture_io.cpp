// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/texture_io.h"

#include <cstdint>
#include <memory>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

namespace talisman::sequences {

namespace {

constexpr int kMaxSide = 16384;  // a larger side is taken for a damaged header rather than a texture

OIIO::ImageSpec straight_alpha() {
  OIIO::ImageSpec config;
  config["oiio:UnassociatedAlpha"] = 1;
  return config;
}

/// Grey, grey + alpha, RGB and RGBA become RGBA; further channels are left out.
void spread_channels(const std::vector<std::uint8_t>& pixels, int channels, layers::Texture& texture) {
  const std::size_t count = static_cast<std::size_t>(texture.width) * texture.height;
  texture.rgba.resize(4 * count);
  std::uint8_t seen = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* from = &pixels[i * channels];
    std::uint8_t* to = &texture.rgba[4 * i];
    const bool grey = channels < 3;
    for (int k = 0; k < 3; ++k) to[k] = from[grey ? 0 : k];
    to[3] = channels == 2 ? from[1] : channels >= 4 ? from[3] : 255;
    texture.has_alpha |= to[3] < 255;
    seen |= to[3];
  }
  // Old painters wrote an alpha channel and left it zero; nobody draws a picture in order not to see it.
  if (seen > 0) return;
  for (std::size_t i = 0; i < count; ++i) texture.rgba[4 * i + 3] = 255;
  texture.has_alpha = false;
}

layers::Texture read_open_image(std::unique_ptr<OIIO::ImageInput> input, const std::string& name) {
  if (!input) {
    std::string why = OIIO::geterror();
    throw InputError("not an image that can be read: " + (why.empty() ? "unknown format" : why), name);
  }
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.width < 1 || spec.height < 1 || spec.width > kMaxSide || spec.height > kMaxSide ||
      spec.nchannels < 1)
    throw InputError("image of " + std::to_string(spec.width) + " × " + std::to_string(spec.height) + " × " +
                         std::to_string(spec.nchannels) + ", rule: sides from 1 to " +
                         std::to_string(kMaxSide),
                     name);
  layers::Texture texture;
  texture.name = name;
  texture.width = spec.width;
  texture.height = spec.height;
  const int channels = spec.nchannels;
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(spec.width) * spec.height * channels);
  if (!input->read_image(0, 0, 0, channels, OIIO::TypeDesc::UINT8, pixels.data()))
    throw InputError("damaged image: " + input->geterror(), name);
  spread_channels(pixels, channels, texture);
  return texture;
}

}  // namespace

layers::Texture read_texture(const std::string& path) {
  const OIIO::ImageSpec config = straight_alpha();
  return read_open_image(OIIO::ImageInput::open(path, &config), path);
}

layers::Texture read_texture_from_bytes(std::span<const std::uint8_t> bytes, const std::string& name,
                                        const std::string& format) {
  OIIO::Filesystem::IOMemReader memory(const_cast<std::uint8_t*>(bytes.data()), bytes.size());
  OIIO::ImageSpec config = straight_alpha();
  // Given as an argument beside a configuration, 2.4 forgets the proxy; in the configuration it is kept.
  OIIO::Filesystem::IOProxy* proxy = &memory;
  config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  return read_open_image(OIIO::ImageInput::open("embedded." + format, &config), name);
}

}  // namespace talisman::sequences
