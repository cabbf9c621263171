// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/experiment_options.h"

#include <algorithm>
#include <cmath>

#include "sequences/commands/words.h"

namespace talisman::sequences {

std::string experiment_size(const Sequence& sequence, const ExperimentOptions& options) {
  if (!options.size.empty()) return options.size;
  const layers::ivec2 px = sequence.display_px;
  const double scale = std::min(1.0, double(kLargestDefault_px) / std::max(px.x, px.y));
  const auto scaled = [scale](int side) { return std::to_string(std::max(1L, std::lround(side * scale))); };
  return scaled(px.x) + "x" + scaled(px.y);
}

ResolvedRun experiment_run(const Sequence& sequence, const ExperimentOptions& options,
                           const std::string& size, const std::string& policy) {
  CommandLine line;
  line.policy = policy;
  line.frames = options.frames;
  line.size = size;
  line.progress = options.progress;
  return resolve(line, sequence, true);
}

ExperimentFrames experiment_frames(const ResolvedRun& run, int every, int samples) {
  if (every < 0)
    throw InputError("--quality-every is " + std::to_string(every) + ", must be at least 0 (0: automatic)");
  const int frames = run.options.last_frame - run.options.first_frame + 1;
  if (every == 0) every = std::max(1, (frames + samples - 1) / samples);
  return {run.options.first_frame, run.options.last_frame, every};
}

void require_progress_word(const std::string& word) { choice("--progress", word, kProgressWords); }

}  // namespace talisman::sequences
