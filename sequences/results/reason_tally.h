// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Why is a layer drawn, mostly?
///
/// The reason of a decision (regulator/plan.h) begins with words; where a value is compared with a limit, it goes on
/// with the two: "geometric 4.7 > 4 px". Reasons with the same words are of one kind.

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace talisman::sequences {

/// The reasons of one kind.
struct ReasonKind {
  std::string words;           ///< "geometric", "first_appearance", "policy: hold 3"
  std::string unit;            ///< of the values: "px", "rad"; empty: has none
  std::vector<double> values;  ///< that were compared with a limit, one per reason; empty: nothing was
  int times = 0;
  std::optional<double> median() const;  ///< of the values, of two in the middle the larger
};

class ReasonTally {
 public:
  void add(const std::string& reason);
  /// Of reasons that came behind ours.
  void add(const ReasonTally& later);
  const std::vector<ReasonKind>& kinds() const { return kinds_; }
  /// Of kinds that were kept.
  static ReasonTally of(std::vector<ReasonKind> kinds) {
    ReasonTally tally;
    tally.kinds_ = std::move(kinds);
    return tally;
  }
  /// The kind that came most often; of equal ones, the first to come. Null: there was no reason.
  const ReasonKind* most_frequent() const;
  int total() const;
  /// "geometric 18 px, 39 of 40": the most frequent kind, its median, how often. Empty: there was no reason.
  std::string text() const;

 private:
  std::vector<ReasonKind> kinds_;
};

}  // namespace talisman::sequences
