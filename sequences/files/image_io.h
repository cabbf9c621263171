// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Frames to files and back (picture_codec.h). Every file is written whole or not at all (atomic_file.h).

#include <cstdint>
#include <string>
#include <vector>

#include "chunker/composite.h"
#include "sequences/files/errors.h"
#include "sequences/files/picture_codec.h"

namespace talisman::sequences {

/// ExrLayers: one EXR with the channels of every sprite (results/exports/sprite_channels.h).
enum class FrameFormat { Png, Exr, ExrLayers, None };

/// 8-bit sRGB picture, 3 bytes per pixel, row by row.
struct Image8 {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

/// The same picture always gives the same bytes.
void write_png(const std::string& path, const Image8& image);
/// Half-float linear RGB, from the 16-bit linear frame.
void write_exr(const std::string& path, const chunker::Frame& frame);
/// The same in two steps: what takes long, and what touches the disk. Any number of threads may encode. write_encoded
/// throws OutputError, also for what could not be encoded.
EncodedPicture encoded_png(const Image8& image);
EncodedPicture encoded_exr(const chunker::Frame& frame);
void write_encoded(const std::string& path, const EncodedPicture& encoded);
Image8 to_image8(const chunker::Frame& frame);
/// PNG, EXR (linear is encoded to sRGB) and whatever else OpenImageIO reads. Grey becomes RGB; where there is
/// alpha the picture is taken over black. Throws InputError.
Image8 read_image(const std::string& path);
/// Width and height, from the header alone. Throws InputError.
layers::ivec2 image_size(const std::string& path);

}  // namespace talisman::sequences
