// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/large_plot.h"

#include <algorithm>

#include "layers/check.h"

namespace talisman::sequences {

PlotSeries front_series(const std::vector<double>& cost, const std::vector<double>& error,
                        const std::vector<bool>& front) {
  TALISMAN_CHECK_EQ(cost.size(), front.size());
  TALISMAN_CHECK_EQ(error.size(), front.size());
  PlotSeries series{"Pareto front", {}, SeriesStyle::Steps, {}};
  for (std::size_t k = 0; k < front.size(); ++k)
    if (front[k]) series.points.push_back({cost[k], error[k]});
  std::sort(series.points.begin(), series.points.end(),
            [](const PlotPoint& a, const PlotPoint& b) { return a.x < b.x; });
  return series;
}

}  // namespace talisman::sequences
