// SPDX-License-Identifier: Apache-2.0
#pragma once

/// In which of the coming frames does a thing have to be drawn again, because it has moved on the display?
/// The motion state of [F96 3.1.2, Eq. 3.8] as data. Pure: over a predicate, no scene and no pixel.
///
/// A slice is N frames, 0 … N - 1. The word S of a thing has a bit for each: 1 where it has changed. Bit 0 is
/// always 1: every slice begins with a drawing. A *run* is a 1 and the 0s behind it: frames that one drawing
/// of the thing serves.
///
///   S(f) = 1   if f = 0 or changed(last, f),   last = the latest frame before f with S = 1
///
/// As printed, Eq. 3.8 compares with f - 1: slow drift is then never seen, and the error of what is displayed
/// grows with N (kept as MotionReference::LastFrame). With `last`, a thing that is drawn as of the first frame
/// of its run is never displayed farther off than `changed` allows. Drawn as of the present where the plan
/// (regulator/plan_tree.h) forces a drawing inside a run, it may be twice as far off, since the test goes on
/// against the first frame of the run.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "layers/check.h"

namespace talisman::regulator {

/// The longest slice.
inline constexpr int kLongestSlice_frames = 4096;

/// With what is a frame compared?
enum class MotionReference {
  LastDrawn,  ///< the first frame of the run: bounds what is displayed
  LastFrame,  ///< the frame before, as printed in Eq. 3.8: drift goes unseen
};

/// As of when is a thing drawn that the plan draws inside a run?
enum class DrawnAs {
  RunStart,  ///< the first frame of the run: the error is that of `changed`
  Present,   ///< now: up to twice as much
};

/// One bit per frame of a slice.
class MotionWord {
 public:
  /// At rest over `frames`, 1 … kLongestSlice_frames: bit 0 alone.
  explicit MotionWord(int frames) : frames_(frames), bits_((frames + 63) / 64) {
    TALISMAN_CHECK(frames >= 1 && frames <= kLongestSlice_frames);
    bits_[0] = 1;
  }

  int frames() const { return frames_; }
  bool changes_at(int frame) const { return bits_[frame / 64] >> (frame % 64) & 1; }
  void mark(int frame) { bits_[frame / 64] |= std::uint64_t{1} << (frame % 64); }
  /// No change at first … last. True where first > last; frames beyond the slice are at rest.
  bool rests_over(int first, int last) const;
  /// The first frame of the run that holds `frame`.
  int run_start(int frame) const;
  /// Runs, ≥ 1: the drawings of a buffer that the thing has to itself.
  int runs() const;
  /// Frame by frame, from 0: '#' where it changes, '.' where it is at rest.
  std::string marks() const;
  bool operator==(const MotionWord&) const = default;

 private:
  int frames_;
  std::vector<std::uint64_t> bits_;
};

/// The word of a thing of which changed(then, now) says whether its picture as of frame `then` is too far from
/// how it looks at `now` > `then`. Called frames - 1 times, with both in ascending order.
template <typename Changed>
MotionWord motion_word(int frames, const Changed& changed,
                       MotionReference reference = MotionReference::LastDrawn) {
  MotionWord word(frames);
  int last = 0;
  for (int frame = 1; frame < frames; ++frame) {
    if (changed(reference == MotionReference::LastFrame ? frame - 1 : last, frame)) {
      word.mark(frame);
      last = frame;
    }
  }
  return word;
}

/// The instant as of which the thing is drawn in `frame`.
inline int instant_of(const MotionWord& word, int frame, DrawnAs as) {
  return as == DrawnAs::RunStart ? word.run_start(frame) : frame;
}

}  // namespace talisman::regulator
