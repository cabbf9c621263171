// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/frame_error.h"

#include <array>

#include "layers/outline.h"
#include "warp/fit.h"

namespace talisman::sequences {

namespace {

using layers::dvec2;
using layers::dvec3;

/// Nearer to the eye's plane than this nothing is shown: 1 is the weight of an affine map.
constexpr double kLeastWeight = 1e-9;

/// The display places of what of the corners' quadrilateral lies before the eye, in their order.
layers::Polygon2 projected(const std::array<dvec3, 4>& corners) {
  layers::Polygon2 polygon;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const dvec3 &here = corners[k], &next = corners[(k + 1) % corners.size()];
    if (here.z >= kLeastWeight) polygon.push_back(dvec2(here) / here.z);
    if ((here.z >= kLeastWeight) == (next.z >= kLeastWeight)) continue;
    const double share = (kLeastWeight - here.z) / (next.z - here.z);
    polygon.push_back(dvec2(here + share * (next - here)) / kLeastWeight);
  }
  return polygon;
}

double area_of(const ShownSprite& sprite, layers::ivec2 display_px) {
  return covered_px(sprite.screen_from_sprite, sprite.size_px, display_px);
}

}  // namespace

double covered_px(const layers::dmat3& screen_from_sprite, layers::ivec2 size_px, layers::ivec2 display_px) {
  const double w = size_px.x, h = size_px.y;
  const layers::Polygon2 quad =
      projected({screen_from_sprite * dvec3(0, 0, 1), screen_from_sprite * dvec3(w, 0, 1),
                 screen_from_sprite * dvec3(w, h, 1), screen_from_sprite * dvec3(0, h, 1)});
  return layers::area_of(layers::clip_to_rect(quad, {{0, 0}, dvec2(display_px)}));
}

FrameError error_of(const FrameReport& report) {
  FrameError error;
  bool is_bounded = true;
  int in_view = 0;
  for (const regulator::LayerDecision& decision : report.plan.decisions) {
    if (decision.action == regulator::Action::Drop) continue;
    error.mean_px += decision.shown_geometric_px;
    is_bounded = is_bounded && decision.shown_geometric_px < warp::kHugePx;
    ++in_view;
  }
  if (in_view > 0) error.mean_px /= in_view;
  double covered = 0;
  for (const ShownSprite& sprite : report.shown) {
    const double area = area_of(sprite, report.display_px);
    error.mean_by_pixels_px += area * report.plan.decisions[sprite.layer].shown_geometric_px;
    covered += area;
  }
  error.mean_by_pixels_px = covered > 0 ? error.mean_by_pixels_px / covered : 0;
  return is_bounded ? error : FrameError{warp::kHugePx, warp::kHugePx};
}

double sprite_depth(const FrameReport& report) {
  const double display = double(report.display_px.x) * report.display_px.y;
  double covered = 0;
  for (const ShownSprite& sprite : report.shown) covered += area_of(sprite, report.display_px);
  return display > 0 ? covered / display : 0;
}

}  // namespace talisman::sequences
