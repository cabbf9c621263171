// SPDX-License-Identifier: Apache-2.0
#include "layers/lod/ladder.h"

#include <algorithm>
#include <cmath>

namespace talisman::layers {
namespace {

std::string defect_of_level(const Ladder& ladder, std::size_t k) {
  const LadderLevel& level = ladder.levels[k];
  const std::string which = "level " + std::to_string(k);
  if (level.triangles < 1) return which + " is empty, must have at least one triangle";
  if (!(level.error_m >= 0 && std::isfinite(level.error_m)))
    return which + " has an error that is no distance, must be at least 0";
  if (k == 0) return {};
  const LadderLevel& above = ladder.levels[k - 1];
  if (2 * level.triangles > above.triangles)
    return which + " has " + std::to_string(level.triangles) + " triangles, must be at most half of the " +
           std::to_string(above.triangles) + " of the level above";
  if (level.error_m < above.error_m)
    return which + " has a smaller error than the level above, must be at least as large";
  return {};
}

}  // namespace

std::string first_defect(const Ladder& ladder) {
  for (std::size_t k = 0; k < ladder.levels.size(); ++k)
    if (std::string defect = defect_of_level(ladder, k); !defect.empty()) return defect;
  return {};
}

double level_error_px(double error_m, double nearest_m, double focal_px, double most_tangent) {
  if (error_m == 0) return 0;
  const double left_m = nearest_m - error_m;
  if (!(left_m > 0)) return kMostLevelError_px;
  const double error_px = focal_px * error_m * std::sqrt(1 + most_tangent * most_tangent) / left_m;
  return std::isfinite(error_px) ? std::min(error_px, kMostLevelError_px) : kMostLevelError_px;
}

}  // namespace talisman::layers
