// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which of many boxes meet a region? What all structures that answer it have in common [AA 9.1, 9.4].
///
/// Boxes are numbered by their place in the list that they were built from, and may move: `update` takes the
/// list again and says which ones did. A query gives, in no particular order and each once, every box that
/// RegionTest::side_of does not call outside, and perhaps some whose node it calls inside by rounding. Empty
/// boxes are never found.
///
/// The structures differ in time alone: layers/box_tree.h is the one that is used, because it won
/// (`talisman accuracy --culling`, docs/experiments.md); the others are measured beside it.

#include <cstdint>
#include <span>
#include <vector>

#include "layers/region.h"

namespace talisman::layers {

/// What a query did.
struct QueryCounters {
  std::int64_t nodes = 0;   ///< groups of up to four boxes that were tested
  std::int64_t tests = 0;   ///< of one plane against four boxes
  std::int64_t spared = 0;  ///< such tests that masks spared: of planes that what is above lies inside of
  std::int64_t whole = 0;   ///< boxes that were taken without a test of their own
};

class BoxIndex {
 public:
  BoxIndex() = default;
  BoxIndex(const BoxIndex&) = default;
  BoxIndex& operator=(const BoxIndex&) = default;
  BoxIndex(BoxIndex&&) = default;
  BoxIndex& operator=(BoxIndex&&) = default;
  virtual ~BoxIndex() = default;

  virtual void build(std::span<const Box3> boxes) = 0;
  /// `boxes`: as many as at `build`; only those of `moved` may differ from the last ones.
  virtual void update(std::span<const Box3> boxes, std::span<const int> moved) = 0;
  /// Appends what meets the region to `found`. Not const: what was learned speeds up the next query.
  virtual void query(std::span<const Plane> region, std::vector<int>& found, QueryCounters& counters) = 0;
};

}  // namespace talisman::layers
