// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/nearest_word.h"

#include <algorithm>
#include <vector>

namespace talisman::sequences {

int edit_distance(std::string_view a, std::string_view b) {
  // d[i][j]: distance of the first i letters of a from the first j of b.
  std::vector<std::vector<int>> d(a.size() + 1, std::vector<int>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = static_cast<int>(i + j);
        continue;
      }
      const int changed = d[i - 1][j - 1] + (a[i - 1] != b[j - 1]);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, changed});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

std::string nearest_word(std::string_view written, std::span<const std::string> known) {
  int least = std::max(1, static_cast<int>(written.size()) / 3) + 1;
  std::string nearest;
  for (const std::string& word : known)
    if (const int distance = edit_distance(written, word); distance < least) least = distance, nearest = word;
  return nearest;
}

}  // namespace talisman::sequences
