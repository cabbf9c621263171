// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/program_folder.h"

#include <filesystem>

namespace talisman::sequences {

std::string program_folder() {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error).parent_path().string();
}

}  // namespace talisman::sequences
