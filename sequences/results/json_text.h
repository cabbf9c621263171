// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Texts of files that anybody may have edited.

#include <string>

#include <nlohmann/json.hpp>

namespace talisman::sequences {

/// The text behind a key; `otherwise` where there is none, or something else than a text.
inline std::string text_in(const nlohmann::ordered_json& json, const char* key,
                           const std::string& otherwise = "") {
  const auto found = json.is_object() ? json.find(key) : json.end();
  return found != json.end() && found->is_string() ? found->get<std::string>() : otherwise;
}

}  // namespace talisman::sequences
