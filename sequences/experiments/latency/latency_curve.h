// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What does it cost that a frame is made of a pose that is old by the time it is shown, and what does a last warp save?
///
/// The picture for time t is drawn with the camera that is expected (pipeline/latency/late_camera.h) from what was known at t − RENDER. Just
/// before it is shown it is warped to the camera that is expected from what is known at t − WARP ≤ RENDER. The true
/// camera at t judges:
///
///   error_px of a point = |where it is shown − where it would be|      characteristic points of all layers that are on the
///                                                                      display at t, and before the near plane in neither
///   turn_deg            = angle between the camera that was drawn with and the true one
///
/// Things in the scene are as of t throughout: what is late is the camera alone. How the last warp moves a point that is
/// drawn at p with depth d, camera D drawn with and camera W warped to:
///
///   none         p
///   homography   K R_W⁻¹ R_D K⁻¹ p: the whole frame, as if all were infinitely far: exact where the camera only turns
///   layers       one affine map per layer, the least-squares fit of its characteristic points from D to W [LS97 4]
///   depth        where W sees the point: reprojection of every pixel by its depth. Holes are not counted here
///
/// Geometry only: no picture is drawn.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "sequences/content/sequence.h"
#include "sequences/pictures/page.h"
#include "sequences/pipeline/latency/late_camera.h"
#include "sequences/pipeline/pipeline.h"
#include "sequences/results/planned.h"

namespace talisman::sequences {

enum class LastWarp { None, Homography, Layers, Depth };
inline constexpr std::array kAllLastWarps = {LastWarp::None, LastWarp::Homography, LastWarp::Layers,
                                             LastWarp::Depth};
std::string_view name(LastWarp warp);

/// Milliseconds.
inline constexpr std::array kRenderLatencies_ms = {0.0, 10.0, 20.0, 50.0, 100.0};

/// From what is known least to what is known best.
inline constexpr std::array kExpectations = {regulator::Prediction::Held, regulator::Prediction::Linear,
                                             regulator::Prediction::Kalman, regulator::Prediction::Known};

struct Spread {
  double p50 = 0, p95 = 0, max = 0;
};

struct LatencyResult {
  double render_ms = 0;
  regulator::Prediction predictor = regulator::Prediction::Held;
  Spread turn_deg;                                      ///< over the frames
  std::array<Spread, kAllLastWarps.size()> error_px{};  ///< over points and frames, by LastWarp
};

struct LatencyCurve {
  std::string sequence;
  layers::ivec2 display_px{0, 0};
  FrameRange frames;
  double warp_ms = 0;
  std::int64_t points = 0;  ///< of one row, in all frames
  std::vector<LatencyResult> results;
};

/// `warp_ms` ≥ 0, of rows whose RENDER is not below it; of others it is RENDER.
LatencyCurve measure_latency(const Sequence& sequence, const Settings& settings, const FrameRange& frames,
                             double warp_ms);

/// Writes latency.csv, latency-plot.svg (p95 of the layers' error over RENDER) into the folder; what is printed and
/// latency.html (published.h).
void write_report(const LatencyCurve& curve, const std::string& dir);
Page page_of(const LatencyCurve& curve);

}  // namespace talisman::sequences
