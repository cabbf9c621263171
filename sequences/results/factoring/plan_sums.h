// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A whole plan in one number each, where two factorings are set side by side.

#include "sequences/results/summary.h"

namespace talisman::sequences {

/// Of layers and aggregates; not of shadow maps.
inline int renders_in(const Summary& summary) {
  int sum = 0;
  for (const LayerSummary& row : summary.layers) sum += row.renders;
  return sum;
}

/// Of rendering, per frame, shadow maps and mirrored pictures included.
inline double modelled_ms(const Summary& summary) {
  double sum = 0;
  for (const LayerSummary* row : summary.rows()) sum += row->render_ms;
  return summary.frame_count() == 0 ? 0 : sum / summary.frame_count();
}

}  // namespace talisman::sequences
