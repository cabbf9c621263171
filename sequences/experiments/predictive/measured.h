// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What do shared buffers save, need and lose, beside sprites, under the same bound? Policy `predictive` against
/// `threshold`, `lookahead`, `oracle` and `direct` on the same frames.
///
/// One knob at a time, about δ = 1 px, N = 16, k = 2, joined in place:
///
///   δ 0.01, 0.1, 0.5, 1, 2, 4 px     N 2, 4, 8, 16, 32, 64     k 2, 4, N     each way of joining     intervals fixed, data
///
/// Plans are made of every frame, pictures of those that sampled_frames.h chooses and of their predecessors; a
/// picture that was due in a frame between is drawn with the predecessor, which is not timed.

#include <cstdint>
#include <string>
#include <vector>

#include "sequences/content/sequence.h"
#include "sequences/experiments/sampled_frames.h"
#include "sequences/files/progress.h"
#include "sequences/pictures/page.h"
#include "sequences/pictures/quality.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

struct PredictiveSetting {
  std::string series;  ///< which knob: "delta", "N", "k", "joining", "intervals", "threshold", "direct"
  std::string name;    ///< "predictive 1 px, N 16, k 2, in-place"
  double value = 0;    ///< of the knob
  regulator::RegulatorOptions options;
};
std::vector<PredictiveSetting> predictive_settings(const regulator::RegulatorOptions& base);

/// Milliseconds per frame, mean.
struct PredictiveResult {
  PredictiveSetting setting;
  // Of all frames, from the plan.
  std::int64_t draws = 0;  ///< parts drawn; of policies with sprites: layers
  std::int64_t shown = 0;  ///< parts (layers) × frames
  std::int64_t polygons = 0, polygons_reference = 0;
  std::int64_t joins = 0, joins_empty = 0;
  double largest_px = 0;  ///< displayed error
  double plan_ms = 0;
  // Of the frames that are drawn.
  double pixels_joined = 0, pixels_cleared = 0;  ///< a frame: compared and copied; cleared
  std::int64_t bytes = 0;                        ///< held at most: buffers with depth, or sprites
  double render_ms = 0, composite_ms = 0;
  double modelled_ms = 0;          ///< drawing and compositing, by the profile talisman-1996
  double modelled_joining_ms = 0;  ///< six operations a pixel [F96 4.1.10], at the compositor's rate
  Quality quality;                 ///< mean against `direct`
  double popping_rms =
      0;  ///< of the steps of the error from a frame to the next, over all pixels, code values
  double frame_ms() const { return plan_ms + render_ms + composite_ms; }
};

struct PredictiveExperiment {
  std::string sequence;
  layers::ivec2 display_px{0, 0};
  ExperimentFrames frames;
  int samples = 16;  ///< for each pixel; 1: joins are exact
  std::vector<PredictiveResult> results;
};

/// `settings`: all that the settings do not say. Those that the sequence cannot be run with are left out.
PredictiveExperiment measure_predictive(const Sequence& sequence, const Settings& settings,
                                        const ExperimentFrames& frames, ProgressKind progress);

/// predictive.csv, predictive.json, and plots of what each knob costs and loses; what is printed and predictive.html
/// (published.h).
void write_report(const PredictiveExperiment& experiment, const std::string& dir);
Page page_of(const PredictiveExperiment& experiment);

}  // namespace talisman::sequences
