// SPDX-License-Identifier: Apache-2.0
#include "regulator/schedule.h"

#include <algorithm>

#include "layers/check.h"

namespace talisman::regulator {

namespace {

/// The best run so far. Instants may be tried in any order: of those that serve as long, the first by rank is kept.
class Search {
 public:
  Search(int frame, Instants instants, int last, const Serves& serves)
      : instants_(instants), last_(last), serves_(serves), best_{-1, frame, frame - 1} {}

  /// Takes `instant` for the run if it serves longer, or as long and is of a lower rank.
  void attempt(int instant) {
    if (instant < instants_.first || instant > instants_.last) return;
    const int first = best_.first, needs = needed(instant);
    if (needs > last_ || !serves_both(instant, needs)) return;
    for (int frame = first + 1; frame < needs; ++frame)
      if (!serves_(instant, frame)) return;
    best_.instant = instant;
    best_.last = needs;
    while (best_.last < last_ && serves_(instant, best_.last + 1)) ++best_.last;
  }

  const FrameRun& best() const { return best_; }

 private:
  /// From the frame on, then backwards from it.
  bool is_ranked_before(int a, int b) const {
    if (a >= best_.first) return b < best_.first || a < b;
    return b < best_.first && a > b;
  }

  /// The frame up to which the instant must serve.
  int needed(int instant) const {
    const bool wins_ties = best_.instant >= 0 && is_ranked_before(instant, best_.instant);
    return wins_ties ? best_.last : best_.last + 1;
  }

  /// The ends of the run, the farther one first: that dismisses most instants.
  bool serves_both(int instant, int needs) const {
    const int first = best_.first;
    if (needs == first) return serves_(instant, first);
    const bool end_first = needs - instant > instant - first;
    return serves_(instant, end_first ? needs : first) && serves_(instant, end_first ? first : needs);
  }

  Instants instants_;
  int last_;
  const Serves& serves_;
  FrameRun best_;
};

}  // namespace

FrameRun longest_run(int frame, Instants instants, int last, const Serves& serves) {
  TALISMAN_CHECK_LE(frame, last);
  Search search(frame, instants, last, serves);
  search.attempt(frame);
  // How long a sprite lasts after its instant tells how long before: the last frame that the first one serves is a
  // good instant, and most others are then dismissed by one question.
  const int guess = std::clamp(search.best().last, frame, std::max(frame, instants.last));
  if (guess != frame) search.attempt(guess);
  for (int instant = std::max(frame + 1, instants.first); instant <= instants.last; ++instant)
    if (instant != guess) search.attempt(instant);
  for (int instant = std::min(frame - 1, instants.last); instant >= instants.first; --instant)
    search.attempt(instant);
  return search.best();
}

FrameRun longest_run(int frame, int lookahead, int last, const Serves& serves) {
  TALISMAN_CHECK_GE(lookahead, 0);
  return longest_run(frame, Instants{frame, lookahead < last - frame ? frame + lookahead : last}, last,
                     serves);
}

std::vector<FrameRun> fewest_renders(int first, int last, const Serves& serves) {
  std::vector<FrameRun> runs;
  for (int frame = first; frame <= last; frame = runs.back().last + 1) {
    runs.push_back(longest_run(frame, Instants{first, last}, last, serves));
    TALISMAN_CHECK_GE(runs.back().instant, first);  // else no sprite can be shown at `frame`
  }
  return runs;
}

}  // namespace talisman::regulator
