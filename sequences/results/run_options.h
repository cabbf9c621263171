// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a run writes, and where: everything that is not a setting of the pipeline.

#include <optional>
#include <string>

#include "sequences/files/image_io.h"
#include "sequences/files/progress.h"

namespace talisman::sequences {

/// Which lines decisions.jsonl has: of every layer in every frame; of those that are drawn or whose decision is another
/// one than in the frame before; none, and no file.
enum class DecisionLines { All, Changed, None };

struct RunOptions {
  std::string out;                      ///< result folder, made if missing
  int first_frame = 0, last_frame = 0;  ///< inclusive
  /// First frame of the run of which this is a part (shards/shard.h); empty: it is whole. Lines that depend on the frame
  /// before are those of that run.
  std::optional<int> part_of_run_from = {};
  FrameFormat format = FrameFormat::Png;
  bool plan_only = false;  ///< decisions and costs without pixels
  bool separate = false;   ///< also each shade sprite alone, and the sums, in DIR/separate
  int audit_every = 0;     ///< every so many reuses of a layer are drawn fresh and compared; 0: none
  bool video = false, overlay = false, quality = false, resume = false;
  DecisionLines decisions = DecisionLines::All;
  bool force = false;    ///< also into a folder that holds other files
  bool changes = false;  ///< also changes.jsonl (report/changes.h)
  ProgressKind progress = ProgressKind::Auto;
};

}  // namespace talisman::sequences
