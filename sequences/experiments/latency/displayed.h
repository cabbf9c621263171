// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What does a late display show, by layers and by whole frames, and how wrong is it?
///
/// Each way of showing is judged by the true camera at the time of the frame:
///
///   px          |where a characteristic point is shown − where it is|, points on the display at t; of all layers, and of each
///   uncovered   share of the pixels on which the truth shows a layer and the frame shows none
///   FLIP        mean over the picture against `direct` at the true pose; of each layer over the pixels on which the truth
///               shows it
///   judder      |e(t) − e(t − 1 frame)|, mean: e is the mean error of a layer's points in x and y. Shown steps that equal
///               true steps have none, however late they are
///   reused      share of what is shown that was drawn for an earlier frame: of sprites, or of frames
///   age         frames since it was drawn
///
/// and of the pose that decisions know:
///
///   turn        angle to the true one;  px of it: × display height / field of view, at the middle
///   overshoot   of the error of the rotation (rotation vector, camera's space) the part along the turn since t − RENDER, where
///               it is ahead
///
/// Ways:
///
///   layers              policy threshold as the sequence has it, each sprite warped to the last pose
///   layers, every frame policy reference, likewise
///   whole frames        reprojected (reprojection.h), drawn for every frame; and as often as the polygons allow that the layers
///                       draw: frame f is drawn where ⌊(f + 1) s⌋ > ⌊f s⌋, s the layers' share of the polygons of all frames
///
/// Points of the grid are judged on the frames of which pictures are drawn, and have no judder. A whole frame knows of no motion but the camera's: what moves, and what hangs on the head, is carried as the world is.

#include <optional>
#include <string>
#include <vector>

#include "sequences/content/sequence.h"
#include "sequences/experiments/latency/latency_curve.h"
#include "sequences/experiments/latency/reprojection.h"
#include "sequences/experiments/sampled_frames.h"
#include "sequences/files/progress.h"
#include "sequences/pictures/page.h"

namespace talisman::sequences {

inline constexpr std::array kShownLatencies_ms = {0.0, 20.0, 50.0};

/// Of one layer under one way.
struct ShownLayer {
  std::string name;
  Spread px;
  double judder_px = 0;
  double flip = 0, uncovered = 0;  ///< means over the frames that were drawn
  std::int64_t pixels = 0;         ///< on which the truth shows it, in these
};

struct ShownWay {
  std::string name;
  bool is_whole = false;  ///< frames, not layers
  double polygons_per_frame = 0;
  double reused = 0;
  Spread age_frames;
  Spread px;
  double judder_px = 0;
  double flip = 0, uncovered = 0;
  std::vector<ShownLayer> layers;
};

struct ExpectedPose {
  Spread turn_deg, turn_px, overshoot_deg;
};

/// One latency and one prediction.
struct ShownLatency {
  double render_ms = 0, warp_ms = 0;
  regulator::Prediction predict = regulator::Prediction::Held;
  double layer_share = 0;  ///< s
  ExpectedPose pose;
  std::vector<ShownWay> ways;
};

struct DisplayedExperiment {
  std::string sequence;
  layers::ivec2 display_px{0, 0};
  ExperimentFrames frames;
  int drawn = 0;  ///< frames of which pictures were compared
  std::vector<ShownLatency> rows;
};

/// `settings`: all but policy of the rivals and latency. `warp_ms` ≥ 0: of the last warp; rows whose RENDER is below it have
/// none. Frames before the first are planned, not judged.
DisplayedExperiment measure_displayed(const Sequence& sequence, const Settings& settings,
                                      const ExperimentFrames& frames, double warp_ms, ProgressKind progress);

/// displayed.csv (a row for each way), displayed-layers.csv (for each layer of each), displayed-plot.svg (FLIP over polygons);
/// what is printed and displayed.html (published.h).
void write_report(const DisplayedExperiment& experiment, const std::string& dir);
Page page_of(const DisplayedExperiment& experiment);

/// Where layers win and where they lose, in words.
std::vector<std::string> verdict_of(const DisplayedExperiment& experiment);

}  // namespace talisman::sequences
