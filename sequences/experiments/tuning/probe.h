// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How far are the pictures under these thresholds from the truth? Drawn only as far as the question asks.
///
/// A frame has the same bytes however it is reached (step.h), so the frames that are most likely to break the
/// goal are drawn first; one that breaks it is the answer, and the rest stays undrawn. What holds was drawn whole.
///
/// The truth is `draw_reference`, as `render --quality` compares with it (quality/reuse of frames.jsonl). It is
/// drawn once, when a frame is first asked for, and kept as files: no memory beyond two pictures.

#include <atomic>
#include <cmath>
#include <string>
#include <vector>

#include "sequences/experiments/tuning/goal.h"
#include "sequences/experiments/tuning/thresholds.h"
#include "sequences/files/progress.h"
#include "sequences/pipeline/make_pipeline.h"

namespace talisman::sequences {

enum class Verdict {
  Holds,    ///< all frames were drawn
  Fails,    ///< as far as it was drawn
  Unknown,  ///< no more frames may be drawn, or the user stopped
};

struct ProbedQuality {
  Verdict verdict = Verdict::Unknown;
  std::vector<double> badness;  ///< by frame of the range; NaN: was not drawn
  int frames_drawn = 0;
  bool is_whole() const { return frames_drawn == static_cast<int>(badness.size()); }
  std::vector<double> known() const;  ///< without the NaN
};

struct ProbeLimits {
  int frames = 0;  ///< that may be drawn in all, the truth among them
  const std::atomic<bool>* stop = nullptr;
};

class QualityProbe {
 public:
  /// Keeps references to the sequence. `folder` is there; the truth lies in a folder in it, until destruction.
  QualityProbe(const Sequence& sequence, const Settings& settings, const FrameRange& range,
               const TuneGoal& goal, const std::string& folder, const ProbeLimits& limits);
  ~QualityProbe();
  QualityProbe(const QualityProbe&) = delete;
  QualityProbe& operator=(const QualityProbe&) = delete;

  /// Against the goal; `of_goal` false: all frames, whatever they are. Throws OutputError.
  ProbedQuality probe(const PlannedThresholds& plan, bool of_goal);

  int frames_drawn() const { return drawn_; }
  int frames_left() const { return limits_.frames - drawn_; }
  bool is_stopped() const { return limits_.stop && *limits_.stop; }

 private:
  /// Frames of the range, the most suspicious first.
  std::vector<int> by_suspicion(const PlannedThresholds& plan) const;
  /// Draws those frames that are wanted. False: may not go on, or the goal is broken.
  bool draw(const PlannedThresholds& plan, const std::vector<bool>& wanted, bool of_goal,
            ProbedQuality& probed);
  bool is_broken(const ProbedQuality& probed) const;
  Image8 truth(int frame);
  std::string truth_path(int frame) const;

  const Sequence& sequence_;
  Settings settings_;
  FrameRange range_;
  TuneGoal goal_;
  std::string folder_;
  ProbeLimits limits_;
  chunker::PreparedScene prepared_;
  Pipeline reference_;
  std::vector<bool> has_truth_;                ///< by frame of the range
  std::vector<double> badness_per_suspicion_;  ///< by frame, where it was last drawn; 0: never
  int drawn_ = 0;
};

}  // namespace talisman::sequences
