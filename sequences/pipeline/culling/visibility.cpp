// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/culling/visibility.h"

#include <array>

namespace talisman::sequences {
namespace {

constexpr std::array<std::string_view, 3> kPrecomputedWords{"none", "ctc", "cto"};
constexpr std::array<std::string_view, 3> kTestWords{"none", "frustum", "eye"};

int place_of(std::string_view word, const std::array<std::string_view, 3>& words) {
  for (std::size_t i = 0; i < words.size(); ++i)
    if (words[i] == word) return static_cast<int>(i);
  return -1;
}

}  // namespace

std::string text_of(const VisibilityOptions& options) {
  return std::string(kPrecomputedWords[static_cast<int>(options.precomputed)]) + "," +
         std::string(kTestWords[static_cast<int>(options.cells)]) + "," +
         std::string(kTestWords[static_cast<int>(options.objects)]);
}

std::optional<VisibilityOptions> visibility_from(std::string_view text) {
  const std::size_t first = text.find(','), second = text.find(',', first + 1);
  if (first == std::string_view::npos || second == std::string_view::npos) return std::nullopt;
  const int precomputed = place_of(text.substr(0, first), kPrecomputedWords),
            cells = place_of(text.substr(first + 1, second - first - 1), kTestWords),
            objects = place_of(text.substr(second + 1), kTestWords);
  if (precomputed < 0 || cells < 0 || objects < 0) return std::nullopt;
  const VisibilityOptions options{static_cast<Precomputed>(precomputed), static_cast<ViewTest>(cells),
                                  static_cast<ViewTest>(objects)};
  if (options.objects == ViewTest::Eye && options.cells != ViewTest::Eye) return std::nullopt;
  return options;
}

}  // namespace talisman::sequences
