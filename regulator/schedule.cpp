// SPDX-License-Identifier: Apache-2.0
#include "regulator/schedule.h"

#include <algorithm>

#include "layers/check.h"

namespace talisman::regulator {

namespace {

/// Takes `instant` for the run if it serves longer. The frame just beyond the best run is asked second,
/// because it dismisses most instants.
void try_instant(int instant, int last, const Serves& serves, FrameRun& best) {
  const int to_beat = best.last + 1;
  if (to_beat > last || !serves(instant, best.first)) return;
  if (to_beat > best.first && !serves(instant, to_beat)) return;
  for (int frame = best.first + 1; frame < to_beat; ++frame)
    if (!serves(instant, frame)) return;
  best.instant = instant;
  best.last = to_beat;
  while (best.last < last && serves(instant, best.last + 1)) ++best.last;
}

}  // namespace

FrameRun longest_run(int frame, Instants instants, int last, const Serves& serves) {
  TALISMAN_CHECK_LE(frame, last);
  FrameRun best{-1, frame, frame - 1};
  for (int instant = std::max(frame, instants.first); instant <= instants.last; ++instant)
    try_instant(instant, last, serves, best);
  for (int instant = std::min(frame - 1, instants.last); instant >= instants.first; --instant)
    try_instant(instant, last, serves, best);
  return best;
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
