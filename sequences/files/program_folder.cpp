// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/program_folder.h"

#include <dlfcn.h>
#include <link.h>

#include <cstdlib>
#include <filesystem>
#include <vector>

#include "sequences/files/errors.h"

namespace talisman::sequences {

namespace {

namespace fs = std::filesystem;

/// The file from which this code was loaded; empty when it is the program itself.
fs::path shared_module() {
  Dl_info info{};
  link_map* map = nullptr;
  const void* here = reinterpret_cast<const void*>(&program_folder);
  if (::dladdr1(here, &info, reinterpret_cast<void**>(&map), RTLD_DL_LINKMAP) == 0) return {};
  // Only of the program itself has the dynamic linker no name.
  return map && map->l_name ? fs::path(map->l_name) : fs::path();
}

/// `folder` and those above it, the nearest first.
std::vector<fs::path> upwards(fs::path folder) {
  std::vector<fs::path> folders;
  for (; !folder.empty(); folder = folder.parent_path()) {
    folders.push_back(folder);
    if (folder == folder.root_path()) break;
  }
  return folders;
}

std::vector<fs::path> places() {
  std::vector<fs::path> folders = upwards(program_folder());
  const char* home = std::getenv("TALISMAN_HOME");
  if (home && *home) folders.emplace_back(home);
  return folders;
}

bool has_sequences(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / "sequences" / "fetch-assets", error);
}

/// The file of that name beside the program, else in `installed` of an installation or in bin/ of a build tree.
std::string beside_or_in(const char* name, const char* installed) {
  std::error_code error;
  const fs::path beside = fs::path(program_folder()) / name;
  if (fs::is_regular_file(beside, error)) return beside.string();
  for (const fs::path& folder : places())
    for (const char* inside : {installed, "bin"})
      if (const fs::path file = folder / inside / name; fs::is_regular_file(file, error))
        return file.string();
  return beside.string();
}

}  // namespace

std::string program_folder() {
  std::error_code error;
  const fs::path module = shared_module();
  const fs::path file =
      module.empty() ? fs::read_symlink("/proc/self/exe", error) : fs::canonical(module, error);
  return file.parent_path().string();
}

std::string importer_program() { return beside_or_in("talisman_import", TALISMAN_LIBEXEC_FOLDER); }

std::string program_module(const std::string& file) {
  return beside_or_in(file.c_str(), TALISMAN_LIB_FOLDER);
}

void* program_symbol(const std::string& module, const char* symbol, const std::string& what_cannot_be_done) {
  const std::string file = program_module(module);
  void* const loaded = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* const found = loaded ? ::dlsym(loaded, symbol) : nullptr;
  if (found) return found;
  const char* why = ::dlerror();
  throw OutputError(what_cannot_be_done + ": " + std::string(why ? why : file));
}

std::string data_folder() {
  for (const fs::path& folder : places())
    for (const fs::path& root : {folder, folder / TALISMAN_DATA_FOLDER})
      if (has_sequences(root)) return root.string();
  std::error_code error;
  for (const fs::path& folder : upwards(fs::current_path(error)))
    if (has_sequences(folder)) return folder.string();
  return {};
}

}  // namespace talisman::sequences
