// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/surfaces/obj_faults.h"

#include <cstdlib>
#include <sstream>

#include "sequences/import/wide_text.h"

namespace talisman::sequences {

namespace {

bool begins(const std::string& line, const char* keyword) {
  const std::size_t at = line.find_first_not_of(" \t");
  const std::string word = std::string(keyword) + " ";
  return at != std::string::npos && line.compare(at, word.size(), word) == 0;
}

long vertices_in(const std::string& path) {
  const auto file = open_text(path);
  long count = 0;
  for (std::string line; std::getline(*file, line);) count += begins(line, "v") ? 1 : 0;
  return count;
}

/// The vertex that is not among `total`, or of the `so_far` that a negative number counts back through; empty: none.
std::string absent_vertex(const std::string& line, long so_far, long total) {
  std::istringstream words(line);
  std::string word;
  words >> word;
  while (words >> word && word[0] != '#') {
    const long number = std::strtol(word.c_str(), nullptr, 10);
    if (number == 0 || number > total || number < -so_far) return word.substr(0, word.find('/'));
  }
  return {};
}

}  // namespace

std::string line_of(const std::string& path, const std::string& statement) {
  const auto file = open_text(path);
  std::string line;
  for (std::size_t number = 1; std::getline(*file, line); ++number)
    if (line.find(statement) != std::string::npos) return "line " + std::to_string(number) + ": ";
  return {};
}

std::string bad_face(const std::string& path) {
  const long total = vertices_in(path);
  const auto file = open_text(path);
  long so_far = 0;
  std::string line;
  for (std::size_t number = 1; std::getline(*file, line); ++number) {
    so_far += begins(line, "v") ? 1 : 0;
    if (!begins(line, "f")) continue;
    const std::string absent = absent_vertex(line, so_far, total);
    if (absent.empty()) continue;
    const std::string there = std::to_string(total);
    return "line " + std::to_string(number) + ": '" +
           line.substr(0, line.find_last_not_of("\r") + 1).substr(0, 60) + "' names vertex " + absent +
           ", rule: from 1 to " + there + ", or counted back by at most those before it";
  }
  return {};
}

}  // namespace talisman::sequences
