// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/nearest_word.h"

#include <algorithm>

namespace talisman::sequences {

namespace {

constexpr std::size_t kLettersPerEdit = 3;
constexpr std::size_t kLettersOfABeginning = 3;

/// Optimal string alignment: the Levenshtein distance in which exchanging two neighbours is one edit too.
std::size_t edits(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before, last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before = last;
    last = row;
  }
  return last[b.size()];
}

}  // namespace

std::string nearest_word(const std::string& written, const std::vector<std::string>& words) {
  // Who wrote the beginning of one word meant that one, however much is missing.
  const auto begun = [&](const std::string& word) { return word.starts_with(written); };
  if (written.size() >= kLettersOfABeginning && std::count_if(words.begin(), words.end(), begun) == 1)
    return *std::find_if(words.begin(), words.end(), begun);
  std::string nearest;
  std::size_t fewest = written.size() / kLettersPerEdit + 1;
  for (const std::string& word : words) {
    // Each letter more or less is an edit: what is much longer need not be compared.
    const std::size_t longer = std::max(word.size(), written.size());
    if (longer - std::min(word.size(), written.size()) >= fewest) continue;
    if (const std::size_t n = edits(written, word); n < fewest) nearest = word, fewest = n;
  }
  return nearest;
}

std::string did_you_mean(const std::string& written, const std::vector<std::string>& words) {
  const std::string nearest = nearest_word(written, words);
  return nearest.empty() ? "" : "; did you mean '" + nearest + "'";
}

}  // namespace talisman::sequences
