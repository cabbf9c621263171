// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/factoring/piece_motion.h"

#include <algorithm>
#include <cmath>

#include "layers/state.h"
#include "warp/fit.h"

namespace talisman::sequences {

namespace {

using layers::LayerState;

constexpr int kLongestInterval_frames = 256;

std::vector<LayerState> states_of(const layers::Scene& scene, std::span<const layers::Layer> pieces,
                                  const std::vector<layers::LayerBound>& bounds, const Settings& settings,
                                  int frame) {
  const layers::SceneFrame at = scene.at(frame / settings.fps);
  const layers::FrameCapture capture(at, settings.view);
  std::vector<LayerState> states(pieces.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) capture.capture(pieces[i], bounds[i], states[i]);
  return states;
}

}  // namespace

std::vector<int> spread_frames(int frames, int at_most) {
  const int count = std::clamp(at_most, 1, std::max(frames, 1));
  std::vector<int> spread;
  for (int i = 0; i < count; ++i)
    spread.push_back(static_cast<int>((2LL * i + 1) * std::max(frames, 1) / (2LL * count)));
  return spread;
}

PieceMotion::PieceMotion(const layers::Scene& scene, std::span<const layers::Layer> pieces,
                         const Settings& settings, const std::vector<int>& instants)
    : settings_(settings) {
  std::vector<layers::LayerBound> bounds;
  for (const layers::Layer& piece : pieces)
    bounds.push_back(layers::make_layer_bound(scene, piece, settings.bound, settings.material_points));
  for (const int frame : instants) {
    Instant& instant = at_.emplace_back();
    const std::vector<LayerState> then = states_of(scene, pieces, bounds, settings, frame);
    for (const LayerState& state : then)
      instant.bounds.push_back({state.touches_display, state.screen_bounds_px});
    for (int length = 1; length <= kLongestInterval_frames && frame + length < settings.frames; length *= 2) {
      Interval& interval = instant.intervals.emplace_back();
      interval.frames = length;
      const std::vector<LayerState> now = states_of(scene, pieces, bounds, settings, frame + length);
      for (std::size_t i = 0; i < pieces.size(); ++i) {
        Matched matched{interval.then_px.size(), 0, !then[i].touches_display && now[i].touches_display,
                        false};
        if (then[i].touches_display && now[i].touches_display) {
          const auto points = layers::correspond(then[i], now[i], bounds[i].hull, length);
          matched.lost = !points.overlap;
          matched.count = points.then_px.size();
          interval.then_px.insert(interval.then_px.end(), points.then_px.begin(), points.then_px.end());
          interval.now_px.insert(interval.now_px.end(), points.now_px.begin(), points.now_px.end());
        }
        interval.pieces.push_back(matched);
      }
    }
  }
}

double PieceMotion::error_px(std::span<const int> pieces, const Interval& interval) const {
  thread_local std::vector<layers::dvec2> then_px, now_px;
  then_px.clear();
  now_px.clear();
  for (const int piece : pieces) {
    const Matched& matched = interval.pieces[piece];
    if (matched.appears || matched.lost) return warp::kHugePx;
    const auto first = static_cast<std::ptrdiff_t>(matched.first);
    const auto last = first + static_cast<std::ptrdiff_t>(matched.count);
    then_px.insert(then_px.end(), interval.then_px.begin() + first, interval.then_px.begin() + last);
    now_px.insert(now_px.end(), interval.now_px.begin() + first, interval.now_px.begin() + last);
  }
  return then_px.empty() ? 0 : warp::fit(then_px, now_px, settings_.curve, settings_.fit).max_px;
}

double PieceMotion::reuse_frames(std::span<const int> pieces, std::size_t instant) const {
  const double limit = settings_.regulator.thresholds.geometric_px;
  const Instant& at = at_[instant];
  if (std::none_of(pieces.begin(), pieces.end(), [&](int piece) { return in_view(piece, instant); }))
    return HUGE_VAL;
  double frames = 0, error = 0;  // of the last interval over which the sprite served
  for (const Interval& interval : at.intervals) {
    const double now = error_px(pieces, interval);
    if (now > limit) {
      if (frames == 0) return 1;
      if (!(error > 0)) return interval.frames;  // at rest, then something came
      const double share = std::log(limit / error) / std::log(now / error);
      return frames * std::pow(interval.frames / frames, std::clamp(share, 0.0, 1.0));
    }
    frames = interval.frames;
    error = now;
  }
  return error > 0 ? std::max(1.0, frames * (limit / error)) : HUGE_VAL;
}

}  // namespace talisman::sequences
