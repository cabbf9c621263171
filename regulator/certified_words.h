// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The words of regulator/motion_words.h with fewer evaluations, and never another word: subdivision of [F96 3.3.2],
/// with a certificate.
///
/// As printed, an interval is at rest if its first and its last frame are: what moves out and returns in between is
/// missed. Here an interval a … b is dismissed only with a bound on how far the thing can get within it: with c in its
/// middle and bound(x, y) ≥ motion between any two instants of frames x … y,
///
///   motion(last, c) + max(bound(a, c), bound(c, b)) ≤ δ   ⇒   at rest in all of a … b
///   bound(last, b) ≤ δ                                    ⇒   likewise, without any evaluation
///
/// by the triangle inequality, which `motion` must obey (a largest displacement does). What is not dismissed is halved,
/// down to single frames, which are evaluated as in the full scan. Intervals begin with one frame and double while
/// nothing changes, so that what moves all the time costs one evaluation a frame, as before.

#include <algorithm>
#include <cstdint>

#include "regulator/motion_words.h"

namespace talisman::regulator {

struct CertifiedWord {
  MotionWord word;
  std::int64_t evaluations = 0;   ///< of `motion`; the full scan takes frames - 1
  std::int64_t certificates = 0;  ///< of `bound`
};

/// motion(then, now): how far the thing has moved on the display, px, NaN where that is not bounded; changed is what is
/// not ≤ δ. bound(a, b), a ≤ b: as above, infinite where nothing is known.
template <typename Motion, typename Bound>
class CertifiedScan {
 public:
  CertifiedScan(int frames, double delta_px, const Motion& motion, const Bound& bound)
      : frames_(frames), delta_(delta_px), motion_(motion), bound_(bound), result_{MotionWord(frames)} {}

  CertifiedWord run() {
    int from = 1, width = 1;
    while (from < frames_ && !is_within(last_, frames_ - 1, 0)) {
      const int to = std::min(from + width - 1, frames_ - 1), changed = first_change(from, to);
      if (changed < 0) {
        from = to + 1;
        width *= 2;
        continue;
      }
      result_.word.mark(changed);
      last_ = changed;
      from = changed + 1;
      width = 1;
    }
    return result_;
  }

 private:
  bool is_within(int a, int b, double moved) {
    ++result_.certificates;
    return moved + bound_(a, b) <= delta_;
  }

  /// The first frame of a … b that has changed since last_, or -1.
  int first_change(int a, int b) {
    if (a > b || (a < b && is_within(last_, b, 0))) return -1;
    const int middle = a + (b - a) / 2;
    ++result_.evaluations;
    const double moved = motion_(last_, middle);
    const bool rests = moved <= delta_;
    if (a == b) return rests ? -1 : a;
    if (rests && is_within(a, middle, moved) && is_within(middle, b, moved)) return -1;
    const int before = first_change(a, middle - 1);
    if (before >= 0) return before;
    return rests ? first_change(middle + 1, b) : middle;
  }

  int frames_;
  double delta_;
  const Motion& motion_;
  const Bound& bound_;
  CertifiedWord result_;
  int last_ = 0;
};

template <typename Motion, typename Bound>
CertifiedWord certified_word(int frames, double delta_px, const Motion& motion, const Bound& bound) {
  return CertifiedScan<Motion, Bound>(frames, delta_px, motion, bound).run();
}

}  // namespace talisman::regulator
