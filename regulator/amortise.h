// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Is it worth some time now to be faster later? The utility test of [D95, "The Utility Function"].
///
///   optimise  ⇔  TTRO · AUT + OT < TTRU · AUT     and     OT ≤ ceiling
///
///   TTRU  what a frame costs without the optimisation       ms
///   TTRO  what a frame costs with it                        ms
///   OT    what the optimisation costs, once                 ms
///   AUT   for how many frames it is expected to last        frames
///
/// [D95] calls AUT a ratio of frames, at most 1. With the figures that it prints itself (durbin_1995) the test could
/// then never hold: 87.9 > 12.7 - 3.8. What is meant is the length of a run: the optimisation pays from
/// OT / (TTRU - TTRO) frames on, 9.88 with these figures, however many polygons.
///
/// The running mean over a whole run that [D95] uses adapts slowly; its "Averaging Differently" asks for one that
/// weights what is recent, which is RunLength.

#include <algorithm>
#include <cstdint>

namespace talisman::regulator {

struct Amortisation {
  double unoptimised_ms = 0;  ///< TTRU ≥ 0
  double optimised_ms = 0;    ///< TTRO ≥ 0
  double once_ms = 0;         ///< OT ≥ 0
};

/// TTRU, TTRO and OT of a tree of so many polygons on a RealityEngine2 [D95, "Dynamically Created Objects"].
Amortisation durbin_1995(std::int64_t polygons);

/// AUT from which on it pays; infinite where a frame is no cheaper.
double break_even_frames(const Amortisation& terms);

/// Does it pay over `frames` ≥ 0? Exactly at the break-even it does not; nor does anything that is not finite.
bool pays(const Amortisation& terms, double frames);

/// For how many frames does something stay as it is, going by how long it did before? Runs that have ended are
/// averaged with weights that fall by (1 - recency) from one to the one before it. A run that lasts longer than that
/// already is expected to last at least as long as it has.
class RunLength {
 public:
  RunLength() = default;
  /// Nothing has been seen yet, and so many frames are expected.
  explicit RunLength(double expected_frames) : mean_(expected_frames), runs_(1) {}
  void frame_passed() { ++current_; }
  /// It changed: the run ends. `recency`: weight of the run that ends, (0, 1].
  void ended(double recency);
  /// It could not be followed: the run so far says nothing.
  void interrupted() { current_ = 0; }
  int current() const { return current_; }  ///< frames of the run that lasts
  /// Frames, ≥ 1.
  double expected() const { return std::max({mean_, static_cast<double>(current_), 1.0}); }
  int runs() const { return runs_; }

 private:
  double mean_ = 0;
  int current_ = 0, runs_ = 0;
};

}  // namespace talisman::regulator
