// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/images/picture_source.h"

#include <algorithm>
#include <filesystem>
#include <limits>

#include "layers/moving_picture.h"
#include "sequences/content/images/video.h"
#include "sequences/content/value_type.h"
#include "sequences/files/errors.h"
#include "sequences/import/texture_io.h"

namespace talisman::sequences {

namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 30;

std::string base_name_of(const std::string& path) { return std::filesystem::path(path).filename().string(); }

/// The numbers of the frames that the sequence shows.
std::vector<int> numbers_shown(const layers::MovingPicture& timing, const ShownTimes& times) {
  std::vector<int> numbers;
  for (int k = 0; k < times.frames; ++k) numbers.push_back(layers::frame_at(timing, k / times.fps));
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

/// Names that are the same on every machine.
void keep(PictureSource& source, layers::Texture texture, const std::string& name) {
  texture.name = name;
  source.textures.push_back(std::move(texture));
}

void check_size(const PictureSource& source, const std::string& file) {
  std::size_t bytes = 0;
  for (const layers::Texture& texture : source.textures) bytes += texture.rgba.size();
  if (bytes > kMostBytes)
    throw InputError("the frames that are shown take " + std::to_string(bytes >> 20) +
                         " MiB, rule: at most " + std::to_string(kMostBytes >> 20) + " MiB",
                     file);
}

/// Said once, not in every frame.
void note_held_end(const ImageRecipe& image, const ShownTimes& times, const std::string& what,
                   double length_s, PictureSource& source) {
  const double end_s = image.start_s + length_s;
  const double tolerance_s = layers::kFrameTolerance * length_s;
  if (image.loop || times.last_s() + tolerance_s < end_s) return;
  source.notes.push_back("image '" + image.id + "': '" + what + "' ends at " + shown(end_s) +
                         " s, before the sequence does: its last frame holds");
}

void read_numbered_pictures(const ImageRecipe& image, const ShownTimes& times, PictureSource& source) {
  source.timing.name = image.pattern;
  source.timing.fps = image.fps.value_or(times.fps);
  source.timing.frame_count = static_cast<int>(image.picture_files.size());
  source.timing.frames = numbers_shown(source.timing, times);
  for (const int number : source.timing.frames) {
    const std::string& file = image.picture_files[static_cast<std::size_t>(number)];
    keep(source, read_texture(file), base_name_of(file));
    source.files.push_back(file);
    check_size(source, file);
  }
  note_held_end(image, times, image.pattern, source.timing.frame_count / source.timing.fps, source);
}

void read_frames_of_video(const ImageRecipe& image, const ShownTimes& times, PictureSource& source) {
  const double all = std::numeric_limits<double>::infinity();
  VideoFrames video = read_video(image.video_file, image.loop ? all : times.last_s() - image.start_s);
  layers::MovingPicture& timing = source.timing;
  timing.name = base_name_of(image.video_file);
  timing.fps = video.fps;
  timing.starts_s = video.starts_s;
  timing.length_s = video.length_s;
  timing.frame_count = static_cast<int>(video.frames.size());
  timing.frames = numbers_shown(timing, times);
  for (const int number : timing.frames)
    keep(source, std::move(video.frames[static_cast<std::size_t>(number)]), timing.name);
  source.files.push_back(image.video_file);
  source.warnings = std::move(video.warnings);
  note_held_end(image, times, timing.name, video.length_s, source);
}

}  // namespace

PictureSource read_source(const ImageRecipe& image, const ShownTimes& times) {
  PictureSource source;
  source.timing.start_s = image.start_s;
  source.timing.loop = image.loop;
  if (!image.picture_files.empty()) {
    read_numbered_pictures(image, times, source);
  } else if (!image.video_file.empty()) {
    read_frames_of_video(image, times, source);
  } else {
    keep(source, read_texture(image.picture_file), base_name_of(image.picture_file));
    source.files.push_back(image.picture_file);
  }
  return source;
}

}  // namespace talisman::sequences
