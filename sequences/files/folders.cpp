// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/folders.h"

#include <filesystem>

#include "sequences/files/temporary_files.h"

namespace talisman::sequences {

void create_folder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw OutputError(path + ": cannot be created: " + error.message());
}

void prepare_folder(const std::string& path) {
  create_folder(path);
  remove_abandoned_files(path);
}

}  // namespace talisman::sequences
