// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/starter/part_globs.h"
#include "layers/glob.h"

#include <algorithm>
#include <cctype>

namespace talisman::sequences {

namespace {

std::string common_beginning(const std::vector<int>& parts, const std::vector<std::string>& names) {
  std::string common = names[parts.front()];
  for (const int part : parts) {
    const std::string& name = names[part];
    const auto end = std::mismatch(common.begin(), common.end(), name.begin(), name.end()).first;
    common.erase(end, common.end());
  }
  return common;
}

/// The beginning is not cut in the middle of a word, nor before the "/" that ends a node's name.
bool is_cut(const std::string& text, std::size_t at) {
  if (at < text.size() && text[at] == '/') return false;
  return at == text.size() || !std::isalnum(static_cast<unsigned char>(text[at - 1])) ||
         !std::isalnum(static_cast<unsigned char>(text[at]));
}

bool names_alone(const std::string& glob, const std::vector<int>& parts,
                 const std::vector<std::string>& names, const std::vector<bool>& taken) {
  for (std::size_t i = 0; i < names.size(); ++i)
    if (!taken[i] && layers::glob_matches(glob, names[i]) !=
                         std::binary_search(parts.begin(), parts.end(), static_cast<int>(i)))
      return false;
  return true;
}

std::vector<std::string> globs_of(const std::vector<int>& parts, const std::vector<std::string>& names,
                                  const std::vector<bool>& taken) {
  const std::string common = parts.size() > 1 ? common_beginning(parts, names) : "";
  for (std::size_t at = 1; at <= common.size(); ++at) {
    const std::string glob = layers::glob_of_name(common.substr(0, at)) + "*";
    if (is_cut(common, at) && names_alone(glob, parts, names, taken)) return {glob};
  }
  std::vector<std::string> globs;
  for (const int part : parts) globs.push_back(layers::glob_of_name(names[part]));
  return globs;
}

}  // namespace

std::vector<std::vector<std::string>> part_globs(std::span<const layers::Layer> layers,
                                                 const std::vector<std::string>& names) {
  std::vector<std::vector<std::string>> globs;
  std::vector<bool> taken(names.size());
  for (const layers::Layer& layer : layers) {
    if (layer.base >= 0) continue;
    globs.push_back(globs_of(layer.parts, names, taken));
    for (const int part : layer.parts) taken[part] = true;
  }
  return globs;
}

}  // namespace talisman::sequences
