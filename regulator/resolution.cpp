// SPDX-License-Identifier: Apache-2.0
#include "regulator/resolution.h"

#include <algorithm>
#include <cmath>

#include "regulator/budget.h"

namespace talisman::regulator {

namespace {

double share_of_axis(std::int64_t budget, std::int64_t desired) {
  if (budget >= desired) return 1;
  return std::sqrt(static_cast<double>(budget) / static_cast<double>(desired));
}

/// One tenth lower for each frame waited; the product, because libraries differ in the last bit of a power.
double after_waiting(double resolution, int frames, double least) {
  for (; frames > 0 && resolution > least; --frames) resolution *= 1 - kMostChange;
  return resolution;
}

}  // namespace

double share_of_resolution(std::span<const LayerAssessment> assessments, const RegulatorOptions& options) {
  const Budget budget = frame_budget(options);
  if (budget.pixels == kNoLimit && budget.chunks == kNoLimit) return 1;
  LayerCost desired;
  const auto select = [&desired](const LayerCost& cost) {
    desired.polygons += cost.polygons;
    desired.pixels += cost.pixels;
    desired.chunks += cost.chunks;
  };
  std::vector<Candidate> changed;
  for (const LayerAssessment& layer : assessments) {
    if (layer.in_view && !layer.has_sprite) select(layer.cost);
    // What is at rest takes what is left, else it would hold back the others for ever.
    if (!layer.identical && is_candidate(layer, options))
      changed.push_back({layer.layer, benefit_px(layer), layer.cost});
  }
  // What the polygons will not do for needs no area.
  const Budget polygons{budget.polygons, kNoLimit, kNoLimit};
  sort_by_benefit_per_cost(changed, polygons);
  for (const Candidate& candidate : changed)
    if (candidate.cost.polygons <= budget.polygons - std::min(desired.polygons, budget.polygons))
      select(candidate.cost);
  return std::min(share_of_axis(budget.pixels, desired.pixels), share_of_axis(budget.chunks, desired.chunks));
}

double regulated_resolution(const LayerAssessment& layer, double share, const RegulatorOptions& options) {
  double resolution = share;
  if (layer.has_sprite) {
    const double least = (1 - kMostChange) * layer.resolution_then;
    const double most = (1 + kMostChange) * layer.resolution_then;
    resolution = layer.identical ? most
                                 : after_waiting(std::clamp(share, least, most), layer.frames_short_of_area,
                                                 options.budget.min_resolution);
  }
  return std::clamp(resolution, options.budget.min_resolution, 1.0);
}

void regulate_resolutions(std::span<LayerAssessment> assessments, const RegulatorOptions& options) {
  const double share = share_of_resolution(assessments, options);
  for (LayerAssessment& layer : assessments)
    if (layer.in_view) layer.resolution = regulated_resolution(layer, share, options);
}

bool nothing_to_gain(const LayerAssessment& layer) {
  return layer.identical && layer.resolution_then >= layer.resolution;
}

}  // namespace talisman::regulator
