// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Picture files to samples, and samples to OpenEXR, by OpenImageIO; frames become PNG without it (png_encoding.h).
///
/// That library brings some 260 others with it, and loading them takes half a second, longer than planning the
/// canyon. So it is in a module of its own (files/codec/), which is loaded when the first picture is read or an EXR
/// written, and never by who asks for neither. The module knows nothing of us but this header; what it cannot do it
/// says in words, and who asks makes an error of them.

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace talisman::sequences {

/// What the header of a picture file says.
struct PictureInfo {
  int width = 0, height = 0, depth = 0, channels = 0;
  bool deep = false;          ///< several samples per pixel and channel: none of our pictures
  bool linear_light = false;  ///< floating point, and not said to be sRGB
};

/// How alpha comes out: as the file has it or multiplied into the colours, as OpenImageIO prefers; or straight.
enum class AlphaKind { Associated, Straight };

/// A picture file that was opened.
class PictureReader {
 public:
  virtual ~PictureReader() = default;
  const PictureInfo& info() const { return info_; }
  /// All samples row by row, channels side by side, into width · height · channels elements. Empty when all is
  /// well, else what is wrong.
  virtual std::string read(std::uint8_t* samples) = 0;
  virtual std::string read(float* samples) = 0;

 protected:
  PictureInfo info_;
};

/// A reader, or why there is none.
struct OpenedPicture {
  std::unique_ptr<PictureReader> reader;
  std::string error;
};

/// Encoded bytes, or why there are none.
struct EncodedPicture {
  std::vector<unsigned char> bytes;
  std::string error;
};

/// A picture of many channels, which are got band by band: all at once they may be larger than memory.
struct ChannelPicture {
  int width = 0, height = 0;
  std::vector<std::string> channels;  ///< as OpenEXR names them: "R", "wall.age"
  std::vector<bool> half;             ///< by channel: as half floats; else floats
  /// Fills in the samples of `rows` rows from row `y` on, channels side by side.
  std::function<void(int y, int rows, float* samples)> fill;
  std::vector<std::pair<std::string, std::string>> attributes;  ///< of the header, name and text
};

/// What the module can do.
struct PictureCodec {
  OpenedPicture (*open)(const std::string& path, AlphaKind alpha);
  /// `format` is the usual file extension without the dot.
  OpenedPicture (*open_bytes)(std::span<const std::uint8_t> bytes, const std::string& format,
                              AlphaKind alpha);
  /// Linear RGB as half floats, without loss of those: the same picture always gives the same bytes.
  EncodedPicture (*encode_exr)(int width, int height, const float* rgb);
  /// The same picture always gives the same bytes.
  EncodedPicture (*encode_exr_channels)(const ChannelPicture& picture);
};

/// Loads the module on the first call. Throws OutputError where it is not there (program_folder.h says where it
/// should be). Any number of threads may call it and what it returns.
const PictureCodec& picture_codec();

/// The function that the module exports, by the name kPictureCodecSymbol.
using PictureCodecFunction = const PictureCodec*();
inline constexpr const char* kPictureCodecSymbol = "talisman_picture_codec";

}  // namespace talisman::sequences
