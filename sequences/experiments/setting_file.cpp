// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/setting_file.h"

#include <cctype>

namespace talisman::sequences {

std::string file_name_of(const std::string& setting) {
  std::string name;
  for (const char c : setting) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.';
    if (is_plain || (!name.empty() && name.back() != '-')) name += is_plain ? c : '-';
  }
  return name;
}

}  // namespace talisman::sequences
