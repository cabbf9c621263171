// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How old is what a run knows, and what does it expect from there?
///
/// Policy Lookahead expects frames ahead of what it knows of the scene. A late run (LatencyOptions) decides and draws every
/// frame with a camera that is expected of poses which are RENDER old, and may warp its sprites once more, just before they are
/// shown, to the camera that is expected of poses which are WARP old (sequences/pipeline/latency/late_camera.h).

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace talisman::regulator {

enum class Prediction {
  Known,   ///< the motion itself, as authored: the bound of what prediction can reach
  Held,    ///< all stays as it is
  Linear,  ///< on with the velocities between the last two (layers/predict.h)
  Kalman,  ///< on with the acceleration of a filter (layers/predict_kalman.h)
};
inline constexpr std::array kAllPredictions = {Prediction::Known, Prediction::Held, Prediction::Linear,
                                               Prediction::Kalman};
std::string_view name(Prediction prediction);  ///< "known", "held", "linear", "kalman"
std::optional<Prediction> prediction_from_name(std::string_view text);

inline constexpr double kNoLastWarp_ms = std::numeric_limits<double>::infinity();
inline constexpr double kLongestLatency_ms = 1000;

struct LatencyOptions {
  double render_ms =
      0;  ///< 0 … kLongestLatency_ms; age of the poses that decisions and sprites know; more is
          ///< farther off; 0: none is old
  double warp_ms =
      kNoLastWarp_ms;  ///< 0 … render_ms; of those that the last warp knows; infinite: there is none
  Prediction predict = Prediction::Held;  ///< of the pose from there; Known: as if nothing were old
  bool operator==(const LatencyOptions&) const = default;
};

/// Does a run with these options know old poses only?
bool is_late(const LatencyOptions& options);
/// … and is there a last warp that knows later ones?
bool warps_last(const LatencyOptions& options);

/// First broken rule in the words of users, or empty.
std::string first_defect(const LatencyOptions& options);

}  // namespace talisman::regulator
