// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/kept_pictures.h"

#include <algorithm>
#include <charconv>
#include <filesystem>

namespace talisman::sequences {

SeparateNames separate_names(const RunOptions& options) {
  SeparateNames names;
  std::error_code error;
  if (!options.separate) return names;
  for (std::filesystem::directory_iterator it(options.out + "/separate", error), end; !error && it != end;
       it.increment(error)) {
    const std::string name = it->path().filename().string();
    int frame = 0;
    const auto [digits_end, wrong] = std::from_chars(name.data(), name.data() + name.size(), frame);
    if (wrong == std::errc() && *digits_end == '-') names[frame].push_back(name);
  }
  return names;
}

std::string picture_hash(const RunOptions& options, const std::optional<ContentHash>& frame,
                         std::vector<std::string> separate) {
  if (separate.empty()) return frame ? frame->hex() : std::string();
  std::sort(separate.begin(), separate.end());
  ContentHasher all;
  if (frame) all.add(*frame);
  for (const std::string& name : separate) {
    const std::optional<ContentHash> file = hash_of_file(options.out + "/separate/" + name);
    if (!file) return {};
    all.add(name).add(*file);
  }
  return all.hash().hex();
}

}  // namespace talisman::sequences
