// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How often is each sprite of the canyon flyby drawn again? [LS97 7.1, Fig. 21]
///
/// 250 frames, 10 layers, affine warps, 4 px: 19 % in the mean over the layers, 32 % weighted by polygons, about a third of
/// the polygons a frame. The landscape is drawn most often, the sky once, parts of the ships in 5 to 30 % of the frames.
/// The ranges are those of the rows; of the layers that are neither sky nor land (the one with most polygons) all must
/// lie in theirs.

#include <string>
#include <vector>

#include "sequences/experiments/reproduction/paper.h"

namespace talisman::sequences {

struct SpriteRate {
  std::string name;
  int polygons = 0, renders = 0;
  double rate = 0;  ///< 0 … 1: in how many of the frames it was drawn, alone or with others
};

struct CanyonRates {
  std::vector<SpriteRate> sprites;
  double mean = 0, weighted = 0, polygons = 0;  ///< 0 … 1; the last: drawn of what `reference` draws
};

CanyonRates canyon_rates(const Summary& summary);

Finding mean_rate(const CanyonRates& rates);      ///< at most 25 %
Finding weighted_rate(const CanyonRates& rates);  ///< 25 to 40 %
Finding polygon_share(const CanyonRates& rates);  ///< 25 to 42 %
Finding sky_once(const CanyonRates& rates);       ///< the layer "sky" has one render
/// Each between 0 and 35 %, which is 5 to 30 and 5 beside them.
Finding ship_parts(const CanyonRates& rates);
/// Of all sprites the land has the highest rate.
Finding land_most_often(const CanyonRates& rates);

Item figure_21();

}  // namespace talisman::sequences
