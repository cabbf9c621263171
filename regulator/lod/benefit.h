// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What is one more detail of a layer worth?
///
/// As printed [Fu93 4.2], before anything is drawn:
///
///   benefit = size · accuracy · importance · focus · motion · hysteresis
///
///   size        π r² f² / d², px: the bounding sphere on the display
///   accuracy    1 - 0.5 / samples^m     samples: triangles, m = 1 (flat); vertices, m = 2 (Gouraud); pixels, m = 1
///                                       (by the pixel); never more than pixels
///   importance  of the layer, ≥ 0
///   focus       1 - w_f · distance from the centre of the display / half of its diagonal
///   motion      1 - w_m · px per frame / √(pixels / triangles)
///   hysteresis  1 - w_h · (levels between this and the last frame's, and one if it was drawn another way)
///
/// The paper says of the last three only that they are "reduced in proportion": lines with weights, clamped to 0 … 1, are
/// ours. With w = 0 a factor is 1.
///
/// By the error, after it is known:    benefit = importance · max(0, error of what is shown without - error with), px

namespace talisman::regulator {

inline constexpr double kBaseError = 0.5;

enum class LodShading { Flat, Gouraud, Pixel };

/// One level of one layer in one frame.
struct LodView {
  double size_px = 0;  ///< on the display, ≥ 0
  double triangles = 1, vertices = 1;
  double importance = 1;
  double from_centre = 0;      ///< of the display, in halves of its diagonal, ≥ 0
  double px_per_frame = 0;     ///< that it moves
  double levels_switched = 0;  ///< |L - L of the last frame| + [another way of drawing]
};

/// w ≥ 0 of the factors.
struct LodWeights {
  double focus = 0, motion = 0;
  double hysteresis = 0.05;  ///< more holds on to the level of the last frame longer
};

/// π r² f² / d²; all of `display_px` where the eye is inside of the sphere, and never more.
double sphere_px(double radius_m, double distance_m, double focal_px, double display_px);

/// 0.5 … 1.
double accuracy(const LodView& view, LodShading shading);

double printed_benefit(const LodView& view, LodShading shading, const LodWeights& weights = {});

/// `without_px`, `with_px`: errors as shown, px ≥ 0; the first may be infinite: nothing is shown, which counts as
/// kMostLodError_px.
inline constexpr double kMostLodError_px = 1e6;
double error_benefit(double without_px, double with_px, double importance);

}  // namespace talisman::regulator
