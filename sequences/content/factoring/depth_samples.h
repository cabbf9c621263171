// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which pieces are in front of which, and how much of the display does each touch? Looked at, not bounded: in some
/// frames every triangle is scan-converted into a small depth buffer of its piece, at the centres of coarse pixels.
///
/// The visibility sort asks bounding bodies, which is safe and knows nothing of valleys: the hull of a land contains all
/// that flies in it. What is found here says which of these bodies nevertheless have an order. It is an estimate: what is
/// thinner than a coarse pixel, or happens between two of the frames, is not seen.

#include <cstdint>
#include <span>
#include <vector>

#include "layers/layer.h"
#include "layers/state.h"

namespace talisman::sequences {

/// The longer side of the coarse pictures, in pixels.
inline constexpr int kDepthSide_px = 256;
/// Triangles that are looked at at most, over all frames; beyond it fewer frames are.
inline constexpr std::int64_t kMostDepthTriangles = 12'000'000;

/// What is at different depths at one coarse pixel; depths that differ by less than this share are the same.
inline constexpr double kSameDepth = 1e-4;

class DepthSamples {
 public:
  /// `pieces`: layers whose parts are drawn; `frames_s`: when.
  DepthSamples(const layers::Scene& scene, std::span<const layers::Layer> pieces,
               const std::vector<double>& times_s, layers::ivec2 display_px);

  int pieces() const { return static_cast<int>(touched_.empty() ? 0 : touched_.front().size()); }
  /// Coarse pixels, over all frames, at which `front` lies before `behind`.
  std::uint32_t in_front(int front, int behind) const { return front_[index(front, behind)]; }
  /// Frames in which `front` lies before `behind` somewhere.
  std::uint32_t frames_in_front(int front, int behind) const { return frames_[index(front, behind)]; }
  /// Frames in which one of them lies before the other.
  std::uint32_t related_frames(int a, int b) const { return related_[index(a, b)]; }
  /// Frames in which each of the two lies before the other somewhere.
  std::uint32_t mutual_frames(int a, int b) const {
    return frames_in_front(a, b) + frames_in_front(b, a) - related_frames(a, b);
  }
  /// Pixels of the display that the piece touches in the frame, counted by index of `frames_s`.
  double touched_px(int piece, int frame) const { return touched_[frame][piece] * display_per_coarse_px_; }
  /// Nearest depth along the view axis at which the piece was seen; HUGE_VAL: never.
  double nearest_m(int piece) const { return nearest_m_[piece]; }

 private:
  std::size_t index(int a, int b) const { return static_cast<std::size_t>(a) * nearest_m_.size() + b; }
  void add_frame(const layers::SceneFrame& frame, std::span<const layers::Layer> pieces);
  void relate();

  layers::ivec2 size_px_{1, 1};
  double display_per_coarse_px_ = 1;
  std::vector<std::uint32_t> front_, frames_, related_;
  std::vector<std::vector<double>> touched_;
  std::vector<double> nearest_m_;

  struct Seen {
    int piece;
    float inverse_w;
  };
  std::vector<std::vector<Seen>> seen_;  // of one frame, by coarse pixel
};

}  // namespace talisman::sequences
