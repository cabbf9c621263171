// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/sampled_frames.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "layers/check.h"

namespace talisman::sequences {
namespace {

/// How often the sampled frames have met each phase of each period of hold and interpolate.
class Phases {
 public:
  Phases() {
    for (const int period : compared_holds()) hits_.emplace_back(period, 0);
  }
  /// Times that the phases of `frame` were met, each in proportion to how rare it is.
  int met(int frame) const {
    int weighted = 0;
    for (const std::vector<int>& hits : hits_)
      weighted += static_cast<int>(hits.size()) * hits[frame % hits.size()];
    return weighted;
  }
  void add(int frame) {
    for (std::vector<int>& hits : hits_) ++hits[frame % hits.size()];
  }

 private:
  std::vector<std::vector<int>> hits_;
};

}  // namespace

std::vector<int> compared_holds() { return {2, 3, 5, 8}; }

std::vector<int> sampled_frames(const ExperimentFrames& frames) {
  TALISMAN_CHECK_GE(frames.every, 1);
  TALISMAN_CHECK_LE(frames.first, frames.last);
  Phases phases;
  std::vector<int> sampled;
  for (int begin = frames.first; begin <= frames.last; begin += frames.every) {
    const int end = begin + std::min(frames.every - 1, frames.last - begin);
    const auto rank = [&](int frame) {
      return std::pair{phases.met(frame), std::abs(2 * frame - begin - end)};
    };
    int best = begin == 0 && end > 0 ? 1 : begin;  // frame 0 has no predecessor
    for (int frame = best + 1; frame <= end; ++frame)
      if (rank(frame) < rank(best)) best = frame;
    sampled.push_back(best);
    phases.add(best);
    if (end == frames.last) break;  // the next stratum might begin beyond the largest number
  }
  return sampled;
}

std::vector<int> drawn_frames(const ExperimentFrames& frames) {
  std::vector<int> drawn;
  for (const int frame : sampled_frames(frames))
    for (const int either : {frame - 1, frame})
      if (either >= 0 && (drawn.empty() || drawn.back() < either)) drawn.push_back(either);
  return drawn;
}

bool is_sampled(const std::vector<int>& sampled, int frame) {
  return std::binary_search(sampled.begin(), sampled.end(), frame);
}

}  // namespace talisman::sequences
