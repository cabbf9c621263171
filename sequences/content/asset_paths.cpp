// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/asset_paths.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "sequences/files/program_folder.h"

namespace talisman::sequences {

namespace {

namespace fs = std::filesystem;

/// A source tree is where its programs are built; an installation has its sequences alone.
bool is_source_tree(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / "CMakeLists.txt", error);
}

/// $XDG_DATA_HOME; the XDG base directory specification has it ignored when it is relative.
fs::path user_data_folder() {
  const char* chosen = std::getenv("XDG_DATA_HOME");
  if (chosen && *chosen == '/') return chosen;
  const char* home = std::getenv("HOME");
  return fs::path(home && *home ? home : "/") / ".local" / "share";
}

fs::path assets_folder() {
  const char* chosen = std::getenv("TALISMAN_ASSETS");
  if (chosen && *chosen) return chosen;
  const fs::path data = data_folder();
  return is_source_tree(data) ? data / "assets" : user_data_folder() / "talisman" / "assets";
}

/// "gl-117-data" of "gl-117-data:/usr/share/…"; empty when the path names no package. Debian Policy 5.6.7:
/// lower case letters, digits and + - . — so a package never leads out of the assets folder.
std::string package_of(const std::string& path) {
  const std::size_t colon = path.find(":/");
  if (colon == std::string::npos || colon < 2) return {};
  const std::string package = path.substr(0, colon);
  const bool well_formed =
      package.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789+-.") == std::string::npos;
  return well_formed && package[0] != '.' ? package : std::string();
}

/// The name by which the tool's user knows a sequence file: that of its folder.
std::string fetch_name(const std::string& sequence_file) {
  const std::string folder = fs::absolute(sequence_file).parent_path().filename().string();
  return sequence_file_of(folder).empty() ? sequence_file : folder;
}

}  // namespace

std::string fetch_command(const std::string& name) {
  const std::string data = data_folder();
  const std::string folder = data.empty() || is_source_tree(data) ? "" : data + "/";
  return folder + "sequences/fetch-assets " + name;
}

namespace {

/// What `path` means, if it is there. `is_there` says so of a path, `what` names what is asked for.
template <typename IsThere>
std::string resolve(const std::string& path, const std::string& sequence_file, int line, const char* what,
                    const IsThere& is_there) {
  std::error_code error;
  const std::string package = package_of(path);
  if (!package.empty()) {
    const fs::path folder = assets_folder() / package;
    const fs::path found = folder.string() + path.substr(package.size() + 1);
    if (is_there(found)) return found.string();
    if (fs::is_directory(folder, error))
      throw InputError(
          "'" + path + "' is not in package " + package + ", rule: a " + what + " of the package",
          sequence_file, line);
    throw InputError("'" + path + "' is not there, rule: content is fetched first, by " +
                         fetch_command(fetch_name(sequence_file)),
                     sequence_file, line);
  }
  const fs::path found =
      fs::path(path).is_absolute() ? fs::path(path) : fs::path(sequence_file).parent_path() / path;
  if (!is_there(found))
    throw InputError(
        "'" + path + "' is not there, rule: a " + what + ", as package:/path or relative to this file",
        sequence_file, line);
  return found.string();
}

}  // namespace

std::string resolve_asset(const std::string& path, const std::string& sequence_file, int line) {
  return resolve(path, sequence_file, line, "file", [](const fs::path& found) {
    std::error_code error;
    return fs::is_regular_file(found, error);
  });
}

std::string resolve_folder(const std::string& path, const std::string& sequence_file, int line) {
  return resolve(path.empty() ? "." : path, sequence_file, line, "folder", [](const fs::path& found) {
    std::error_code error;
    return fs::is_directory(found, error);
  });
}

std::string content_name(const std::string& path, const std::string& sequence_file) {
  std::error_code error;
  const fs::path file = fs::weakly_canonical(path, error);
  const fs::path in_assets = file.lexically_relative(fs::weakly_canonical(assets_folder(), error));
  if (!in_assets.empty() && *in_assets.begin() != "..") {
    const std::string package = in_assets.begin()->string();
    return package + ":" + in_assets.generic_string().substr(package.size());
  }
  const fs::path folder = fs::weakly_canonical(sequence_file, error).parent_path();
  return file.lexically_relative(folder).generic_string();
}

std::string sequence_file_of(const std::string& name) {
  const std::string root = data_folder();
  if (root.empty() || name.empty() || name.find("..") != std::string::npos) return {};
  const std::size_t slash = name.find('/');
  const std::string stem = slash == std::string::npos ? name + "/" + name : name;
  const std::string file = root + "/sequences/" + stem + ".yaml";
  std::error_code error;
  return fs::is_regular_file(file, error) ? file : std::string();
}

std::vector<std::string> sequence_names() {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& folder : fs::directory_iterator(data_folder() + "/sequences", error)) {
    if (!folder.is_directory()) continue;
    const std::string name = folder.path().filename().string();
    for (const auto& file : fs::directory_iterator(folder.path(), error)) {
      const std::string stem = file.path().stem().string();
      if (file.path().extension() != ".yaml") continue;
      names.push_back(stem == name ? name : name + "/" + stem);
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace talisman::sequences
