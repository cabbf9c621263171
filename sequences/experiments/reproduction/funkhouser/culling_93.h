// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What [Fu93] prints of finding what can be seen: polygons left by each way, Tables 4.1 and 4.2.

#include "sequences/experiments/reproduction/paper.h"

namespace talisman::sequences {

/// Polygons left on the walk, by the frustum and by cells.
Item visibility_93();

// --- Judgement, for tests ---

/// Shares of all polygons that are left: by the frustum, by what is precomputed, by both, and by lines of sight.
struct SharesLeft {
  double frustum = 0, cto = 0, cto_frustum = 0, cto_eye = 0;
};
/// Each way leaves less than those that it refines.
Finding order_finding_93(const SharesLeft& shares);

}  // namespace talisman::sequences
