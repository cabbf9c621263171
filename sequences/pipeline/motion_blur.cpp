// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/motion_blur.h"

#include <algorithm>
#include <cmath>

#include "sequences/pipeline/layer_planning.h"

namespace talisman::sequences {

namespace {

constexpr double kLeastDensity = 1.0 / 16;

/// Mean over the points that are in view in both states; zero if there are none.
layers::dvec2 mean_motion(const layers::Correspondences& matched) {
  layers::dvec2 sum(0);
  for (std::size_t i = 0; i < matched.then_px.size(); ++i) sum += matched.now_px[i] - matched.then_px[i];
  return matched.then_px.empty() ? sum : sum / static_cast<double>(matched.then_px.size());
}

}  // namespace

MotionSampling motion_sampling(const Pipeline& pipeline, const LayerTable& layers,
                               const layers::LayerState& now) {
  const layers::Layer& layer = layers[now.layer];
  const layers::LayerBound& bound = layers.bound(now.layer);
  const int next = static_cast<int>(std::lround(now.time_s * pipeline.settings.fps)) + 1;
  const layers::LayerState soon =
      layers::capture(pipeline.scene.at(time_of(pipeline, next)), layer, bound, pipeline.settings.view);
  const layers::Correspondences matched = layers::correspond(now, soon, bound.hull);
  MotionSampling sampling;
  if (!matched.overlap) return sampling;
  sampling.motion_px = mean_motion(matched);
  const double blur_px = glm::length(sampling.motion_px) * layer.preferences.motion_blur;
  if (blur_px > 1) sampling.density = std::max(1 / blur_px, kLeastDensity);
  return sampling;
}

void apply_motion_blur(const Pipeline& pipeline, const LayerTable& layers, const layers::LayerState& now,
                       layers::PlacementOptions& placement) {
  const MotionSampling sampling = motion_sampling(pipeline, layers, now);
  placement.motion = sampling.motion_px;
  placement.motion_density = sampling.density;
}

void judge_motion_blur(const Pipeline& pipeline, const LayerTable& layers, const layers::LayerState& then,
                       const layers::LayerState& now, regulator::LayerAssessment& assessment) {
  const MotionSampling before = motion_sampling(pipeline, layers, then),
                       wanted = motion_sampling(pipeline, layers, now);
  const bool same_blur =
      before.density == wanted.density && (wanted.density == 1 || before.motion_px == wanted.motion_px);
  assessment.identical = assessment.identical && same_blur;
  const double ratio = wanted.density / before.density;
  fiducials::Sampling& sampling = assessment.fiducials.sampling;
  sampling.magnification = std::max(sampling.magnification, ratio);
  sampling.minification = std::min(sampling.minification, ratio);
}

}  // namespace talisman::sequences
