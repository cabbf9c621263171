// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/image_io.h"

#include <algorithm>
#include <cstring>
#include <memory>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "layers/check.h"
#include "sequences/files/atomic_file.h"

namespace talisman::sequences {
namespace {

/// A date that is plainly none.
constexpr const char* kNoDate = "1970:01:01 00:00:00";
constexpr int kPngFilterSub = 0x10;  // PNG_FILTER_SUB of png.h
/// 16384², 0.8 GB as bytes: more is a damaged or hostile header.
constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28;

/// Encodes into memory; the bytes then go through the one writer that checks everything.
std::string encode(const std::string& path, const std::string& extension, const OIIO::ImageSpec& spec,
                   OIIO::TypeDesc type, const void* pixels) {
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const std::string name = "picture" + extension;
  const auto out = OIIO::ImageOutput::create(name, &memory);
  const bool written = out && out->open(name, spec) && out->write_image(type, pixels) && out->close();
  if (!written)
    throw OutputError(path + ": cannot be encoded: " + (out ? out->geterror() : OIIO::geterror()));
  return {bytes.begin(), bytes.end()};
}

std::uint8_t byte_from_linear(float v) {
  const float clamped = v > 0 ? (v < 1 ? v : 1.0f) : 0.0f;  // NaN becomes 0
  return chunker::srgb_from_linear16(static_cast<std::uint16_t>(clamped * chunker::kOne + 0.5f));
}

bool holds_linear_light(const OIIO::ImageSpec& spec) {
  if (!spec.format.is_floating_point()) return false;
  return spec.get_string_attribute("oiio:ColorSpace", "Linear") != "sRGB";
}

/// Grey becomes three equal channels; channels beyond the third are left out.
template <typename Pixel, typename ToByte>
std::vector<std::uint8_t> rgb_from_channels(const std::vector<Pixel>& pixels, int channels, ToByte to_byte) {
  std::vector<std::uint8_t> rgb;
  rgb.reserve(pixels.size() / channels * 3);
  for (std::size_t i = 0; i < pixels.size(); i += channels)
    for (int c = 0; c < 3; ++c) rgb.push_back(to_byte(pixels[i + (channels >= 3 ? c : 0)]));
  return rgb;
}

template <typename Pixel>
std::vector<Pixel> read_pixels(OIIO::ImageInput& in, OIIO::TypeDesc type, const std::string& path) {
  const OIIO::ImageSpec& spec = in.spec();
  std::vector<Pixel> pixels(static_cast<std::size_t>(spec.width) * spec.height * spec.nchannels);
  if (!in.read_image(0, 0, 0, spec.nchannels, type, pixels.data()))
    throw InputError("cannot be read to its end: " + in.geterror(), path);
  return pixels;
}

void check_readable(const OIIO::ImageSpec& spec, const std::string& path) {
  const std::int64_t pixels = std::int64_t{spec.width} * spec.height;
  if (spec.width < 1 || spec.height < 1 || pixels > kMaxPixels || spec.depth > 1)
    throw InputError("size " + std::to_string(spec.width) + "x" + std::to_string(spec.height) +
                         ", rule: 1 to " + std::to_string(kMaxPixels) + " pixels",
                     path);
  if (spec.deep || spec.nchannels < 1 || spec.nchannels > 64)
    throw InputError(std::to_string(spec.nchannels) + " channels, rule: 1 to 64, not deep", path);
}

std::unique_ptr<OIIO::ImageInput> open_image(const std::string& path) {
  auto in = OIIO::ImageInput::open(path);
  if (!in) throw InputError("cannot be read: " + OIIO::geterror(), path);
  check_readable(in->spec(), path);
  return in;
}

}  // namespace

void write_png(const std::string& path, const Image8& image) {
  TALISMAN_CHECK_EQ(image.rgb.size(), static_cast<std::size_t>(image.width) * image.height * 3);
  OIIO::ImageSpec spec(image.width, image.height, 3, OIIO::TypeDesc::UINT8);
  // Run lengths of differences to the left: on frames of the canyon an eighth of the time of the defaults for
  // 9 % more bytes; level 1 with filters chosen line by line takes twice as long for 8 % more again.
  spec.attribute("png:compressionLevel", 1);
  spec.attribute("compression", "rle");
  spec.attribute("png:filter", kPngFilterSub);
  spec.attribute("oiio:ColorSpace", "sRGB");
  write_text_atomically(path, encode(path, ".png", spec, OIIO::TypeDesc::UINT8, image.rgb.data()));
}

void write_exr(const std::string& path, const chunker::Frame& frame) {
  TALISMAN_CHECK_EQ(frame.pixels.size(), static_cast<std::size_t>(frame.width) * frame.height);
  std::vector<float> linear;
  linear.reserve(frame.pixels.size() * 3);
  for (const chunker::Linear16& p : frame.pixels)
    for (const std::uint16_t v : {p.r, p.g, p.b}) linear.push_back(static_cast<float>(v) / chunker::kOne);
  OIIO::ImageSpec spec(frame.width, frame.height, 3, OIIO::TypeDesc::HALF);
  spec.attribute("compression", "piz");  // lossless, as quick as none, a fifth of the bytes
  // Without a date the encoder takes the clock's, and the same frame has other bytes a second later.
  spec.attribute("DateTime", kNoDate);
  write_text_atomically(path, encode(path, ".exr", spec, OIIO::TypeDesc::FLOAT, linear.data()));
}

Image8 to_image8(const chunker::Frame& frame) {
  return {frame.width, frame.height, chunker::srgb_bytes(frame)};
}

Image8 read_image(const std::string& path) {
  const auto in = open_image(path);
  const OIIO::ImageSpec& spec = in->spec();
  Image8 image{spec.width, spec.height, {}};
  if (holds_linear_light(spec))
    image.rgb = rgb_from_channels(read_pixels<float>(*in, OIIO::TypeDesc::FLOAT, path), spec.nchannels,
                                  byte_from_linear);
  else
    image.rgb = rgb_from_channels(read_pixels<std::uint8_t>(*in, OIIO::TypeDesc::UINT8, path), spec.nchannels,
                                  [](std::uint8_t v) { return v; });
  return image;
}

layers::ivec2 image_size(const std::string& path) {
  const auto in = open_image(path);
  return {in->spec().width, in->spec().height};
}

}  // namespace talisman::sequences
