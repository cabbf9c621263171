// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/folders.h"

#include <filesystem>

namespace talisman::sequences {

void create_folder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw OutputError(path + ": cannot be created: " + error.message());
}

}  // namespace talisman::sequences
