// SPDX-License-Identifier: Apache-2.0
#pragma once

/// One setting of a sequence on its way through the frames: what the experiments measure of it.
///
/// All frames are planned; those that are compared with a truth are drawn, and their predecessors, so that
/// what a frame draws is what was due in it.

#include <vector>

#include "sequences/content/sequence.h"
#include "sequences/experiments/regulator/measured.h"
#include "sequences/experiments/seamed_sequence.h"
#include "sequences/pictures/diff.h"
#include "sequences/pipeline/step.h"
#include "sequences/results/summary.h"

namespace talisman::sequences {

class SettingRun {
 public:
  /// `settings` holds all that `setting` does not say. Seams are those that this setting needs (content/seams.h).
  SettingRun(const Sequence& sequence, Settings settings, const RegulatorSetting& setting);
  SettingRun(const SettingRun&) = delete;
  SettingRun& operator=(const SettingRun&) = delete;

  /// Plans frame `frame`, and draws it where `prepared` is given: the scene of the sequence as it was given.
  void advance(int frame, const chunker::PreparedScene* prepared);

  /// The frame of the last advance belongs to what is measured.
  void count();

  /// The frame of the last advance was drawn: how far it is from `truth`, and (where the truth of the frame
  /// before is given, too, and that was drawn) how hard it pops.
  void judge(const ConsecutiveFrames& truth);

  /// Empty where not drawn.
  ConsecutiveFrames pictures() const { return {before_, now_}; }
  /// Of the last judge.
  const Quality& quality() const { return qualities_.back().quality; }
  SettingResult result() const;
  /// Of the last advance.
  const FrameReport& report() const { return report_; }
  const PipelineState& state() const { return state_; }
  /// Of the frames that were counted, as a run of its own would have it.
  const Summary& summary() const { return summary_; }
  /// Of each frame that was judged.
  const std::vector<FrameDiff>& qualities() const { return qualities_; }

 private:
  RegulatorSetting setting_;
  SeamedSequence seamed_;
  Pipeline pipeline_;
  PipelineState state_;
  Summary summary_;
  FrameReport report_;
  Image8 before_, now_;
  std::vector<int> layers_before_;
  std::int64_t chunks_ = 0;
  std::vector<FrameLine> drawn_;
  std::vector<FrameDiff> qualities_;
  PoppingMeter popping_;
};

}  // namespace talisman::sequences
