// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/images/video_facts.h"

#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include "sequences/files/errors.h"

namespace talisman::sequences {

namespace {

constexpr int kVideo_s = 60;
constexpr std::int64_t kVideo_bytes = std::int64_t{1} << 30;
constexpr int kHighDefinition_lines = 720;

/// Containers and streams whose pictures are in the file itself. Not among them: hls, dash, concat, sdp, image2 and
/// whatever else names other files.
constexpr const char* kFormats =
    "mov,mp4,m4a,3gp,3g2,mj2,matroska,webm,avi,mpeg,mpegts,mpegvideo,m4v,h264,hevc,ogg,flv,asf,ivf,nut,mxf,"
    "gif,apng,"
    "yuv4mpegpipe,dv,swf,rm,wtv,bink,smk,flic";

std::string matrix_of(const std::string& stated, const std::string& pixels, int lines) {
  const bool is_rgb = pixels.find("rgb") != std::string::npos || pixels.find("bgr") != std::string::npos ||
                      pixels.rfind("gbr", 0) == 0 || pixels == "pal8" || pixels.rfind("gray", 0) == 0 ||
                      stated == "gbr";
  if (is_rgb) return {};
  if (stated == "bt709" || stated == "fcc" || stated == "smpte240m") return stated;
  if (stated == "bt2020nc" || stated == "bt2020c") return "bt2020";
  if (stated == "bt470bg" || stated == "smpte170m") return "bt601";
  return lines >= kHighDefinition_lines ? "bt709" : "bt601";
}

/// 24 of "24/1", 0 of "0/0".
double rate_of(const std::string& fraction) {
  const std::size_t slash = fraction.find('/');
  const double over = std::atof(fraction.c_str());
  const double under = slash == std::string::npos ? 1 : std::atof(fraction.c_str() + slash + 1);
  return over > 0 && under > 0 ? over / under : 0;
}

std::map<std::string, std::string> stated_values(const std::string& output) {
  std::map<std::string, std::string> values;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);)
    if (const std::size_t equals = line.find('='); equals != std::string::npos)
      values[line.substr(0, equals)] = line.substr(equals + 1);
  return values;
}

std::string begin_of(const std::string& file) {
  std::string begin(512, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  begin.resize(static_cast<std::size_t>(in.gcount()));
  return begin;
}

/// Lists of other files, by how they begin.
void refuse_playlist(const std::string& file) {
  const std::string begin = begin_of(file);
  if (begin.empty()) throw InputError("has 0 bytes, rule: a video file", file);
  for (const char* word : {"#EXTM3U", "ffconcat", "[playlist]", "<MPD", "<smil", "<?xml", "v=0"})
    if (begin.find(word) < 4)
      throw InputError("is a playlist, rule: a video file that holds its pictures", file);
}

}  // namespace

ChildLimits video_limits() { return {kVideo_s, kVideo_bytes, kVideo_bytes}; }

std::vector<std::string> video_protocols() {
  return {"-protocol_whitelist", "file,pipe", "-format_whitelist", kFormats};
}

std::string video_failure(const ChildResult& child) {
  if (!child.started) return "ffmpeg cannot be started (" + child.output + "); install the package ffmpeg";
  if (child.timed_out) return "takes longer to read than the limit of " + std::to_string(kVideo_s) + " s";
  return "is no video that ffmpeg reads: " + child.reason(1);
}

VideoFacts video_facts(const std::string& file) {
  using namespace std::string_literals;
  refuse_playlist(file);
  std::vector<std::string> arguments = {"ffprobe", "-v", "error"};
  for (const std::string& argument : video_protocols()) arguments.push_back(argument);
  const std::string asked =
      "stream=codec_name,width,height,pix_fmt,color_space,color_range,color_transfer,r_frame_rate,avg_frame_"
      "rate"
      ":stream_tags=alpha_mode";
  for (const std::string& argument :
       {"-select_streams"s, "v:0"s, "-show_entries"s, asked, "-of"s, "default=nw=1"s})
    arguments.emplace_back(argument);
  arguments.push_back("file:" + file);
  ChildOptions options;
  options.limits = video_limits();
  const ChildResult child = run_child(arguments, options);
  if (!child.started) throw OutputError(file + ": " + video_failure(child));
  if (!child.succeeded()) throw InputError(video_failure(child), file);
  std::map<std::string, std::string> values = stated_values(child.output);
  if (values["codec_name"].empty())
    throw InputError("has no pictures, rule: a file with a video stream", file);
  const auto stated = [&](const char* key) { return values[key] == "unknown" ? "" : values[key]; };
  VideoFacts facts;
  facts.codec = values["codec_name"];
  facts.matrix = matrix_of(stated("color_space"), values["pix_fmt"], std::atoi(values["height"].c_str()));
  facts.range = stated("color_range").empty() ? "auto" : stated("color_range");
  facts.transfer = stated("color_transfer");
  facts.nominal_fps = rate_of(values["r_frame_rate"]);
  facts.mean_fps = rate_of(values["avg_frame_rate"]);
  facts.has_hidden_alpha = values["TAG:alpha_mode"] == "1" && (facts.codec == "vp8" || facts.codec == "vp9");
  return facts;
}

}  // namespace talisman::sequences
