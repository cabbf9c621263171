// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which places of a plot's picture open something? The picture itself knows of no links; the page lays them over it.

#include "sequences/pictures/page.h"
#include "sequences/pictures/plot.h"

namespace talisman::sequences {

/// Of each point that is drawn and has a link, in the picture that write_plot makes with the same `files`.
std::vector<FigureLink> links_of(const Plot& plot, const PlotFiles& files);

}  // namespace talisman::sequences
