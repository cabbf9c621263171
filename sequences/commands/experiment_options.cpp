// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/experiment_options.h"

#include <array>

#include "sequences/files/errors.h"

namespace talisman::sequences {
namespace {

template <typename Kind, std::size_t N>
Kind chosen(const std::string& option, const std::string& name,
            const std::array<std::pair<const char*, Kind>, N>& kinds) {
  std::string known;
  for (const auto& [word, kind] : kinds) {
    if (name == word) return kind;
    known += std::string(known.empty() ? "" : ", ") + word;
  }
  throw InputError(option + " '" + name + "', rule: one of " + known);
}

}  // namespace

ProgressKind progress_kind_from(const std::string& name) {
  return chosen("--progress", name,
                std::array{std::pair{"auto", ProgressKind::Auto}, std::pair{"bar", ProgressKind::Bar},
                           std::pair{"plain", ProgressKind::Plain}, std::pair{"none", ProgressKind::None}});
}

layers::BoundKind bound_kind_from(const std::string& name) {
  using layers::BoundKind;
  return chosen("--bound", name,
                std::array{std::pair{"box8", BoundKind::Box8}, std::pair{"dop14", BoundKind::Dop14},
                           std::pair{"dop26", BoundKind::Dop26}});
}

}  // namespace talisman::sequences
