// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Does drawing on demand cost less than drawing every third frame? [LS97 7.2, Fig. 22]
///
/// Polygons and pixels of each frame, as averages over windows of 15 frames, in units of what triple framing costs in the
/// same window (moving_average.h). The paper draws thresholds of 0.1 to 0.8 px below it, falling as the threshold rises,
/// and says that triple framing costs the same with and without interpolation.

#include <string>
#include <vector>

#include "sequences/experiments/reproduction/paper.h"

namespace talisman::sequences {

/// Shares of triple framing, one per window.
struct ResourceCurve {
  std::string name;  ///< "0.1 px"
  std::vector<double> shares;
};

struct ResourceUse {
  std::string resource;                   ///< "polygons", "pixels"
  std::vector<ResourceCurve> thresholds;  ///< ascending in px
  ResourceCurve interpolation;            ///< triple framing whose sprites are warped between its beats
  double interpolated = 0;                ///< of the whole sequence, over that of held triple framing
};

/// `threshold`: of each threshold what each frame costs.
ResourceUse resource_use(const std::string& resource, const std::vector<double>& held,
                         const std::vector<double>& interpolated,
                         const std::vector<std::vector<double>>& threshold);

/// Every window of every threshold is below 1.
Finding below_triple_framing(const ResourceUse& use);
/// A larger threshold costs less, in the mean over the windows.
Finding falling_with_threshold(const ResourceUse& use);
/// To 2 %.
Finding interpolation_costs_the_same(const ResourceUse& use);

Item figure_22();

}  // namespace talisman::sequences
