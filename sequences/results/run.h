// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A whole run: frame after frame through `step`, results into a folder.
///
/// The plan always starts at frame 0, whatever range is asked for, so a frame has the same bytes however it is
/// reached. Frames are written while the next ones are drawn (frame_writer.h). A frame is complete when its picture
/// has its final name and its line is in frames.jsonl.partial; --resume keeps complete frames and goes on with the
/// rest. The video is made last, of what is there, so that its failure costs nothing but itself.

#include <atomic>

#include "sequences/content/sequence.h"
#include "sequences/results/run_options.h"
#include "sequences/results/summary.h"

namespace talisman::sequences {

struct RunOutcome {
  Summary summary;
  bool complete = false;           ///< false: stopped by a signal
  int frames_kept = 0;             ///< complete frames taken over from an earlier run
  std::string without_video = {};  ///< why there is none although it was asked for; all else is there
};

/// Runs the sequence. Throws InputError (bad options, nothing to resume), OutputError (a file cannot be
/// written); complete frames stay. `stop` may be set by a signal handler: the frame at work is finished, then
/// the run returns incomplete.
RunOutcome run(const Sequence& sequence, const Settings& settings, const RunOptions& options,
               const std::atomic<bool>& stop);

}  // namespace talisman::sequences
