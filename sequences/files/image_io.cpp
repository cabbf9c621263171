// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/image_io.h"

#include <memory>

#include "layers/check.h"
#include "sequences/files/atomic_file.h"
#include "sequences/files/png_encoding.h"

namespace talisman::sequences {
namespace {

/// 16384², 0.8 GB as bytes: more is a damaged or hostile header.
constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28;

std::uint8_t byte_from_linear(float v) {
  const float clamped = v > 0 ? (v < 1 ? v : 1.0f) : 0.0f;  // NaN becomes 0
  return chunker::srgb_from_linear16(static_cast<std::uint16_t>(clamped * chunker::kOne + 0.5f));
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
std::vector<Pixel> read_pixels(PictureReader& in, const std::string& path) {
  const PictureInfo& info = in.info();
  std::vector<Pixel> pixels(static_cast<std::size_t>(info.width) * info.height * info.channels);
  const std::string error = in.read(pixels.data());
  if (!error.empty()) throw InputError("cannot be read to its end: " + error, path);
  return pixels;
}

void check_readable(const PictureInfo& info, const std::string& path) {
  const std::int64_t pixels = std::int64_t{info.width} * info.height;
  if (info.width < 1 || info.height < 1 || pixels > kMaxPixels || info.depth > 1)
    throw InputError("size " + std::to_string(info.width) + "x" + std::to_string(info.height) +
                         ", rule: 1 to " + std::to_string(kMaxPixels) + " pixels",
                     path);
  if (info.deep || info.channels < 1 || info.channels > 64)
    throw InputError(std::to_string(info.channels) + " channels, rule: 1 to 64, not deep", path);
}

std::unique_ptr<PictureReader> open_image(const std::string& path) {
  OpenedPicture opened = picture_codec().open(path, AlphaKind::Associated);
  if (!opened.reader) throw InputError("cannot be read: " + opened.error, path);
  check_readable(opened.reader->info(), path);
  return std::move(opened.reader);
}

}  // namespace

void write_png(const std::string& path, const Image8& image) { write_encoded(path, encoded_png(image)); }

void write_exr(const std::string& path, const chunker::Frame& frame) {
  write_encoded(path, encoded_exr(frame));
}

EncodedPicture encoded_png(const Image8& image) {
  TALISMAN_CHECK_EQ(image.rgb.size(), static_cast<std::size_t>(image.width) * image.height * 3);
  return encoded_as_png(image.width, image.height, image.rgb.data());
}

EncodedPicture encoded_exr(const chunker::Frame& frame) {
  TALISMAN_CHECK_EQ(frame.pixels.size(), static_cast<std::size_t>(frame.width) * frame.height);
  std::vector<float> linear;
  linear.reserve(frame.pixels.size() * 3);
  for (const chunker::Linear16& p : frame.pixels)
    for (const std::uint16_t v : {p.r, p.g, p.b}) linear.push_back(static_cast<float>(v) / chunker::kOne);
  return picture_codec().encode_exr(frame.width, frame.height, linear.data());
}

/// All goes through the one writer that checks everything.
void write_encoded(const std::string& path, const EncodedPicture& encoded) {
  if (!encoded.error.empty()) throw OutputError(path + ": cannot be encoded: " + encoded.error);
  write_text_atomically(path, {encoded.bytes.begin(), encoded.bytes.end()});
}

Image8 to_image8(const chunker::Frame& frame) {
  return {frame.width, frame.height, chunker::srgb_bytes(frame)};
}

Image8 read_image(const std::string& path) {
  const auto in = open_image(path);
  const PictureInfo& info = in->info();
  Image8 image{info.width, info.height, {}};
  if (info.linear_light)
    image.rgb = rgb_from_channels(read_pixels<float>(*in, path), info.channels, byte_from_linear);
  else
    image.rgb = rgb_from_channels(read_pixels<std::uint8_t>(*in, path), info.channels,
                                  [](std::uint8_t v) { return v; });
  return image;
}

layers::ivec2 image_size(const std::string& path) {
  const auto in = open_image(path);
  return {in->info().width, in->info().height};
}

}  // namespace talisman::sequences
