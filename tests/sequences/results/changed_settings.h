// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Settings of which one field is another one than by default.

#include <cmath>
#include <string>
#include <type_traits>

#include "sequences/results/settings_fields.h"

namespace talisman::sequences {

inline void change(bool& value) { value = !value; }
inline void change(layers::ivec2& value) { value.y += 1; }
inline void change(layers::dvec2& value) { value.y += 1; }
inline void change(std::optional<chunker::CompressionOptions>& value) { value.emplace().quality = 7; }
inline void change(std::vector<layers::ExplicitPair>& value) { value.push_back({0, 1}); }
inline void change(VisibilityOptions& value) { value.objects = ViewTest::Frustum; }
inline void change(std::int64_t& value) { value -= 1; }
template <typename T>
void change(T& value) {
  if constexpr (std::is_enum_v<T>)
    value = static_cast<T>(value == T{} ? 1 : static_cast<int>(value) - 1);
  else
    value = std::isfinite(static_cast<double>(value)) ? value + 1 : T(1);
}

struct ChangedSettings {
  Settings settings;
  std::string field;  ///< that was changed; empty: there are not that many
};

/// The `which`th field of the list is changed.
inline ChangedSettings changed_settings(int which) {
  ChangedSettings changed;
  int k = 0;
  for_each_setting(changed.settings, [&](const char* name, auto& value) {
    if (k++ != which) return;
    changed.field = name;
    change(value);
  });
  return changed;
}

}  // namespace talisman::sequences
