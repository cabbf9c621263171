// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/reason_tally.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <sstream>
#include <utility>

#include "sequences/files/number_text.h"
#include "sequences/results/reason_kind.h"

namespace talisman::sequences {

namespace {

std::optional<double> number_from(const std::string& word) {
  char* end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  if (word.empty() || *end != '\0') return std::nullopt;
  return value;
}

bool is_relation(const std::string& word) {
  return word == ">" || word == "<" || word == ">=" || word == "<=";
}

}  // namespace

ReasonKind kind_of_reason(const std::string& reason) {
  ReasonKind kind{{}, {}, {}, 1};
  // What follows a semicolon or a bracket says more about it; what follows a comma, how it came to be.
  std::istringstream in(reason.substr(0, reason.find_first_of(";(,")));
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  std::size_t shown = words.size();
  for (std::size_t i = 1; i + 1 < words.size(); ++i)
    if (const auto value = number_from(words[i - 1]); value && is_relation(words[i])) {
      kind.values = {*value};
      if (i + 2 < words.size()) kind.unit = words[i + 2];
      shown = i - 1;
      break;
    }
  for (std::size_t i = 0; i < shown; ++i) kind.words += (i > 0 ? " " : "") + words[i];
  return kind;
}

std::optional<double> ReasonKind::median() const {
  if (values.empty()) return std::nullopt;
  std::vector<double> sorted = values;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

void ReasonTally::add(const std::string& reason) { add(ReasonTally::of({kind_of_reason(reason)})); }

void ReasonTally::add(const ReasonTally& later) {
  for (const ReasonKind& kind : later.kinds_) {
    const auto known = std::find_if(kinds_.begin(), kinds_.end(),
                                    [&](const ReasonKind& k) { return k.words == kind.words; });
    if (known == kinds_.end()) {
      kinds_.push_back(kind);
      continue;
    }
    known->values.insert(known->values.end(), kind.values.begin(), kind.values.end());
    known->times += kind.times;
  }
}

const ReasonKind* ReasonTally::most_frequent() const {
  const auto most = std::max_element(kinds_.begin(), kinds_.end(),
                                     [](const auto& a, const auto& b) { return a.times < b.times; });
  return most == kinds_.end() ? nullptr : &*most;
}

int ReasonTally::total() const {
  return std::accumulate(kinds_.begin(), kinds_.end(), 0,
                         [](int sum, const ReasonKind& kind) { return sum + kind.times; });
}

std::string ReasonTally::text() const {
  const ReasonKind* most = most_frequent();
  if (!most) return {};
  std::string text = most->words;
  if (const auto median = most->median()) text += formatted(" %.3g", *median);
  if (!most->unit.empty()) text += " " + most->unit;
  return text + formatted(", %d of %d", most->times, total());
}

}  // namespace talisman::sequences
