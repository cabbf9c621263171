// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Names of files whose case says nothing: "SHIP.OBJ" is an OBJ.

#include <cctype>
#include <filesystem>
#include <string>

namespace talisman::sequences {

/// ASCII letters in lower case, all else as it is.
inline std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// ".obj" of "hangar/SHIP.OBJ"; empty where there is none.
inline std::string lower_extension(const std::filesystem::path& path) {
  return lower(path.extension().string());
}

}  // namespace talisman::sequences
