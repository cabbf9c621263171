// SPDX-License-Identifier: Apache-2.0
#pragma once

/// 2-D layers of a sequence file [LS97 1]: a picture, a sequence of pictures or a video, on the screen, in the world
/// or on parts that are there. Read from YAML without opening anything; place_images.h then does.

#include <optional>
#include <string>
#include <vector>

#include "sequences/content/motion.h"

namespace talisman::sequences {

struct ImageRecipe {
  std::string id;  ///< of its part and its layer
  // What is shown: one of three.
  std::string picture_file;
  std::vector<std::string> picture_files;  ///< a sequence of pictures, in order
  std::string pattern;                     ///< by which those were found
  std::string video_file;
  std::optional<double> fps;  ///< > 0; of picture_files; empty: that of the sequence
  double start_s = 0;         ///< when its first frame begins
  bool loop = false;          ///< begins again at its end
  float opacity = 1;          ///< 0 … 1
  // Where: one of three.
  std::optional<layers::dvec4> screen_px;  ///< left, top, width, height, in pixels of the file's display
  std::optional<layers::dvec2> size_m;     ///< in the world, in its own x-y plane, facing +z
  std::vector<std::string> part_globs;     ///< in place of the textures of these parts
  bool behind = false;                     ///< on the screen: behind everything instead of before it
  Motion motion;                           ///< in the world
  std::string file;                        ///< and line: where it is written
  int line = 0;
};

/// When a sequence shows what its content holds.
struct ShownTimes {
  double fps = 24;
  int frames = 1;
  layers::ivec2 display_px{1024, 1024};
  double last_s() const { return (frames - 1) / fps; }
};

const Table<ImageRecipe>& image_keys();

}  // namespace talisman::sequences
