// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How wrong is the old sprite, warped, for the frame now? [LS97 5]
///
/// - Geometric: F = maxᵢ ‖pᵢ - W p̂ᵢ‖, pixels, best 0 [LS97 5.1]; where a sprite holds shadows, highlights or
///   reflections, plus how far those have run over the surface (fiducials/shade_drift.h): the triangle inequality
///   makes the sum a bound of their displacement on the display.
/// - Photometric: F = maxᵢ ‖Cᵢ - W_C Ĉᵢ‖ of the shaded characteristic points, linear light, best 0; and the
///   angle by which a light has moved about the layer, radians, best 0 [LS97 5.2], fiducials/photometric.h.
/// - Sampling: singular values of the Jacobian of the map from sprite to display: how many display pixels one
///   texel is stretched or squeezed to; no unit, best 1 [LS97 5.3].
/// - Visibility: how far a side at which the sprite was cut off has come into view, pixels, best 0,
///   fiducials/cut_sides.h; and how large a side of the layer has turned to the eye, pixels, best 0,
///   fiducials/turned_faces.h [LS97 5.4].
///
/// No figure is ever non-finite: what is unknown or unbounded is warp::kHugePx.
///
/// Every fiducial is at its best at rest and says where on the display its worst case is. A fiducial that
/// cannot matter is not computed: `computed` is false and `why_not` says so.

#include <string>
#include <string_view>

#include "layers/sprite_transform.h"
#include "layers/state.h"
#include "warp/fit.h"

namespace talisman::fiducials {

using layers::dvec2;
using layers::dvec3;

struct Geometric {
  double px =
      0;  ///< kHugePx if the fit is not usable, or nothing could be matched although the layer is in view
  dvec2 where_px{0, 0};  ///< display position now of the worst characteristic point
  int point = -1;        ///< index into the correspondences; -1: none
};

struct Sampling {
  double magnification =
      1;  ///< largest singular value over the sprite, relative to the sprite as it was rendered; ≥ 0
  double minification = 1;  ///< smallest singular value, likewise
  double anisotropy = 1;    ///< largest ratio of the two at one place, ≥ 1
  dvec2 where_px{0, 0};
};

struct Visibility {
  bool computed = false;
  std::string_view why_not = "";
  double uncovered_px =
      0;  ///< depth to which a cut side has moved inside the display where the layer has content
  dvec2 where_px{0, 0};
};

/// One light of the scene, or none, or the eye.
struct LightRef {
  static constexpr int kNone = -1, kEye = -2;
  int index = kNone;           ///< into LayerState::lights, or one of the above
  std::string_view name = "";  ///< left to who knows the scene
};

struct Photometric {
  bool computed = false;
  std::string_view why_not = "";
  dvec3 multiplier{1, 1, 1};  ///< the colour warp W_C, 0 … 1 per channel; 1 at rest
  double color = 0;           ///< largest ‖C - W_C Ĉ‖: linear light, 1 is white, at most √3
  dvec2 where_px{0, 0};       ///< display position now of the worst point
  int point = -1;  ///< characteristic point, or, counted on behind those, a place of fiducials/lit_places.h;
                   ///< -1: none differs
  LightRef color_light;        ///< the light that changed most at that point
  double light_angle_rad = 0;  ///< largest change of a light's direction about the layer, 0 … π
  LightRef angle_light;        ///< that light, or the eye as seen by highlights
  double light_distance = 0;   ///< largest change of a light's distance, relative to the larger one, 0 … 1
};

struct TurnedFaces {
  bool computed = false;
  std::string_view why_not = "";
  int count = 0;         ///< faces of the polyhedron that faced away from the eye and face it now
  double px = 0;         ///< square root of the largest area on the display of one of them
  dvec2 where_px{0, 0};  ///< the middle of that face's part on the display
};

/// How far shadows, highlights and mirrored pictures have run over a surface since it was drawn
/// (fiducials/shade_drift.h). Already added to Geometric::px of the same report.
struct ShadeMotion {
  bool computed = false;
  std::string_view why_not = "";
  double px = 0;         ///< best 0
  dvec2 where_px{0, 0};  ///< on the display
  int trace = -1;        ///< index into LayerState::traces of the worst; -1: none moves
  std::string
      what{};  ///< that one in words, "the shadow of 'rotor' in light 'key'"; left to who knows the scene
};

struct Report {
  Geometric geometric;
  Sampling sampling;
  Visibility visibility;
  Photometric photometric{};  ///< not by `assess`: see fiducials/photometric.h
  TurnedFaces turned{};       ///< not by `assess`: see fiducials/turned_faces.h
  ShadeMotion shade{};
};

/// Singular values (largest first) of the 2×2 matrix | a b ; c d |, closed form [Blinn 96]:
///   σ₁ = (√((a + d)² + (c - b)²) + √((a - d)² + (c + b)²)) / 2,     σ₂ = |a d - b c| / σ₁
/// σ₂ is taken from the determinant, with exact products, because the difference of the roots cancels for
/// flat maps. Both are accurate to a few units in the last place. {kHugePx, 0} if an entry is not finite.
dvec2 singular_values(double a, double b, double c, double d);

/// Bounds of the singular values of a warp's Jacobian over a rectangle of its domain: exact for affine warps;
/// for a perspective warp upper bounds of magnification (and a lower bound of minification) that exceed the
/// truth by at most (w_max / w_min)^¼ or so, and the exact anisotropy; the worst values if the horizon
/// crosses the rectangle. where_px is the image of the place of largest magnification. An empty rectangle is
/// at its best. Cost: 20 ns, perspective about 1 µs.
Sampling sampling_over(const warp::Warp& warp, const layers::RectD& domain_px);

/// Geometric, sampling and visibility fiducials of showing at `now` the sprite that was rendered at `then`
/// with `placement`, carried by `fitted.warp`.
Report assess(const layers::LayerState& then, const layers::LayerState& now,
              const layers::SpritePlacement& placement, const layers::Correspondences& matched,
              const warp::FitResult& fitted);

}  // namespace talisman::fiducials
