// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What does a video file state of its pictures?

#include <cstdint>
#include <string>
#include <vector>

#include "sequences/files/child_process.h"

namespace talisman::sequences {

/// What every call of ffmpeg's programs may use and open: files of formats that hold their pictures themselves.
ChildLimits video_limits();
std::vector<std::string> video_protocols();

struct VideoFacts {
  std::string codec;
  std::string matrix;             ///< as ffmpeg's scale filter calls it; empty: the pictures are RGB
  std::string range;              ///< "tv" or "pc"; "auto": as the coding of the pixels says
  std::string transfer;           ///< "smpte2084"; empty: not stated
  double nominal_fps = 0;         ///< 0: not stated
  double mean_fps = 0;            ///< likewise
  bool has_hidden_alpha = false;  ///< that only the decoders of libvpx look at
};

/// Asks ffprobe. Throws InputError where there is no video stream, or it is a playlist.
VideoFacts video_facts(const std::string& file);

/// Why the child failed, in one line: its time, or its last words.
std::string video_failure(const ChildResult& child);

}  // namespace talisman::sequences
