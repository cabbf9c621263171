// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What the plots of cost against error have in common: their size, and the line along the front.

#include <vector>

#include "sequences/pictures/plot.h"

namespace talisman::sequences {

/// Room for one label per point.
inline constexpr PlotFiles kLargePlot{false, 1000, 640};

/// The points of the front, from the cheapest on, as steps. All of one length (programmer error otherwise).
PlotSeries front_series(const std::vector<double>& cost, const std::vector<double>& error,
                        const std::vector<bool>& front);

}  // namespace talisman::sequences
