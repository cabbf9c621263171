// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The folder of a run: what is in it when a run begins, and what of that stays.
///
///   run.json             which run this is (run_identity.h)
///   frames/NNNN.png      or .exr; the pictures
///   decisions.jsonl, frames.jsonl, timing.jsonl    NAME.partial until the run is complete
///   changes.jsonl        likewise, where the report is made
///   summary.json, video.mp4                        of a complete run alone
///
/// A folder holds one run. Another one in its place removes what was left of the first; a plan does not go into
/// the folder of pictures.

#include <map>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sequences/results/frame_lines.h"
#include "sequences/results/run_options.h"

namespace talisman::sequences {

std::string frame_path(const RunOptions& options, int frame);

/// Throws InputError if something else stands where a folder or a file of the run belongs. Touches nothing.
void require_places(const RunOptions& options);

/// What an earlier run completed, and this one need not do again: frames whose line is there, and whose picture still has
/// the hash that it says (kept_pictures.h).
struct KeptRun {
  std::map<int, FrameLine> frames;  ///< with their times
  std::vector<std::string> timing;  ///< lines of timing.jsonl: of those frames and of the processes
  std::string news{};  ///< what became of an earlier run, or of the wish to go on with one; empty: nothing
};

/// Makes the folders, removes what killed runs left half written, and (unless `resume` asks to go on with what is
/// complete) all results of an earlier run. A folder that holds other files, or pictures where this run draws none, is
/// refused unless `force`. `run` is what run.json is to say; it is written. Throws InputError when the run to be resumed
/// is another one, OutputError when a folder or file cannot be written.
KeptRun begin_run(const RunOptions& options, const nlohmann::ordered_json& run);

}  // namespace talisman::sequences
