// SPDX-License-Identifier: Apache-2.0
/// The module behind files/picture_codec.h.

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <fstream>
#include <memory>
#include <new>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "sequences/files/picture_codec.h"

namespace talisman::sequences {
namespace {

/// A date that is plainly none.
constexpr const char* kNoDate = "1970:01:01 00:00:00";

/// Of channels in named layers behind R, G and B (a file of --format exr-layers) none is read.
int colour_channels(const OIIO::ImageSpec& spec) {
  const bool layered = spec.nchannels > 3 && spec.channelnames[0] == "R" && spec.channelnames[2] == "B" &&
                       spec.channelnames[3].find('.') != std::string::npos;
  return layered ? 3 : spec.nchannels;
}

std::string why_not() {
  const std::string why = OIIO::geterror();
  return why.empty() ? "unknown format" : why;
}

/// What `use` says is wrong. A damaged header makes some readers of the library throw: memory that nobody has, places behind the end.
template <typename Use>
std::string said(const Use& use) {
  try {
    return use();
  } catch (const std::bad_alloc&) {
    return "it asks for more memory than there is";
  } catch (const std::exception& error) {
    return error.what();
  }
}

/// Empty, or why the library's reader of BMP must not see a file that begins like this: told that runs of 4 or 8 bits are packed where
/// pixels have others, it reads from no address.
std::string defect_of_bmp(std::span<const std::uint8_t> head) {
  constexpr std::size_t kHeader = 14, kBits = 28, kPacking = 30, kSeen = 34;
  constexpr std::uint32_t kLeastThatSays = 40;  // shorter headers do not have the word; pixels may lie there
  if (head.size() < kSeen || head[0] != 'B' || head[1] != 'M') return "";
  std::uint16_t bits = 0;
  std::uint32_t header = 0, packing = 0;
  std::memcpy(&header, &head[kHeader], sizeof header);
  if (header < kLeastThatSays) return "";
  std::memcpy(&bits, &head[kBits], sizeof bits);
  std::memcpy(&packing, &head[kPacking], sizeof packing);
  const bool fits = (packing != 1 || bits == 8) && (packing != 2 || bits == 4);
  return fits ? ""
              : "a BMP of " + std::to_string(bits) + " bits a pixel that says it is packed as one of " +
                    (packing == 1 ? "8" : "4");
}

std::string defect_of_bmp(const std::string& path) {
  std::array<std::uint8_t, 34> head{};
  std::ifstream in(path, std::ios::binary);
  in.read(reinterpret_cast<char*>(head.data()), head.size());
  return defect_of_bmp(std::span(head).first(static_cast<std::size_t>(in.gcount())));
}

class Reader : public PictureReader {
 public:
  explicit Reader(std::unique_ptr<OIIO::ImageInput> input) : input_(std::move(input)) {
    const OIIO::ImageSpec& spec = input_->spec();
    const bool srgb = spec.get_string_attribute("oiio:ColorSpace", "Linear") == "sRGB";
    info_ = {spec.width, spec.height,
             spec.depth, colour_channels(spec),
             spec.deep,  spec.format.is_floating_point() && !srgb};
  }
  std::string read(std::uint8_t* samples) override { return read_as(OIIO::TypeDesc::UINT8, samples); }
  std::string read(float* samples) override { return read_as(OIIO::TypeDesc::FLOAT, samples); }

 private:
  std::string read_as(const OIIO::TypeDesc& type, void* samples) {
    return said([&]() -> std::string {
      if (input_->read_image(0, 0, 0, info_.channels, type, samples)) return "";
      const std::string why = input_->geterror();
      return why.empty() ? "cannot be read to its end" : why;
    });
  }
  std::unique_ptr<OIIO::ImageInput> input_;
};

/// Embedded bytes must outlive their reader.
class MemoryReader : public Reader {
 public:
  MemoryReader(std::unique_ptr<OIIO::Filesystem::IOMemReader> memory, std::unique_ptr<OIIO::ImageInput> input)
      : Reader(std::move(input)), memory_(std::move(memory)) {}

