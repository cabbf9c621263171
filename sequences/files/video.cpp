// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/video.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "sequences/files/atomic_file.h"
#include "sequences/files/child_process.h"

namespace talisman::sequences {
namespace {

namespace fs = std::filesystem;

std::string frame_name(int frame, const std::string& extension) {
  std::array<char, 32> digits;
  std::snprintf(digits.data(), digits.size(), "%04d", frame);
  return digits.data() + extension;
}

/// Frames from `first` to the first that is missing, where ffmpeg would end too.
int count_frames(const fs::path& folder, int first, const std::string& extension) {
  int count = 0;
  while (fs::exists(folder / frame_name(first + count, extension))) ++count;
  return count;
}

/// What ffmpeg says that it can encode.
ChildResult list_of_encoders() {
  ChildResult list = run_child({"ffmpeg", "-hide_banner", "-encoders"});
  if (!list.started)
    throw OutputError("video: ffmpeg cannot be started (" + list.output + "); install the package ffmpeg");
  if (!list.succeeded()) throw OutputError("video: ffmpeg failed: " + list.reason());
  return list;
}

std::vector<std::string> encoder_arguments() {
  const ChildResult list = list_of_encoders();
  if (list.output.find(" libx264 ") != std::string::npos)
    return {"-c:v", "libx264", "-preset", "veryfast", "-crf", "18"};
  return {"-c:v", "mpeg4", "-q:v", "2"};
}

/// yuv420p wants even sizes: an odd last column or row is doubled rather than every pixel resampled. Colours
/// become BT.709, and say so: players guess the matrix otherwise.
std::string video_filter(layers::ivec2 size) {
  std::string to_yuv = "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p";
  if (size.x % 2 == 0 && size.y % 2 == 0) return to_yuv;
  return "pad=ceil(iw/2)*2:ceil(ih/2)*2,fillborders=right=" + std::to_string(size.x % 2) +
         ":bottom=" + std::to_string(size.y % 2) + ":mode=smear," + to_yuv;
}

struct VideoInput {
  std::string extension;
  int first_frame = 0;
  int frames = 0;
  layers::ivec2 size;
};

std::vector<std::string> ffmpeg_arguments(double fps, const VideoInput& input, const std::string& output) {
  std::array<char, 32> rate;
  std::snprintf(rate.data(), rate.size(), "%.9g", fps);
  std::vector<std::string> a{
      "ffmpeg", "-hide_banner", "-nostdin",  "-loglevel",     "error",
      "-y",     "-framerate",   rate.data(), "-start_number", std::to_string(input.first_frame)};
  const auto append = [&a](const std::vector<std::string>& more) {
    a.insert(a.end(), more.begin(), more.end());
  };
  if (input.extension == ".exr") append({"-apply_trc", "iec61966_2_1"});  // EXR holds linear light
  append({"-i", "frames/%04d" + input.extension, "-frames:v", std::to_string(input.frames), "-vf",
          video_filter(input.size)});
  append(encoder_arguments());
  append({"-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "iec61966-2-1", "-movflags",
          "+faststart", "-f", "mp4", "file:" + output});
  return a;
}

}  // namespace

void require_video_encoder() { list_of_encoders(); }

void write_video(const std::string& dir, double fps, FrameFormat format, int first_frame, int last_frame) {
  const std::string path = (fs::path(dir) / "video.mp4").string();
  if (format == FrameFormat::None)
    throw OutputError(path + ": there are no frame files to encode (format none)");
  if (!(fps > 0) || !std::isfinite(fps)) throw OutputError(path + ": frames per second must be above 0");
  const std::string extension = format == FrameFormat::Png ? ".png" : ".exr";
  int frames = count_frames(fs::path(dir) / "frames", first_frame, extension);
  if (frames == 0)
    throw OutputError(path + ": the first frame frames/" + frame_name(first_frame, extension) +
                      " does not exist");
  if (last_frame >= first_frame) {
    if (first_frame + frames <= last_frame)
      throw OutputError(path + ": frames/" + frame_name(first_frame + frames, extension) + " does not exist");
    frames = last_frame - first_frame + 1;
  }
  // ffmpeg works inside `dir`, so that no character of the folder's name can be taken for a pattern or a
  // protocol.
  const auto first = fs::path(dir) / "frames" / frame_name(first_frame, extension);
  const VideoInput input{extension, first_frame, frames, image_size(first.string())};
  write_atomically(path, [&](const std::string& temporary) {
    const std::string name = fs::path(temporary).filename().string();
    const ChildResult child = run_child(ffmpeg_arguments(fps, input, name), {dir, {}, {}});
    // A disk that fills up while the last bytes are written does not change ffmpeg's exit code. At this log
    // level it speaks of its output only when writing failed; and it may complain of a frame beyond the last
    // one, at which it has looked ahead.
    const bool written = child.output.find(name) == std::string::npos;
    if (!child.succeeded() || !written) throw OutputError(path + ": ffmpeg failed: " + child.reason());
  });
}

}  // namespace talisman::sequences
