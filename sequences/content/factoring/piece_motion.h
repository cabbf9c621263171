// SPDX-License-Identifier: Apache-2.0
#pragma once

/// For how many frames would one warp carry some pieces together? Relative velocity on the display [LS97 2.1].
///
/// At some instants s of the sequence the characteristic points of every piece are matched with those of the frames
/// s + 1, s + 2, s + 4, …: what the pieces of a group have is put together and one warp is fitted, as in a run. The sprite of
/// a group drawn at s serves until its worst point is off by more than the threshold T. Between two intervals the error
/// e is taken to grow as a power of time:
///
///   reuse(s) = L₁ (L₂ / L₁)^(ln(T / e₁) / ln(e₂ / e₁))     e₁ ≤ T < e₂, at intervals L₁ < L₂
///
/// A group of which a piece comes into view is drawn again then. What the estimate does not know: the sides of cut
/// sprites that come into view, light, and sprites that grow with their motion.

#include <span>
#include <vector>

#include "layers/layer.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// Instants at which pieces are looked at, at most.
inline constexpr int kMostInstants = 32;

/// Frames spread evenly over a sequence: the middles of as many stretches. Ascending, each once.
std::vector<int> spread_frames(int frames, int at_most);

class PieceMotion {
 public:
  PieceMotion(const layers::Scene& scene, std::span<const layers::Layer> pieces, const Settings& settings,
              const std::vector<int>& instants);

  std::size_t instants() const { return at_.size(); }
  bool in_view(int piece, std::size_t instant) const { return at_[instant].bounds[piece].in_view; }
  /// Of what a sprite would hold, on the display and somewhat beyond; empty out of view.
  const layers::RectD& bounds(int piece, std::size_t instant) const {
    return at_[instant].bounds[piece].rect;
  }
  /// ≥ 1; HUGE_VAL where nothing moves. Pieces that are out of view take no part; all of them: HUGE_VAL.
  double reuse_frames(std::span<const int> pieces, std::size_t instant) const;

 private:
  struct Bounds {
    bool in_view = false;
    layers::RectD rect;
  };
  /// The matched points of a piece over one interval.
  struct Matched {
    std::size_t first = 0, count = 0;  ///< in `then_px` and `now_px`
    bool appears = false;              ///< in view now, and not then
    bool lost = false;                 ///< in view both times, and nothing of it is the same
  };
  struct Interval {
    int frames = 1;
    std::vector<Matched> pieces;
    std::vector<layers::dvec2> then_px, now_px;
  };
  struct Instant {
    std::vector<Bounds> bounds;
    std::vector<Interval> intervals;
  };
  double error_px(std::span<const int> pieces, const Interval& interval) const;

  std::vector<Instant> at_;
  Settings settings_;
};

}  // namespace talisman::sequences
