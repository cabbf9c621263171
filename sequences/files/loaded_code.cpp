// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/loaded_code.h"

#include <link.h>
#include <sys/stat.h>

#include <filesystem>

#include "sequences/files/program_folder.h"

namespace talisman::sequences {
namespace {

int add_name(dl_phdr_info* info, std::size_t, void* names) {
  // The program itself has no name, the kernel's own page has one without a folder.
  if (info->dlpi_name[0] == '/') static_cast<std::vector<std::string>*>(names)->push_back(info->dlpi_name);
  return 0;
}

ContentHash hash_now() {
  const std::vector<std::string> files = loaded_code();
  ContentHasher hasher;
  hasher.add(hash_of_file(files.front()).value_or(ContentHash{}));
  for (const std::string& file : files) hasher.add(file).add(stamp_of(file));
  hasher.add(stamp_of(program_module("talisman_pictures.so")));  // may be loaded later
  return hasher.hash();
}

}  // namespace

std::vector<std::string> loaded_code() {
  std::error_code error;
  std::vector<std::string> files{std::filesystem::read_symlink("/proc/self/exe", error).string()};
  ::dl_iterate_phdr(add_name, &files);
  return files;
}

ContentHash stamp_of(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return {};
  return ContentHasher().add(status.st_size).add(status.st_mtim.tv_sec).add(status.st_mtim.tv_nsec).hash();
}

const ContentHash& hash_of_loaded_code() {
  static const ContentHash hash = hash_now();
  return hash;
}

}  // namespace talisman::sequences
