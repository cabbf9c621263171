// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Into which of a few shared buffers is a thing drawn, and when, so that it is drawn seldom? The plan tree of
/// [F96 3.1.4, Fig. 3.7]. Pure: from motion words alone.
///
/// A slice of N frames is the root of a tree in which each node has k children and each leaf is a frame;
/// N = k^m. Level l has k^l nodes of N / k^l frames, and one buffer: m + 1 buffers in all. What is drawn into a
/// node is shown in all of its frames, so a thing belongs to the nodes nearest the root inside which it does
/// not change:
///
///   next(f, S):   if f = 0 and bits 1 … N - 1 are 0:                  level 0, next N
///                 for l = 1 … m - 1, with w = N / k^l:
///                   if w divides f and bits f + 1 … f + w - 1 are 0:  level l, next f + w
///                 level m, next f + 1
///
/// Bit f itself does not matter there: a drawing is due anyway. So the fixed, shared intervals cost drawings
/// that a buffer for each thing (runs(): a sprite per layer) would not need. For changes that come
/// independently with probability p in each frame but the first, q = 1 - p:
///
///   E[draws] = q^(N-1) + Σ_{l=1…m} k^l (q^(w_l - 1) - q^(w_{l-1} - 1)),   E[runs] = 1 + (N - 1) p
///
/// A node is drawn into if its own bits but the first are 0 and not all of its parent's are.
///
/// The buffers are joined by depth. Counted in joins of two whole buffers a slice, clear ones included:
///
///   EachFrame   all m + 1 buffers in each frame: N m
///   Copy        each node but the root begins as a copy of its parent's picture, once: k (N - 1) / (k - 1)
///   InPlace     the same, but a last child goes on in its parent's buffer, which nothing else needs any more:
///               N - 1, what [F96 3.3.1] claims

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "regulator/motion_words.h"

namespace talisman::regulator {

/// How the buffers of a plan become the picture of a frame.
enum class Joining { EachFrame, Copy, InPlace };
inline constexpr std::array kAllJoinings = {Joining::EachFrame, Joining::Copy, Joining::InPlace};
std::string_view name(Joining joining);  ///< "each-frame", "copy", "in-place"
std::optional<Joining> joining_from_name(std::string_view text);

/// The shape of a plan tree.
struct PlanShape {
  int frames = 32;  ///< N, 1 … kLongestSlice_frames, a power of k; more draw what rests more seldom, and have
                    ///< more buffers
  int children = 2;  ///< k ≥ 2; more are fewer buffers and joins, and coarser intervals; N: two buffers
  bool operator==(const PlanShape&) const = default;

  /// m + 1, which is the number of buffers.
  int levels() const;
  /// Frames of a node of `level`.
  int interval(int level) const;
};

/// The first broken rule ("lookahead is 12, rule: a power of tree-k 2"), or empty. All else needs a shape
/// without one.
std::string first_defect(const PlanShape& shape);

/// A thing is drawn in `frame` into the buffer of `level`, where it stays for `frames`.
struct PlannedDraw {
  int frame = 0;
  int level = 0;
  int frames = 1;
  bool operator==(const PlannedDraw&) const = default;
};

/// What is due at `frame`: 0, or where the drawing before ends. `word` is of as many frames as the shape.
PlannedDraw draw_due(const PlanShape& shape, const MotionWord& word, int frame);

/// All drawings of a slice, in order.
std::vector<PlannedDraw> planned_draws(const PlanShape& shape, const MotionWord& word);

/// The drawing that shows the thing in `frame`.
PlannedDraw draw_shown(const PlanShape& shape, const MotionWord& word, int frame);

/// E[draws] and E[runs] by the formulas above; `change`: p, 0 … 1.
double expected_draws(const PlanShape& shape, double change);
double expected_runs(int frames, double change);

/// Joins of two buffers a slice, clear ones included.
std::int64_t joins_of_slice(const PlanShape& shape, Joining joining);

/// Frames of the largest slice of at most `frames` that a plan of `children` can have, ≥ 1.
int slice_within(int frames, int children);

}  // namespace talisman::regulator