 private:
  std::unique_ptr<OIIO::Filesystem::IOMemReader> memory_;
};

OIIO::ImageSpec configuration(AlphaKind alpha) {
  OIIO::ImageSpec config;
  if (alpha == AlphaKind::Straight) config["oiio:UnassociatedAlpha"] = 1;
  return config;
}

OpenedPicture open(const std::string& path, AlphaKind alpha) {
  if (std::string defect = defect_of_bmp(path); !defect.empty()) return {nullptr, defect};
  const OIIO::ImageSpec config = configuration(alpha);
  std::unique_ptr<OIIO::ImageInput> input;
  const std::string error = said([&] {
    input = OIIO::ImageInput::open(path, &config);
    return input ? std::string() : why_not();
  });
  if (!input) return {nullptr, error};
  return {std::make_unique<Reader>(std::move(input)), ""};
}

OpenedPicture open_bytes(std::span<const std::uint8_t> bytes, const std::string& format, AlphaKind alpha) {
  if (std::string defect = defect_of_bmp(bytes); !defect.empty()) return {nullptr, defect};
  auto memory =
      std::make_unique<OIIO::Filesystem::IOMemReader>(const_cast<std::uint8_t*>(bytes.data()), bytes.size());
  OIIO::ImageSpec config = configuration(alpha);
  // Given as an argument beside a configuration, 2.4 forgets the proxy; in the configuration it is kept.
  OIIO::Filesystem::IOProxy* proxy = memory.get();
  config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  std::unique_ptr<OIIO::ImageInput> input;
  const std::string error = said([&] {
    input = OIIO::ImageInput::open("embedded." + format, &config);
    return input ? std::string() : why_not();
  });
  if (!input) return {nullptr, error};
  return {std::make_unique<MemoryReader>(std::move(memory), std::move(input)), ""};
}

EncodedPicture encode(const std::string& name, const OIIO::ImageSpec& spec, const OIIO::TypeDesc& type,
                      const void* samples) {
  EncodedPicture encoded;
  OIIO::Filesystem::IOVecOutput memory(encoded.bytes);
  const auto out = OIIO::ImageOutput::create(name, &memory);
  const bool written = out && out->open(name, spec) && out->write_image(type, samples) && out->close();
  if (!written) encoded.error = out ? out->geterror() : why_not();
  return encoded;
}

EncodedPicture encode_exr(int width, int height, const float* rgb) {
  OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::HALF);
  spec.attribute("compression", "piz");  // lossless, as quick as none, a fifth of the bytes
  // Without a date the encoder takes the clock's, and the same frame has other bytes a second later.
  spec.attribute("DateTime", kNoDate);
  return encode("picture.exr", spec, OIIO::TypeDesc::FLOAT, rgb);
}

/// Chunks of OpenEXR's zip are 16 lines high.
constexpr int kBandLines = 32;

EncodedPicture encode_exr_channels(const ChannelPicture& picture) {
  const int channels = static_cast<int>(picture.channels.size());
  OIIO::ImageSpec spec(picture.width, picture.height, channels, OIIO::TypeDesc::FLOAT);
  spec.channelnames = picture.channels;
  for (const bool half : picture.half)
    spec.channelformats.push_back(half ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT);
  spec.attribute("compression", "zip");  // lossless; most channels are constant in runs
  spec.attribute("DateTime", kNoDate);
  for (const auto& [name, text] : picture.attributes) spec.attribute(name, text);
  EncodedPicture encoded;
  OIIO::Filesystem::IOVecOutput memory(encoded.bytes);
  const auto out = OIIO::ImageOutput::create("picture.exr", &memory);
  bool written = out && out->open("picture.exr", spec);
  std::vector<float> band(static_cast<std::size_t>(picture.width) * kBandLines * channels);
  for (int y = 0; written && y < picture.height; y += kBandLines) {
    const int rows = std::min(kBandLines, picture.height - y);
    picture.fill(y, rows, band.data());
    written = out->write_scanlines(y, y + rows, 0, OIIO::TypeDesc::FLOAT, band.data());
  }
  if (!written || !out->close()) encoded.error = out ? out->geterror() : why_not();
  return encoded;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) const PictureCodec* talisman_picture_codec() {
  static constexpr PictureCodec codec{open, open_bytes, encode_exr, encode_exr_channels};
  return &codec;
}

}  // namespace talisman::sequences
