// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Frames as a video, by ffmpeg.

#include <string>

#include "sequences/files/image_io.h"

namespace talisman::sequences {

/// Is there an ffmpeg that answers? To be asked before the frames are drawn. Throws OutputError that says what to install.
void require_video_encoder();

/// Encodes frames/NNNN.png (or .exr) of `dir` to dir/video.mp4 with ffmpeg: H.264 where ffmpeg has libx264,
/// else MPEG-4 part 2; an odd width or height grows by one pixel. From `first_frame` to `last_frame`, or (-1)
/// to the first number that is missing. Throws OutputError with ffmpeg's last lines, or the name of the frame
/// that is missing.
void write_video(const std::string& dir, double fps, FrameFormat format, int first_frame,
                 int last_frame = -1);

}  // namespace talisman::sequences
