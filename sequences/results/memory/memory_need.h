// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Will a run fit into memory? Said before it starts, since what does not fit is ended by the system without a word.
///
///   need = content           what the process holds once the sequence is read
///        + sprites           4 bytes a texel of every layer in view, whole chunks, as large as they are in the worst of kSampled
///                            frames spread over the run; of `direct` the display; of `predictive` its buffers, 8 bytes a pixel
///        + pictures          frames that are composed, encoded and written at one time, 11 bytes a pixel each
///        + kept frames       of policies that look ahead (pipeline/kept_frames.h)
///
/// An estimate, within twice the peak: parts of a run that share memory, and what a drawing needs beside its chunks, are not told
/// apart. So half of what was estimated is certainly needed.

#include <cstdint>
#include <optional>
#include <string>

#include "sequences/content/sequence.h"
#include "sequences/pipeline/pipeline.h"
#include "sequences/results/run_options.h"

namespace talisman::sequences {

/// Bytes.
struct MemoryNeed {
  std::int64_t content = 0, sprites = 0, pictures = 0, kept_frames = 0;
  std::int64_t frame = 0;  ///< of one kept frame
  std::int64_t total() const { return content + sprites + pictures + kept_frames; }
};

/// Cost: kSampled frames are captured and their sprites placed.
MemoryNeed memory_need(const Sequence& sequence, const Settings& settings, const RunOptions& options);

/// What is to be said of it before the run starts: a warning where the estimate is more than is free; empty: nothing. Throws
/// InputError where half of it is.
std::string memory_warning(const MemoryNeed& need, std::int64_t free_bytes);

/// The same of this run on this machine, where it could be large at all: all others cost a look at their sizes. Of policy Oracle,
/// which keeps each frame that it looks at, also what that takes once it is much.
std::string memory_words(const Sequence& sequence, const Settings& settings, const RunOptions& options);

}  // namespace talisman::sequences
