// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What may be seen within the next frames, as finely as it may be drawn then, soonest first: the lookahead set of [Fu93
/// 5.2.2].
///
/// The cells that the eye may enter (observer_range.h), by the time; of each what can be seen from it (stab_lists.h), as far
/// as `LookaheadCull` lets it pass. A thing is wanted up to the level that it would be drawn with at the least distance from which it may be
/// seen: from the cell, and from where the eye can be by then. So with both culls `any` the set holds every level that can be
/// drawn within N frames, whatever the eye does.
///
/// Without cells, from an eye in none, and for things in none: what the view itself can reach.

#include <cstdint>
#include <span>
#include <vector>

#include "regulator/memory/level_cache.h"
#include "regulator/memory/observer_range.h"
#include "regulator/memory/stab_lists.h"

namespace talisman::regulator {

/// Of one thing of the scene: where it is, what it is stored as, and the polygons of its levels, from the coarsest.
struct StoredThing {
  layers::Box3 box;
  int item = 0;
  std::vector<std::int64_t> polygons;
};

/// Static detail elision [Fu93 4.2.4]: the finest level with at least so many pixels for each of its polygons, or the
/// coarsest. > 0; more is coarser. [Fu93] takes 1024, and 4096 in its tests of memory.
inline constexpr double kPixelsPerPolygon = 4096;

/// π r² f² / d², at most the display.
double pixels_of(const Ball& ball, double distance_m, const Observer& observer);
int level_for(const StoredThing& thing, double pixels, double px_per_polygon);

class Lookahead {
 public:
  /// `set`: null for no cells.
  Lookahead(std::vector<StoredThing> things, std::shared_ptr<const layers::CellSet> set,
            const PrefetchOptions& options, double px_per_polygon);

  /// In the order in which they are found: soonest first. A thing may come up again with a finer level.
  std::vector<LevelWant> wants(const Observer& observer);
  /// The level of a thing as this eye draws it; soonest 0.
  LevelWant drawn(int thing, const Observer& observer) const;

  const std::vector<StoredThing>& things() const { return things_; }
  /// What the last `wants` came to.
  int range_cells() const { return range_cells_; }
  int things_wanted() const { return things_wanted_; }

 private:
  class Search;
  std::vector<StoredThing> things_;
  std::vector<Ball> balls_;
  std::shared_ptr<const layers::CellSet> set_;
  std::optional<StabLists> stab_;
  PrefetchOptions options_;
  double px_per_polygon_;
  std::vector<int> level_;  ///< by thing: wanted so far in this frame; -1: not
  int range_cells_ = 0, things_wanted_ = 0;
};

}  // namespace talisman::regulator
