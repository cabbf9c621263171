// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What is remembered of which layers share a sprite because it is cheaper, and of how long sprites last. Data; how it
/// is used is in sequences/pipeline/regrouping/regroup.h.

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "layers/sprite_transform.h"
#include "layers/state.h"
#include "regulator/amortise.h"

namespace talisman::sequences {

/// Ids of the author's layers that share a sprite, ascending, at least two.
using SharedSet = std::vector<int>;

/// A sprite that a layer would have if it had one of its own.
struct OwnSprite {
  layers::LayerState then;
  layers::SpritePlacement placement;
  int frame = -1;         ///< in which it was drawn, or would have been
  bool is_stored = true;  ///< it was: it is there when the layer is split off
};

/// How long sprites of one layer last, by themselves.
struct LayerRuns {
  regulator::RunLength run;
  std::optional<OwnSprite> own;  ///< only while the layer shares another
  int changed = -1;              ///< the last frame in which it was merged or split, or else was seen first
};

/// How long one warp serves two layers that are neighbours in the order.
struct PairRuns {
  layers::LayerState behind, front;  ///< where the run began
  regulator::RunLength run;
  int seen = -1;  ///< the last frame in which they were neighbours
};

/// How long sprites of a set last.
struct SetRuns {
  regulator::RunLength run;
  int splits = 0;       ///< how often it had to be split
  int not_before = -1;  ///< the first frame in which it may be merged again
  int seen = -1;        ///< the last frame in which it existed or was split
};

/// A value.
struct RegroupMemory {
  std::map<int, LayerRuns> layers;                ///< by id
  std::map<std::pair<int, int>, PairRuns> pairs;  ///< by id, the one behind first
  std::map<SharedSet, SetRuns> sets;
  std::map<SharedSet, std::string> shared;  ///< that are wanted: why
  std::map<int, std::string> why_split;     ///< by id: what was decided in the last frame
  /// The author's layers of the last frame that take part, far to near. What stands between two of them that are not
  /// neighbours is -1.
  std::vector<int> line;
  int changes_above_ceiling = 0;  ///< of the last frame: that would have paid
};

}  // namespace talisman::sequences
