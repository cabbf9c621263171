// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Frames to files and back, by OpenImageIO. Every file is written to a temporary name in the same folder,
/// flushed, checked and renamed, so that a final name never holds half a file.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "chunker/composite.h"
#include "sequences/errors.h"

namespace talisman::sequences {

enum class FrameFormat { Png, Exr, None };

/// 8-bit sRGB picture, 3 bytes per pixel, row by row.
struct Image8 {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

/// Writes `content(path)` to a temporary file, then renames it. Throws OutputError (and removes the
/// temporary) when anything fails.
void write_atomically(const std::string& path,
                      const std::function<void(const std::string& temporary)>& content);
void write_text_atomically(const std::string& path, const std::string& text);

void write_png(const std::string& path, const Image8& image);
/// Half-float linear RGB, from the 16-bit linear frame.
void write_exr(const std::string& path, const chunker::Frame& frame);
Image8 to_image8(const chunker::Frame& frame);
/// PNG, EXR (linear is encoded to sRGB) and whatever else OpenImageIO reads. Throws InputError.
Image8 read_image(const std::string& path);

/// Encodes frames/NNNN.png (or .exr) of `dir` to dir/video.mp4 with ffmpeg. Throws OutputError with ffmpeg's
/// last line.
void write_video(const std::string& dir, double fps, FrameFormat format, int first_frame);

}  // namespace talisman::sequences
