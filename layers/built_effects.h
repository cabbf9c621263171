// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which effects does this build have? (What that is for: layers/effect.h.)
///
/// A header of its own, and known only to the files that ask (EFFECTS in their CMakeLists.txt), so that a build
/// without an effect compiles nothing else anew.

#include "layers/effect.h"

// The names of the effects that are left out, separated by commas; from CMake's TALISMAN_WITHOUT.
#ifndef TALISMAN_WITHOUT
#error "files that ask which effects are built are listed under EFFECTS in the CMakeLists.txt of their folder"
#endif

namespace talisman::layers {

/// All effects but those in a list of names like "shadow_map,texture".
constexpr EffectSet effects_without(std::string_view names) {
  EffectSet built{};
  built.fill(true);
  while (!names.empty()) {
    const std::string_view first = names.substr(0, names.find(','));
    names.remove_prefix(first.size() < names.size() ? first.size() + 1 : first.size());
    for (std::size_t e = 0; e < built.size(); ++e) built[e] = built[e] && kEffectNames[e] != first;
  }
  return built;
}

inline constexpr EffectSet kBuiltEffects = effects_without(TALISMAN_WITHOUT);

constexpr bool is_built(Effect effect) { return kBuiltEffects[static_cast<std::size_t>(effect)]; }

/// A value that only an effect gives a meaning. In a build without the effect it is the constant `kAbsent`
/// and takes no room, so that whatever depends on it folds away.
template <Effect kEffect, typename T, T kAbsent = T{}, bool kBuilt = is_built(kEffect)>
class ValueOf {
 public:
  constexpr ValueOf() = default;
  constexpr ValueOf(T value) : value_(value) {}
  constexpr operator T() const { return value_; }
  constexpr T operator->() const { return value_; }

 private:
  T value_ = kAbsent;
};

template <Effect kEffect, typename T, T kAbsent>
class ValueOf<kEffect, T, kAbsent, false> {
 public:
  constexpr ValueOf() = default;
  constexpr ValueOf(T) {}
  constexpr operator T() const { return kAbsent; }
  constexpr T operator->() const { return kAbsent; }
};

}  // namespace talisman::layers
