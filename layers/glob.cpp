// SPDX-License-Identifier: Apache-2.0
#include "layers/glob.h"

namespace talisman::layers {

namespace {

/// Is what begins here a star or a question mark that means itself?
bool is_escaped(const std::string& glob, std::size_t at) {
  return glob[at] == '\\' && at + 1 < glob.size() && (glob[at + 1] == '*' || glob[at + 1] == '?');
}

}  // namespace

bool glob_matches(const std::string& glob, const std::string& text) {
  // Greedy with one point of return: only the last '*' ever needs to take more.
  std::size_t g = 0, t = 0, star = std::string::npos, star_t = 0;
  while (t < text.size()) {
    const std::size_t escape = g < glob.size() && is_escaped(glob, g) ? 1 : 0;
    if (g < glob.size() && glob[g] == '*') {
      star = g++;
      star_t = t;
    } else if (g < glob.size() && (glob[g] == '?' || glob[g + escape] == text[t])) {
      g += 1 + escape, ++t;
    } else if (star != std::string::npos) {
      g = star + 1;
      t = ++star_t;
    } else {
      return false;
    }
  }
  return glob.find_first_not_of('*', g) == std::string::npos;
}

bool has_wildcard(const std::string& glob) {
  for (std::size_t i = 0; i < glob.size(); i += is_escaped(glob, i) ? 2 : 1)
    if (glob[i] == '*' || glob[i] == '?') return true;
  return false;
}

std::string name_of_glob(const std::string& glob) {
  std::string name;
  for (std::size_t i = 0; i < glob.size(); ++i) {
    if (is_escaped(glob, i)) ++i;
    name += glob[i];
  }
  return name;
}

std::string glob_of_name(const std::string& name) {
  std::string glob;
  for (const char c : name) {
    if (c == '*' || c == '?') glob += '\\';
    glob += c;
  }
  return glob;
}

}  // namespace talisman::layers
