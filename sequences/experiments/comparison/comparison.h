// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How do these settings compare on one sequence? All of them advance side by side, frame by frame; the policy
/// `reference` is the first and the truth of the others. Every frame of the range is drawn.
///
/// What is counted is what a run of each setting alone counts, to the byte (`Compared::summary` is its
/// summary.json, `Summary::frames` its frames.jsonl). Errors are against `reference` as a run shows it; popping as in
/// experiments/regulator/popping.h.

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "sequences/content/sequence.h"
#include "sequences/experiments/regulator/measured.h"
#include "sequences/files/progress.h"
#include "sequences/pictures/diff.h"
#include "sequences/results/planned.h"

namespace talisman::sequences {

struct ComparedSettings {
  std::string name;  ///< "budget:ms=5"
  Settings settings;
};

struct Compared {
  std::string name;
  SettingResult result;  ///< `modelled_ms`, `quality` and `popping` over the frames of the report
  Summary summary;
  DiffSummary quality;
  std::vector<double> flip;  ///< by frame of the report
  double worst_modelled_ms = 0;
};

struct ComparisonReport {
  std::string sequence;
  layers::ivec2 display_px{0, 0};
  double fps = 24;
  FrameRange frames;               ///< that were compared; fewer than asked for where it was stopped
  std::vector<Compared> compared;  ///< `reference` first; none: stopped before the first frame
  bool is_stopped = false;
};

/// One frame of all settings, in their order.
using ShownFrames = std::vector<const Image8*>;

/// `settings`: the first is of policy `reference` (programmer error otherwise). `show` sees each frame as it is done.
/// `stop` may be set by a signal handler: the frame at work is finished, then what was compared is returned.
ComparisonReport compare_settings(const Sequence& sequence, const std::vector<ComparedSettings>& settings,
                                  const FrameRange& range, ProgressKind progress,
                                  const std::atomic<bool>& stop,
                                  const std::function<void(int frame, const ShownFrames&)>& show);

}  // namespace talisman::sequences
