// SPDX-License-Identifier: Apache-2.0
#include "regulator/lod/benefit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace talisman::regulator {
namespace {

/// 1 - what is taken off, 0 … 1; 0 for what is no number.
double reduced_by(double what) { return what <= 0 ? 1 : what < 1 ? 1 - what : 0; }

double capped_error(double error_px) {
  return error_px >= 0 && error_px < kMostLodError_px ? error_px : kMostLodError_px;
}

}  // namespace

double sphere_px(double radius_m, double distance_m, double focal_px, double display_px) {
  if (!(radius_m > 0)) return 0;
  if (!(distance_m > radius_m)) return display_px;
  const double radius_px = radius_m * focal_px / distance_m;
  return std::min(std::numbers::pi * radius_px * radius_px, display_px);
}

double accuracy(const LodView& view, LodShading shading) {
  const double of_shape = shading == LodShading::Flat      ? view.triangles
                          : shading == LodShading::Gouraud ? view.vertices
                                                           : view.size_px;
  const double samples = std::max(1.0, std::min(of_shape, view.size_px));
  return 1 - kBaseError / (shading == LodShading::Gouraud ? samples * samples : samples);
}

double printed_benefit(const LodView& view, LodShading shading, const LodWeights& weights) {
  const double triangle_px = std::sqrt(view.size_px / std::max(1.0, view.triangles));
  const double speed = weights.motion * view.px_per_frame;
  const double motion = speed > 0 ? reduced_by(speed / triangle_px) : 1;
  return view.size_px * accuracy(view, shading) * view.importance *
         reduced_by(weights.focus * view.from_centre) * motion *
         reduced_by(weights.hysteresis * view.levels_switched);
}

double error_benefit(double without_px, double with_px, double importance) {
  return importance * std::max(0.0, capped_error(without_px) - capped_error(with_px));
}

}  // namespace talisman::regulator
