// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Videos whose frames say which they are: each is of one colour, and the colour is the number, in base 3.

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "sequences/files/child_process.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::tests {

inline constexpr int kCodes = 27;

/// The colour of frame `k`: levels far enough apart to be told after any coding.
inline std::array<std::uint8_t, 3> code_of(int k) {
  const auto level = [](int digit) { return static_cast<std::uint8_t>(40 + 88 * digit); };
  return {level(k / 9 % 3), level(k / 3 % 3), level(k % 3)};
}

/// The number of the nearest code; -1 where none is within `most` of the colour.
inline int number_of(int r, int g, int b, int most = 20) {
  for (int k = 0; k < kCodes; ++k) {
    const auto c = code_of(k);
    if (std::max({std::abs(c[0] - r), std::abs(c[1] - g), std::abs(c[2] - b)}) <= most) return k;
  }
  return -1;
}

/// `ffmpeg` with these arguments, in `folder`. Returns its last words, empty where all went well.
inline std::string ffmpeg(const TemporaryFolder& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"ffmpeg", "-hide_banner", "-nostdin", "-loglevel", "error", "-y"});
  const sequences::ChildResult child = sequences::run_child(arguments, {folder.path(), {}, {}});
  return child.succeeded() ? "" : child.reason();
}

/// Writes NAME with `frames` coded frames of `size` ("64x48") at `rate`; `coding`: options of the output.
inline std::string write_coded(const TemporaryFolder& folder, const std::string& name, int width, int height,
                               const std::string& rate, int frames, const std::vector<std::string>& coding) {
  std::string raw;
  for (int k = 0; k < frames; ++k)
    for (int i = 0; i < width * height; ++i)
      for (const std::uint8_t c : code_of(k % kCodes)) raw += static_cast<char>(c);
  folder.write(name + ".raw", raw);
  std::vector<std::string> a = {
      "-f",         "rawvideo",    "-pixel_format",
      "rgb24",      "-video_size", std::to_string(width) + "x" + std::to_string(height),
      "-framerate", rate,          "-i",
      name + ".raw"};
  a.insert(a.end(), coding.begin(), coding.end());
  a.push_back(name);
  return ffmpeg(folder, a);
}

}  // namespace talisman::tests
