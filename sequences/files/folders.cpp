// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/folders.h"

#include <filesystem>

#include "sequences/files/atomic_file.h"
#include "sequences/files/file_text.h"
#include "sequences/files/temporary_files.h"

namespace talisman::sequences {

void create_folder(const std::string& path) {
  require_folder_or_nothing(path);
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error == std::errc::not_a_directory)
    throw InputError("stands below a file, rule: a folder or nothing", path);
  if (error) throw OutputError(path + ": cannot be created: " + error.message());
}

void prepare_folder(const std::string& path) {
  create_folder(path);
  remove_abandoned_files(path);
}

void begin_report_folder(const std::string& path, const std::string& mark, const std::string& kind) {
  namespace fs = std::filesystem;
  std::error_code error;
  const bool is_ours =
      fs::exists(path + "/" + mark, error) || fs::exists(path + "/" + mark + ".partial", error);
  const bool is_there = fs::exists(path, error);
  if (is_there && !is_ours && !(fs::is_directory(path, error) && fs::is_empty(path, error)))
    throw InputError(
        "holds files that are not of " + kind + ", rule for --out: an empty folder, or one of " + kind, path);
  prepare_folder(path);
  write_text_atomically(path + "/" + mark + ".partial", "");
}

void finish_report_folder(const std::string& path, const std::string& mark) {
  std::error_code ignored;
  std::filesystem::remove(path + "/" + mark + ".partial", ignored);
}

}  // namespace talisman::sequences
