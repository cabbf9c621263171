// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/surfaces/obj_libraries.h"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "sequences/files/quoted.h"

namespace talisman::sequences {

ObjLibraries::ObjLibraries(const ModelPlace& place, const std::vector<std::string>& written, FileUses& files)
    : place_(place), files_(files) {
  for (const std::string& names : written) add_line(names);
}

/// One name, which may have spaces, or several.
void ObjLibraries::add_line(const std::string& names) {
  if (names.empty() || add(names)) return;
  std::istringstream words(names);
  std::vector<std::string> absent;
  bool has_one = false;
  for (std::string word; words >> word;) {
    if (add(word))
      has_one = true;
    else
      absent.push_back(word);
  }
  if (!has_one) absent = {names};
  for (const std::string& name : absent) add_missing(name);
}

bool ObjLibraries::add(const std::string& name) {
  const std::string found = find_file(place_, name, files_);
  if (found.empty()) return false;
  materials_.merge(read_obj_materials(found));
  return true;
}

const ObjMaterial* ObjLibraries::find(const std::string& name) const {
  const auto found = materials_.find(name);
  return found == materials_.end() ? nullptr : &found->second;
}

void ObjLibraries::add_missing(const std::string& name) {
  const std::string own = std::filesystem::path(place_.path).stem().string() + ".mtl";
  std::string text = "material library '" + name + "' is missing";
  if (add(own)) text += "; '" + own + "' takes its place";
  if (std::find(missing_.begin(), missing_.end(), text) == missing_.end()) missing_.push_back(text);
}

std::string ObjLibraries::unknown(const std::vector<std::string>& used) const {
  std::vector<std::string> names;
  for (const std::string& name : used)
    if (!name.empty() && !find(name)) names.push_back(name);
  if (names.empty()) return {};
  const bool is_one = names.size() == 1;
  return (is_one ? "material " : "materials ") + quoted(names) + (is_one ? " is" : " are") + " in no library";
}

}  // namespace talisman::sequences
