// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/warps/update_rate.h"

#include <cmath>

#include <oneapi/tbb/parallel_for.h>

#include "layers/check.h"
#include "warp/quadrilateral.h"

namespace talisman::sequences {
namespace {

using layers::Correspondences;
using layers::LayerState;
using warp::Curve;
using warp::FitOptions;
using warp::FitResult;

/// The error where no warp can serve.
constexpr double kNoWarp = warp::kHugePx;

bool minimises_maximum(Curve curve) {
  return curve == Curve::trni || curve == Curve::isoi || curve == Curve::soi || curve == Curve::affi ||
         curve == Curve::per2i;
}

struct Fitted {
  double lower = 0, upper = 0;  ///< bounds of the error that is compared with the threshold, px
};

Fitted fit_pair(const CapturedAnimation& animation, int then_frame, int now_frame, Curve curve,
                const FitOptions& options) {
  const LayerState &then = animation.states[then_frame], &now = animation.states[now_frame];
  const Correspondences matched = layers::correspond(then, now, animation.hull);
  if (!matched.overlap) return {kNoWarp, kNoWarp};
  const FitResult result = warp::fit(then, now, matched, curve, options);
  if (!result.usable()) return {kNoWarp, kNoWarp};
  // Only a bound of the very error that is minimised can stand for it; any other error is what was measured.
  const bool bounded =
      minimises_maximum(curve) && options.decide_px >= 0 && result.status == warp::FitStatus::Converged;
  return {bounded ? result.max_lower_bound_px : result.max_px, result.max_px};
}

/// One pass over the frames. `exceeds(then, now)` is asked for frames whose picture may have changed.
template <typename Exceeds>
int count_renders(const CapturedAnimation& animation, double threshold_px, Exceeds exceeds) {
  int renders = 0, then = -1;
  for (int now = 0; now < animation.frames(); ++now) {
    const LayerState& state = animation.states[now];
    if (!state.touches_display) continue;
    if (then >= 0) {
      if (state.same_pixels(animation.states[then])) continue;
      if (threshold_px > 0 && !exceeds(then, now)) continue;
    }
    ++renders;
    then = now;
  }
  return renders;
}

}  // namespace

std::vector<layers::LayerSpec> whole_scene() {
  layers::LayerSpec all;
  all.name = "object";
  all.part_globs = {"*"};
  return {all};
}

CapturedAnimation capture_animation(const layers::Scene& scene, int frames, double fps,
                                    const layers::View& view, layers::BoundKind bound) {
  TALISMAN_CHECK_GE(frames, 1);
  TALISMAN_CHECK(fps > 0);
  const layers::LayerSet set = layers::factor(scene, whole_scene());
  const layers::LayerBound layer_bound = layers::make_layer_bound(scene, set.layers[0], bound);
  CapturedAnimation animation;
  animation.hull = layer_bound.hull;
  animation.states.reserve(frames);
  for (int frame = 0; frame < frames; ++frame)
    animation.states.push_back(layers::capture(scene.at(frame / fps), set.layers[0], layer_bound, view));
  return animation;
}

int simulate(const CapturedAnimation& animation, Curve curve, double threshold_px) {
  return count_renders(animation, threshold_px, [&](int then, int now) {
    return fit_pair(animation, then, now, curve, {}).upper > threshold_px;
  });
}

UpdateCounter::UpdateCounter(const CapturedAnimation& animation, Curve curve)
    : animation_(animation), curve_(curve), errors_(animation.states.size()) {}

int UpdateCounter::renders(double threshold_px) {
  return count_renders(animation_, threshold_px,
                       [&](int then, int now) { return exceeds(then, now, threshold_px); });
}

bool UpdateCounter::exceeds(int then, int now, double threshold_px) {
  std::vector<Interval>& known = errors_[then];
  const auto age = static_cast<std::size_t>(now - then - 1);
  if (known.size() <= age) known.resize(age + 1);
  Interval& error = known[age];
  const bool undecided = error.lower <= threshold_px && threshold_px < error.upper;
  if (undecided && error.lower < error.upper) {
    const Interval more = fitted(then, now, threshold_px);
    error = {std::fmax(error.lower, more.lower), std::fmin(error.upper, more.upper)};
  }
  return error.upper > threshold_px;
}

UpdateCounter::Interval UpdateCounter::fitted(int then, int now, double threshold_px) {
  FitOptions options;
  options.decide_px = threshold_px;
  ++fits_;
  const Fitted result = fit_pair(animation_, then, now, curve_, options);
  return {result.lower, result.upper};
}

std::vector<double> figure_thresholds() {
  std::vector<double> thresholds;
  for (int k = -6; k <= 12; ++k) thresholds.push_back(std::sqrt(std::ldexp(1.0, k)));
  return thresholds;
}

std::vector<Curve> all_curves() {
  return {Curve::trn,  Curve::trni, Curve::iso,  Curve::isoi, Curve::so,    Curve::soi,  Curve::aff,
          Curve::affi, Curve::per,  Curve::peri, Curve::per2, Curve::per2i, Curve::pers, Curve::pers2};
}

std::vector<UpdateCurve> update_curves(const CapturedAnimation& animation,
                                       const std::vector<double>& thresholds_px) {
  const std::vector<Curve> curves = all_curves();
  std::vector<UpdateCurve> result(curves.size());
  oneapi::tbb::parallel_for(std::size_t{0}, curves.size(), [&](std::size_t k) {
    UpdateCounter counter(animation, curves[k]);
    result[k].curve = curves[k];
    result[k].frames = animation.frames();
    for (const double threshold : thresholds_px) result[k].renders.push_back(counter.renders(threshold));
  });
  return result;
}

double threshold_for_rate(UpdateCounter& counter, double rate) {
  double lo = 1e-4, hi = 1e5;
  if (counter.rate(lo) <= rate) return lo;
  while (hi / lo > 1 + 1e-6) {
    const double middle = std::sqrt(lo * hi);
    (counter.rate(middle) <= rate ? hi : lo) = middle;
  }
  return hi;
}

}  // namespace talisman::sequences
