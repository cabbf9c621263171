// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The shards of a run (shard.h) become that run: `talisman merge OUT`.
///
/// OUT then holds what one run into it would have left, byte for byte, but for timing.jsonl, which says which machines
/// worked: run.json, frames (links to those of the shards where the file system has links), decisions, changes, summary,
/// what-if, and the report and the video where the shards asked for them.
///
/// Refused, all at once by their names: shards that are missing, unfinished (their folder is NAME.partial), damaged (a file
/// has not its hash), foreign (another run, other content, another version, not a shard), that have frames twice or leave
/// some out, or are parts of several N. With `allow_partial` the missing, unfinished and damaged ones are left out: OUT is
/// then as a run that was interrupted left it, and --resume draws the rest.
///
/// Cost: the bytes of the shards are read once (hashes), lines are copied, lines of frames are added up. No content, no
/// plan.

#include <string>
#include <vector>

#include "sequences/results/run.h"

namespace talisman::sequences {

struct Merged {
  Summary summary;
  RunOptions options;                 ///< of the whole run
  int shards = 0;                     ///< that were joined
  std::vector<std::string> left_out;  ///< with allow_partial: "3-of-16 is missing"
  std::string without_video = {};     ///< why there is none although it was asked for
};

/// Throws InputError where OUT holds no shards or cannot hold a run, PartialResult for what is refused, OutputError.
Merged merge_shards(const std::string& out, bool allow_partial, bool force = false);

}  // namespace talisman::sequences
