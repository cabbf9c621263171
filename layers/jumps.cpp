// SPDX-License-Identifier: Apache-2.0
#include "layers/jumps.h"

#include <algorithm>

namespace talisman::layers {

namespace {

/// When a track begins again: repetitions that may be counted at most.
constexpr double kMostRepeats = 1e6;

template <typename T>
void add_jumps(const Keys<T>& keys, std::vector<double>& jumps) {
  for (std::size_t i = 1; i < keys.values.size(); ++i) {
    const bool is_at_once =
        keys.interpolation == Interpolation::Step || keys.times_s[i] - keys.times_s[i - 1] <= kJump_s;
    if (is_at_once && !(keys.values[i] == keys.values[i - 1])) jumps.push_back(keys.times_s[i]);
  }
}

template <typename T>
bool returns_elsewhere(const Keys<T>& keys) {
  return keys.values.size() > 1 && !(keys.values.front() == keys.values.back());
}

template <typename T>
void extend(const Keys<T>& keys, double& begin_s, double& end_s) {
  if (keys.times_s.empty()) return;
  begin_s = std::min(begin_s, keys.times_s.front());
  end_s = std::max(end_s, keys.times_s.back());
}

void add_repeated(const TransformTrack& track, const std::vector<double>& own, double until_s,
                  std::vector<double>& jumps) {
  double begin_s = HUGE_VAL, end_s = -HUGE_VAL;
  extend(track.translation, begin_s, end_s);
  extend(track.rotation, begin_s, end_s);
  extend(track.scale, begin_s, end_s);
  if (track.loop_end_s > 0) begin_s = 0, end_s = track.loop_end_s;
  const double period = end_s - begin_s;
  if (!(period > kJump_s) || !((until_s - begin_s) / period < kMostRepeats)) {
    jumps.insert(jumps.end(), own.begin(), own.end());
    return;
  }
  const bool is_torn = returns_elsewhere(track.translation) || returns_elsewhere(track.rotation) ||
                       returns_elsewhere(track.scale);
  for (double shift = 0; begin_s + shift <= until_s; shift += period) {
    for (const double t : own) jumps.push_back(t + shift);
    if (is_torn) jumps.push_back(end_s + shift);
  }
}

void add_track(const TransformTrack& track, double end_s, std::vector<double>& jumps) {
  std::vector<double> own;
  add_jumps(track.translation, own);
  add_jumps(track.rotation, own);
  add_jumps(track.scale, own);
  if (track.loop)
    add_repeated(track, own, end_s, jumps);
  else
    jumps.insert(jumps.end(), own.begin(), own.end());
}
void add_track(const FlightTrack& track, double, std::vector<double>& jumps) {
  add_jumps(track.position, jumps);
  add_jumps(track.target, jumps);
}
void add_track(const SpinTrack&, double, std::vector<double>&) {}
void add_track(const MorphTrack&, double, std::vector<double>&) {}

}  // namespace

std::vector<double> jumps_of(const Scene& scene, double end_s) {
  std::vector<double> jumps;
  for (const Track& track : scene.tracks)
    std::visit([&](const auto& motion) { add_track(motion, end_s, jumps); }, track.motion);
  std::sort(jumps.begin(), jumps.end());
  jumps.erase(std::unique(jumps.begin(), jumps.end()), jumps.end());
  return jumps;
}

bool any_between(const std::vector<double>& jumps, double after_s, double to_s) {
  const auto next = std::upper_bound(jumps.begin(), jumps.end(), after_s);
  return next != jumps.end() && *next <= to_s;
}

}  // namespace talisman::layers
