// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/file_text.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace talisman::sequences {

namespace {

namespace fs = std::filesystem;

/// Of what a link leads to; none where that is not there, or nobody may look.
fs::file_type type_of(const std::string& path) {
  std::error_code error;
  return fs::status(path, error).type();
}

bool is_nothing(fs::file_type type) {
  return type == fs::file_type::not_found || type == fs::file_type::none;
}

const char* in_words(fs::file_type type) {
  return type == fs::file_type::directory ? "is a folder" : "is no file";
}

}  // namespace

std::optional<std::string> text_of_file(const std::string& path) {
  const fs::file_type type = type_of(path);
  if (is_nothing(type)) return std::nullopt;
  if (type != fs::file_type::regular) throw InputError(std::string(in_words(type)) + ", rule: a file", path);
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(std::string("cannot be read: ") + std::strerror(errno), path);
  try {
    return std::string(std::istreambuf_iterator<char>(in), {});
  } catch (const std::ios_base::failure&) {
    throw InputError(std::string("cannot be read: ") + std::strerror(errno), path);
  }
}

void require_file_or_nothing(const std::string& path) {
  const fs::file_type type = type_of(path);
  if (!is_nothing(type) && type != fs::file_type::regular)
    throw InputError(std::string(in_words(type)) + ", rule: nothing, or a file that may be written over",
                     path);
}

void require_folder_or_nothing(const std::string& path) {
  const fs::file_type type = type_of(path);
  if (!is_nothing(type) && type != fs::file_type::directory)
    throw InputError("is no folder, rule: a folder or nothing", path);
}

}  // namespace talisman::sequences
