// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/motion_blur.h"

#include <algorithm>
#include <cmath>

#include "layers/built_effects.h"
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

bool is_open(const layers::Layer& layer) {
  return layers::is_built(layers::Effect::MotionBlur) && layer.preferences.motion_blur > 0;
}

}  // namespace

bool any_shutter_open(const LayerTable& layers) { return std::any_of(layers.begin(), layers.end(), is_open); }

int other_frame(const Pipeline& pipeline, int frame) {
  const bool has_next =
      predicts(pipeline) || frame + 1 < pipeline.settings.frames || pipeline.settings.frames <= 0;
  return has_next || frame == 0 ? frame + 1 : frame - 1;
}

void capture_motion(const Pipeline& pipeline, const LayerTable& layers, const layers::SceneFrame& other,
                    int frame, std::span<layers::LayerState> states) {
  const double forwards = other_frame(pipeline, frame) > frame ? 1 : -1;
  for (const layers::Layer& layer : layers) {
    layers::LayerState& now = states[layer.id];
    if (!is_open(layer) || now.layer != layer.id) continue;
    const layers::LayerBound& bound = layers.bound(layer.id);
    const layers::LayerState there = layers::capture(other, layer, bound, pipeline.settings.view);
    const layers::Correspondences matched = layers::correspond(now, there, bound.hull);
    now.motion_px = matched.overlap ? forwards * mean_motion(matched) : layers::dvec2(0);
  }
}

MotionSampling motion_sampling(const LayerTable& layers, const layers::LayerState& now) {
  MotionSampling sampling{now.motion_px, 1};
  const double blur_px = glm::length(sampling.motion_px) * layers[now.layer].preferences.motion_blur;
  if (blur_px > 1) sampling.density = std::max(1 / blur_px, kLeastDensity);
  return sampling;
}

void apply_motion_blur(const LayerTable& layers, const layers::LayerState& now,
                       layers::PlacementOptions& placement) {
  const MotionSampling sampling = motion_sampling(layers, now);
  placement.motion = sampling.motion_px;
  placement.motion_density = sampling.density;
}

void judge_motion_blur(const LayerTable& layers, const layers::LayerState& then,
                       const layers::LayerState& now, regulator::LayerAssessment& assessment) {
  const MotionSampling before = motion_sampling(layers, then), wanted = motion_sampling(layers, now);
  const double ratio = wanted.density / before.density;
  fiducials::Sampling& sampling = assessment.fiducials.sampling;
  sampling.magnification = std::max(sampling.magnification, ratio);
  sampling.minification = std::min(sampling.minification, ratio);
}

}  // namespace talisman::sequences
