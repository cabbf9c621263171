// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/images/video.h"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "sequences/content/images/video_facts.h"
#include "sequences/files/errors.h"

namespace talisman::sequences {

namespace {

namespace fs = std::filesystem;

constexpr double kReadBeyond_s = 1;  // the frame of the last instant is in it, whatever its rate

/// A folder of our own, gone when done.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (fs::temp_directory_path() / "talisman-video-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw OutputError(name + ": cannot be made");
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code error;
    fs::remove_all(path_, error);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  fs::path operator/(const char* name) const { return path_ / name; }

 private:
  fs::path path_;
};

/// Ticks since the first frame, and how long one is.
struct FrameTimes {
  double tick_s = 0;
  std::vector<std::int64_t> starts;
  std::int64_t last_length = 0;
};

std::vector<std::string> reader_arguments(const std::string& file, const VideoFacts& facts, double until_s) {
  std::vector<std::string> a = {"ffmpeg", "-hide_banner", "-nostdin", "-loglevel",
                                "error",  "-y",           "-threads", "1"};
  const auto append = [&a](const std::vector<std::string>& more) {
    a.insert(a.end(), more.begin(), more.end());
  };
  append(video_protocols());
  if (facts.has_hidden_alpha) append({"-c:v", facts.codec == "vp9" ? "libvpx-vp9" : "libvpx"});
  if (std::isfinite(until_s)) append({"-t", std::to_string(std::max(until_s, 0.0) + kReadBeyond_s)});
  append({"-i", "file:" + file});
  const std::vector<std::string> each_once = {"-map",        "0:v:0",          "-fps_mode",
                                              "passthrough", "-enc_time_base", "-1"};
  std::string filter = "scale=flags=bicubic+accurate_rnd+full_chroma_int+full_chroma_inp";
  if (!facts.matrix.empty()) filter += ":in_color_matrix=" + facts.matrix + ":in_range=" + facts.range;
  append(each_once);
  append({"-vf", filter + ",format=rgba", "-c:v", "pam", "-f", "image2pipe", "file:frames"});
  append(each_once);
  append({"-vf", "scale=16:16,format=gray", "-c:v", "rawvideo", "-f", "framecrc", "file:times"});
  return a;
}

/// The lines of ffmpeg's framecrc: "#tb 0: 1/12288", and of each frame "stream, dts, pts, length, …".
FrameTimes read_times(const fs::path& file) {
  FrameTimes times;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    double over = 0, under = 0;
    long long pts = 0, length = 0;
    if (std::sscanf(line.c_str(), "#tb 0: %lf/%lf", &over, &under) == 2) times.tick_s = over / under;
    if (std::sscanf(line.c_str(), "0, %*d, %lld, %lld", &pts, &length) != 2) continue;
    times.starts.push_back(pts);
    times.last_length = length;
  }
  const std::int64_t first = times.starts.empty() ? 0 : times.starts.front();
  for (std::int64_t& start : times.starts) start -= first;
  return times;
}

/// The next picture of a stream of PAM files; false at its end.
bool read_pam(std::istream& in, layers::Texture& texture) {
  std::string line;
  if (!std::getline(in, line) || line != "P7") return false;
  while (std::getline(in, line) && line != "ENDHDR") {
    std::sscanf(line.c_str(), "WIDTH %d", &texture.width);
    std::sscanf(line.c_str(), "HEIGHT %d", &texture.height);
  }
  if (texture.width < 1 || texture.height < 1) return false;
  texture.rgba.resize(4 * static_cast<std::size_t>(texture.width) * texture.height);
  if (!in.read(reinterpret_cast<char*>(texture.rgba.data()),
               static_cast<std::streamsize>(texture.rgba.size())))
    return false;
  for (std::size_t i = 3; i < texture.rgba.size(); i += 4) texture.has_alpha |= texture.rgba[i] < 255;
  return true;
}

/// Do all frames begin within a tick of k / fps?
bool has_constant_rate(const FrameTimes& times, double fps) {
  if (!(fps > 0)) return false;
  for (std::size_t k = 0; k < times.starts.size(); ++k)
    if (std::fabs(static_cast<double>(times.starts[k]) * times.tick_s - static_cast<double>(k) / fps) >
        times.tick_s * (1 + 1e-9))
      return false;
  return true;
}

/// Half a tick may be lost in what a container says of a time: k / fps in whole milliseconds.
void set_own_times(const FrameTimes& times, VideoFrames& video) {
  std::vector<layers::Texture> kept;
  for (std::size_t k = 0; k < times.starts.size(); ++k) {
    const double start = std::max((static_cast<double>(times.starts[k]) - 0.5) * times.tick_s, 0.0);
    if (!kept.empty() && !(start > video.starts_s.back())) continue;  // never shown
    video.starts_s.push_back(start);
    kept.push_back(std::move(video.frames[k]));
  }
  video.frames = std::move(kept);
  const double last_s = std::max(static_cast<double>(times.last_length), 1.0) * times.tick_s;
  video.length_s = static_cast<double>(times.starts.back()) * times.tick_s + last_s;
}

void set_times(const FrameTimes& times, const VideoFacts& facts, VideoFrames& video) {
  for (const double fps : {facts.nominal_fps, facts.mean_fps})
    if (has_constant_rate(times, fps)) {
      video.fps = fps;
      video.length_s = static_cast<double>(video.frames.size()) / fps;
      return;
    }
  if (facts.mean_fps > 0) video.fps = facts.mean_fps;
  set_own_times(times, video);
}

void require_read(const ChildResult& child, const std::string& file) {
  if (!child.started) throw OutputError(file + ": " + video_failure(child));
  if (child.exit_code == 128 + SIGXFSZ || child.output.find("File too large") != std::string::npos)
    throw InputError("has more than 1 GiB of frames until the sequence ends, rule: at most that", file);
  if (!child.succeeded()) throw InputError(video_failure(child), file);
}

}  // namespace

VideoFrames read_video(const std::string& file, double until_s) {
  const std::string path = fs::absolute(file).string();
  const VideoFacts facts = video_facts(path);
  const ScratchFolder scratch;
  ChildOptions options;
  options.directory = (scratch / "").string();
  options.limits = video_limits();
  require_read(run_child(reader_arguments(path, facts, until_s), options), file);
  VideoFrames video;
  std::ifstream in(scratch / "frames", std::ios::binary);
  for (layers::Texture frame; read_pam(in, frame); frame = {}) video.frames.push_back(std::move(frame));
  const FrameTimes times = read_times(scratch / "times");
  if (video.frames.empty()) throw InputError("has no pictures, rule: at least 1 frame", file);
  if (times.starts.size() != video.frames.size() || !(times.tick_s > 0))
    throw InputError("has " + std::to_string(video.frames.size()) + " frames and " +
                         std::to_string(times.starts.size()) + " times, rule: as many",
                     file);
  set_times(times, facts, video);
  if (facts.transfer == "smpte2084" || facts.transfer == "arib-std-b67")
    video.warnings.push_back(file + ": its transfer is " + facts.transfer +
                             ", and is shown as if it were sRGB");
  return video;
}

}  // namespace talisman::sequences
