// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which effects does this build have? (What that is for: layers/effect.h.)
///
/// Each file that asks says in the CMakeLists.txt of its folder, under EFFECTS, for which effects it does,
/// and is told of no others. So it is known which files an effect is decided on in, and a build without it
/// compiles only those anew.

#include "layers/effect.h"

// Names separated by commas, from CMake: the effects that this file may ask for, and those of them that are
// left out.
#ifndef TALISMAN_ASKS
#error "files that ask which effects are built are listed under EFFECTS in the CMakeLists.txt of their folder"
#define TALISMAN_ASKS ""
#define TALISMAN_WITHOUT ""
#endif

namespace talisman::layers {

/// Is `name` one of the names in a list like "shadow_map,texture"?
constexpr bool is_listed(std::string_view name, std::string_view names) {
  while (!names.empty()) {
    const std::string_view first = names.substr(0, names.find(','));
    if (first == name) return true;
    names.remove_prefix(first.size() < names.size() ? first.size() + 1 : first.size());
  }
  return false;
}

/// All effects but those in a list.
constexpr EffectSet effects_without(std::string_view names) {
  EffectSet built{};
  for (const Effect effect : kAllEffects)
    built[static_cast<std::size_t>(effect)] = !is_listed(name(effect), names);
  return built;
}

/// A constant; asking for an effect that the file is not told of does not compile.
consteval bool is_built(Effect effect) {
  if (!is_listed(name(effect), TALISMAN_ASKS)) throw "list this effect for this file under EFFECTS";
  return !is_listed(name(effect), TALISMAN_WITHOUT);
}

/// A whole number as a T; 0 is T{}, so null where T is a pointer.
template <typename T, int kNumber>
consteval T constant_of() {
  if constexpr (kNumber == 0)
    return T{};
  else
    return static_cast<T>(kNumber);
}

/// A value that only an effect gives a meaning. In a build without the effect it is the constant `kAbsent`
/// and takes no room, so that whatever depends on it folds away.
template <Effect kEffect, typename T, int kAbsent = 0, bool kBuilt = is_built(kEffect)>
class ValueOf {
 public:
  constexpr ValueOf() = default;
  constexpr ValueOf(T value) : value_(value) {}
  constexpr operator T() const { return value_; }
  constexpr T operator->() const { return value_; }

 private:
  T value_ = constant_of<T, kAbsent>();
};

template <Effect kEffect, typename T, int kAbsent>
class ValueOf<kEffect, T, kAbsent, false> {
 public:
  constexpr ValueOf() = default;
  constexpr ValueOf(T) {}
  constexpr operator T() const { return constant_of<T, kAbsent>(); }
  constexpr T operator->() const { return constant_of<T, kAbsent>(); }
};

}  // namespace talisman::layers
