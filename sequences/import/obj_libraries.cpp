// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/obj_libraries.h"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "sequences/files/quoted.h"
#include "sequences/import/obj_text.h"
#include "sequences/import/wide_text.h"

namespace talisman::sequences {

std::string rest_of_line(const std::string& line, std::size_t from) {
  const std::size_t first = line.find_first_not_of(" \t", from), last = line.find_last_not_of(" \t\r");
  return first == std::string::npos || last < first ? std::string() : line.substr(first, last - first + 1);
}

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

/// By the rules by which assimp, which reads it, finds it.
bool ObjLibraries::add(const std::string& name) {
  const std::string folder = std::filesystem::absolute(place_.path).parent_path().string();
  const std::string found = find_file(place_, folder + "/" + name, files_);
  if (found.empty()) return false;
  lines_ += "mtllib " + name + "\n";
  ObjText text(open_text(found));
  std::istream in(&text);
  for (std::string line; std::getline(in, line);) {
    const std::size_t at = line.find_first_not_of(" \t");
    if (at != std::string::npos && line.compare(at, 6, "newmtl") == 0)
      materials_.insert(rest_of_line(line, at + 6));
  }
  return true;
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
    if (!name.empty() && !materials_.contains(name)) names.push_back(name);
  if (names.empty()) return {};
  const bool is_one = names.size() == 1;
  return (is_one ? "material " : "materials ") + quoted(names) + (is_one ? " is" : " are") + " in no library";
}

}  // namespace talisman::sequences
