// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Frames to files and back, by OpenImageIO. Every file is written to a temporary name in the same folder,
/// flushed, checked and renamed, so that a final name never holds half a file.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "chunker/composite.h"
#include "sequences/files/errors.h"

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
/// `text` may be any bytes.
void write_text_atomically(const std::string& path, const std::string& text);

/// The same picture always gives the same bytes.
void write_png(const std::string& path, const Image8& image);
/// Half-float linear RGB, from the 16-bit linear frame.
void write_exr(const std::string& path, const chunker::Frame& frame);
Image8 to_image8(const chunker::Frame& frame);
/// PNG, EXR (linear is encoded to sRGB) and whatever else OpenImageIO reads. Grey becomes RGB; where there is
/// alpha the picture is taken over black. Throws InputError.
Image8 read_image(const std::string& path);
/// Width and height, from the header alone. Throws InputError.
layers::ivec2 image_size(const std::string& path);

/// Encodes frames/NNNN.png (or .exr) of `dir` to dir/video.mp4 with ffmpeg: H.264 where ffmpeg has libx264,
/// else MPEG-4 part 2; an odd width or height grows by one pixel. From `first_frame` to `last_frame`, or (-1)
/// to the first number that is missing. Throws OutputError with ffmpeg's last lines, or the name of the frame
/// that is missing.
void write_video(const std::string& dir, double fps, FrameFormat format, int first_frame,
                 int last_frame = -1);

}  // namespace talisman::sequences
