// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The selectors that look at one layer at a time [Fu93 4.1, 4.5]: finest level L with
///
///   pixels / triangles(L) ≥ S                 S  px per triangle; where no level is that coarse, the coarsest
///
///   static      S as given
///   feedback    S' = clamp(S + g (T / T_target - 1), 0 … kMostPxPerPolygon)
///                 T  modelled time of the frame before, g the gain
///
/// The paper gives no gain. The law adds, because S falls to 0 in simple views [Fu93 4.5], from where a factor would never
/// lift it; and is clamped, so that one long frame is forgotten. Modelled time, so that runs repeat.

#include <cstdint>
#include <span>

#include "regulator/lod/lod_options.h"

namespace talisman::regulator {

inline constexpr double kMostPxPerPolygon = 65'536;
inline constexpr double kMostOverrun = 8;  ///< of T / T_target - 1: also for a target of 0

/// `triangles`: of the levels, finest first, at least one. `pixels` that the layer covers on the display, ≥ 0.
int level_by_size(double pixels, std::span<const std::int64_t> triangles, double px_per_polygon);

/// S of the next frame.
double next_px_per_polygon(double px_per_polygon, double frame_ms, double target_ms, double gain);

}  // namespace talisman::regulator
