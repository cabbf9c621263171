// SPDX-License-Identifier: Apache-2.0
#pragma once

/// When is a sprite best drawn, if the coming motion is known? Pure: over a predicate, no scene and no pixel.
///
/// serves(r, f): the sprite as rendered at the instant of frame r would be good enough when shown, warped, at
/// frame f. r may lie before or after f: a sprite drawn as of the middle of a motion serves both halves of
/// it. A schedule cuts an interval of frames into *runs*; each run is shown from one sprite:
///
///   run (r; first … last)   valid if serves(r, f) for every f in first … last
///
/// Fewest renders = fewest runs. The greedy schedule, which gives each run the instant that serves the
/// longest, is optimal: validity is a conjunction over frames, so what is left of a valid run when frames are
/// cut off at its start is valid with the same r. Hence the k-th greedy run ends no earlier than the k-th run
/// of any schedule (induction over k: that schedule's next run, cut to begin where greedy's begins, is one of
/// the runs from which greedy takes the longest). Nothing is asked of `serves` for this, neither monotony nor
/// symmetry, as long as every instant may be chosen for every run. With the instants of a run confined to N
/// frames after its start the argument fails, and the same greedy choice (policy Lookahead) is a heuristic.
///
/// Motion known ahead: Fearing, predictive rendering [F96]; the paper itself renders only as of now.

#include <functional>
#include <vector>

namespace talisman::regulator {

/// serves(rendered_at, shown_at). Called with one rendered_at at a time, so a caller can keep what belongs to
/// it.
using Serves = std::function<bool(int, int)>;

/// Instants that may be chosen: those of the frames first … last.
struct Instants {
  int first = 0, last = -1;
};

/// Frames first … last, shown from the sprite as rendered at `instant`.
struct FrameRun {
  int instant = -1;
  int first = 0, last = -1;
  int frames() const { return last - first + 1; }
  bool operator==(const FrameRun&) const = default;
};

/// The run that begins at `frame` and lasts longest, at most to `last`, over all instants. Ties go to the
/// earliest instant from `frame` on, then to the latest before it. If no instant serves `frame`, the run is
/// empty and its instant -1. Cost: an instant that does not serve `frame`, or the frame that it must reach to
/// win, is dismissed with one or two calls of `serves`; an instant that wins costs one call per frame of its
/// run. That at `frame` is asked first, then the last one that it serves, which wins mostly: few others do after it.
FrameRun longest_run(int frame, Instants instants, int last, const Serves& serves);

/// The same for motion known `lookahead` ≥ 0 frames ahead: instants frame … frame + lookahead, not beyond
/// `last`.
FrameRun longest_run(int frame, int lookahead, int last, const Serves& serves);

/// Fewest runs that cover first … last, each with an instant of first … last. Every frame must be served by
/// an instant (its own always does): checked. Cost: runs × instants × about 2 calls, and one per frame and
/// winner.
std::vector<FrameRun> fewest_renders(int first, int last, const Serves& serves);

}  // namespace talisman::regulator
