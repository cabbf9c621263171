// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Numbers of things in a sentence: "1 part", "12 parts".

#include <cstddef>
#include <string>

namespace talisman::sequences {

inline std::string how_many(std::size_t n, const std::string& thing) {
  return std::to_string(n) + " " + thing + (n == 1 ? "" : "s");
}

}  // namespace talisman::sequences
