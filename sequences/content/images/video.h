// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The frames of a video file, by ffmpeg in a child process that may use 60 s and 1 GB, and open files alone: a hostile
/// file can crash, hang or exhaust nothing but its reader, and fetches nothing.
///
///   frames    each once, as it was coded, in the order in which they are shown; turned as the file says
///   times     constant where all lie within a tick of k / fps, else of each frame, to half a tick
///   colours   of the matrix and the range that the file states; without a matrix BT.709 from 720 lines on, else
///             BT.601, as players do; the transfer is taken for sRGB
///   alpha     straight

#include <cstdint>
#include <string>
#include <vector>

#include "layers/scene.h"

namespace talisman::sequences {

struct VideoFrames {
  double fps = 24;  ///< of a constant rate
  std::vector<double>
      starts_s;         ///< of a variable rate: of each frame, from 0, strictly increasing; else empty
  double length_s = 0;  ///< until the end of the last frame
  std::vector<layers::Texture> frames;
  std::vector<std::string> warnings;
};

/// Reads the frames that begin before `until_s` (and some behind it). Throws InputError: no video, a playlist,
/// larger than 1 GiB of frames, longer to read than 60 s.
VideoFrames read_video(const std::string& file, double until_s);

}  // namespace talisman::sequences
