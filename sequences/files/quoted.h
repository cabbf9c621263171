// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Names in a message: "'a', 'b', 'c', 'd', 'e' and 7 more".

#include <string>
#include <vector>

namespace talisman::sequences {

inline constexpr std::size_t kMostNames = 5;

inline std::string quoted(const std::vector<std::string>& names, std::size_t most = kMostNames) {
  std::string text;
  for (std::size_t k = 0; k < names.size() && k < most; ++k)
    text += (text.empty() ? "'" : ", '") + names[k] + "'";
  return names.size() > most ? text + " and " + std::to_string(names.size() - most) + " more" : text;
}

}  // namespace talisman::sequences
