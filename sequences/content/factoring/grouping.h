// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which pieces share a sprite? Pieces are joined, two groups at a time, as long as that makes the work less.
///
/// The work of a group in milliseconds of the machine's renderer, over the instants s of a sequence of F frames, with
/// n(s) = F / instants frames for each:
///
///   work = Σ n(s) / reuse(s) · ( polygons / polygon rate + area(s) / pixel rate )
///
/// over the instants at which it is in view, reuse(s) as in piece_motion.h, area(s) the rectangle around its pieces. Two
/// groups are joined if the work of both together is less than that of each: so if they move alike and overlap
/// [LS97 2.1]; or if it is more by no more than kFree of all work, since fewer layers are easier to live with. One joins what is dearer only where there are too many layers, or sprites cover the display more often than the
/// compositor can show; and does not join what would leave more than kMostClear texels of a sprite to each that is touched,
/// or would have something else in between, while anything else is left.
///
/// The best pair is taken first, found by a lower bound of its work (a group is never reused longer than its members
/// are), so that only few groups are looked at.

#include <vector>

#include "sequences/content/factoring/depth_samples.h"
#include "sequences/content/factoring/piece_motion.h"
#include "sequences/content/factoring/pieces.h"

namespace talisman::sequences {

/// Texels of a sprite for each that geometry touches, beyond which pieces are not joined for want of anything better.
inline constexpr double kMostClear = 8;

/// Share of the work of all pieces by themselves that one join may cost.
inline constexpr double kFree = 5e-4;

struct GroupingOptions {
  int max_groups = 40;  ///< ≥ 1; joined until there are no more, those that stay as they are not counted
  bool only_limit = false;  ///< join for this limit, and for nothing else
};

struct GroupWork {
  double renders = 0;
  double ms = 0;        ///< of rendering, over the whole sequence
  double shown_px = 0;  ///< of its sprite, on average over the frames
};

/// Data of one scene from which groups are judged. Refers to all of it.
struct GroupingData {
  const Pieces& pieces;
  const PieceMotion& motion;
  const DepthSamples& depths;
  int frames = 1;
  std::vector<bool>
      behind{};  ///< by piece, of what no other is joined with (backdrops.h); empty: there are none
};

/// What a sprite of these pieces costs, as estimated here.
GroupWork work_of(const GroupingData& data, const std::vector<int>& pieces);

/// Groups of the free pieces, each ascending, in the order of their first pieces. Joined are those of `start`, after those
/// that lie before and behind each other at once, in half of the frames in which they meet on the display: they have no
/// order.
std::vector<std::vector<int>> grouped(const GroupingData& data, const GroupingOptions& options,
                                      const std::vector<std::vector<int>>& start);

}  // namespace talisman::sequences
