// SPDX-License-Identifier: Apache-2.0
#include "regulator/lod/selectors.h"

#include <algorithm>

#include "layers/check.h"

namespace talisman::regulator {

int level_by_size(double pixels, std::span<const std::int64_t> triangles, double px_per_polygon) {
  TALISMAN_CHECK(!triangles.empty());
  for (std::size_t level = 0; level < triangles.size(); ++level)
    if (pixels >= px_per_polygon * static_cast<double>(triangles[level])) return static_cast<int>(level);
  return static_cast<int>(triangles.size()) - 1;
}

double next_px_per_polygon(double px_per_polygon, double frame_ms, double target_ms, double gain) {
  const double ratio = target_ms > 0 ? frame_ms / target_ms - 1 : kMostOverrun;
  const double overrun = ratio <= kMostOverrun ? ratio : kMostOverrun;  // of no number: the most
  return std::clamp(px_per_polygon + gain * overrun, 0.0, kMostPxPerPolygon);
}

}  // namespace talisman::regulator
