// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/split.h"

#include <ostream>

#include "sequences/files/errors.h"
#include "sequences/results/factoring/split_layer.h"

namespace talisman::sequences {

int run_split(const CommandLine& line, const std::string& layer, std::ostream& out) {
  if (!line.out.empty())
    throw InputError("--out is '" + line.out + "', must not be given with --split, which writes nothing");
  const Sequence sequence = load_with_warnings(line.sequence, line.content);
  const ResolvedRun run = resolve(line, sequence, true);
  const SplitSequence split = split_layer(sequence, layer);
  Settings apart = run.settings;
  apart.explicit_order = split.sequence.explicit_order;
  const FrameRange range{run.options.first_frame, run.options.last_frame};
  out << split_table(planned(sequence, run.settings, range), planned(split.sequence, apart, range), layer,
                     split.pieces);
  return kSuccess;
}

}  // namespace talisman::sequences
