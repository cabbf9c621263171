// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What do layers cost? Planned as every run plans them, without a pixel.

#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "layers/layer.h"
#include "sequences/pipeline/frame_report.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// One layer's place behind another's, by index of their specs.
using SpecPair = std::pair<std::size_t, std::size_t>;  // behind, front

struct PlannedFactoring {
  int frames = 0;  ///< planned, from the first on
  std::int64_t renders = 0, polygons = 0, pixels = 0;
  double shown_px = 0;        ///< of all sprites on the display, added up over the frames: what is composited
  double polygon_ms() const;  ///< of the machine's renderer (regulator/profile.h), over the frames
  double pixel_ms() const;
  /// By which layers are compared: polygons and pixels both count, whichever is the bottleneck; what the compositor cannot
  /// show in the time of a frame counts ten times.
  double work_ms() const;
};

/// Adds what one planned frame draws and shows.
void add_frame(const FrameReport& report, layers::ivec2 display_px, PlannedFactoring& plan);

/// Which layers the order of some frames puts into one sprite.
struct Sharing {
  std::map<SpecPair, int> frames;  ///< in how many, by index of the specs, the smaller first
  std::vector<int> frames_shown;   ///< by spec, of these frames
};

/// Orders these frames, ascending, and nothing else. `set` is what layers::factor makes of specs. Cost: some µs per layer
/// and frame.
Sharing sharing_of(const layers::Scene& scene, const layers::LayerSet& set, std::span<const SpecPair> order,
                   const Settings& settings, std::span<const int> frames);

/// Plans `frames` frames, or as many as it takes until polygons and pixels alone cost more than `enough_ms`. A set with a
/// defect gives no frames.
PlannedFactoring plan_of(const layers::Scene& scene, const layers::LayerSet& set,
                         std::span<const SpecPair> order, const Settings& settings, int frames,
                         double enough_ms = HUGE_VAL);

/// The same of each layer as if it were alone: nothing is merged, and nothing casts shadows.
std::vector<PlannedFactoring> plans_apart(const layers::Scene& scene,
                                          std::span<const layers::LayerSpec> specs, const Settings& settings,
                                          int frames);

/// As ids of the layers that `factor` makes of the specs.
std::vector<layers::ExplicitPair> ids_of(std::span<const SpecPair> order, const layers::LayerSet& set);

}  // namespace talisman::sequences
