// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How often must an object be drawn again, if the error of its warped picture may reach a threshold?
/// [LS97 4.2, Fig. 14–16]
///
///   simulate(threshold, warp type, animation)
///     for each frame
///       positions of the characteristic points now
///       warp of that type that best maps the cached positions to them
///       error = maxᵢ ‖pᵢ - W p̂ᵢ‖
///       if error > threshold: render, cache the positions        (counts)
///       else: show the sprite, warped
///
///   update rate = renders / frames
///
/// No pixel is drawn. The first frame in which the object is on the display is a render; frames in which it
/// is not are neither renders nor warps. As in the regulator, a threshold of 0 px reuses only what did not
/// change at all, and a sprite none of whose content is in view now is drawn again.

#include <cmath>
#include <cstdint>
#include <vector>

#include "layers/polyhedron.h"
#include "layers/scene.h"
#include "layers/state.h"
#include "warp/fit.h"

namespace talisman::sequences {

/// All that the decisions depend on: the object's characteristic points in every frame.
struct CapturedAnimation {
  std::vector<layers::LayerState> states;  ///< one per frame
  layers::Polyhedron hull;
  int frames() const { return static_cast<int>(states.size()); }
};

/// All parts of a scene as one layer, "object".
std::vector<layers::LayerSpec> whole_scene();

/// The characteristic points of whole_scene() in frames 0 … frames - 1 at frame / fps seconds. frames ≥ 1,
/// fps > 0.
CapturedAnimation capture_animation(const layers::Scene& scene, int frames, double fps,
                                    const layers::View& view, layers::BoundKind bound);

/// Renders by the pseudocode, word by word: every fit in full. Slow; the oracle of UpdateCounter.
int simulate(const CapturedAnimation& animation, warp::Curve curve, double threshold_px);

/// The same count for many thresholds of one curve. It remembers between which bounds the error of each pair
/// of frames lies: what one threshold has fitted, the next mostly only compares. Fits in the maximum norm run
/// in decision mode (warp/fit.h). Errors that a threshold cannot be told from (relative gap 1e-6) count as
/// exceeding it. Cost of a count: at most frames fits, usually a few.
class UpdateCounter {
 public:
  /// Keeps a reference to `animation`.
  UpdateCounter(const CapturedAnimation& animation, warp::Curve curve);
  int renders(double threshold_px);
  double rate(double threshold_px) { return renders(threshold_px) / double(animation_.frames()); }
  std::int64_t fits() const { return fits_; }  ///< so far

 private:
  struct Interval {
    double lower = 0, upper = HUGE_VAL;  ///< px; upper HUGE_VAL: not fitted yet
  };
  bool exceeds(int then, int now, double threshold_px);
  Interval fitted(int then, int now, double threshold_px);

  const CapturedAnimation& animation_;
  warp::Curve curve_;
  std::vector<std::vector<Interval>> errors_;  ///< [then][now - then - 1], as far as was needed
  std::int64_t fits_ = 0;
};

/// 1/8 … 64 px in steps of √2: 19 thresholds.
std::vector<double> figure_thresholds();

/// The fourteen curves, those of one family side by side and the sum of squares first.
std::vector<warp::Curve> all_curves();

/// One curve of a figure.
struct UpdateCurve {
  warp::Curve curve{};
  std::vector<int> renders;  ///< one per threshold
  int frames = 0;            ///< of the animation: the most that there can be
};

/// A figure: all curves over all thresholds. The curves are independent jobs; the result does not depend on
/// the number of threads.
std::vector<UpdateCurve> update_curves(const CapturedAnimation& animation,
                                       const std::vector<double>& thresholds_px);

/// The inverse relation, by bisection on the logarithm: the smallest threshold (to a part in 1e6, within 1e-4
/// … 1e5 px) at which at most `rate` of the frames are rendered, for error/rate relations that fall
/// steadily. 1e5 px where no threshold is large enough.
double threshold_for_rate(UpdateCounter& counter, double rate);

}  // namespace talisman::sequences
