// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <ostream>

#include "sequences/commands/fan_out/shard_command.h"
#include "sequences/files/how_many.h"
#include "sequences/results/shards/merge.h"

namespace talisman::sequences {

int run_merge(const MergeOptions& options, std::ostream& out) {
  const Merged merged = merge_shards(options.out, options.allow_partial, options.force);
  if (!merged.left_out.empty()) {
    std::string names;
    for (const std::string& one : merged.left_out) names += (names.empty() ? "" : ", ") + one;
    throw PartialResult(options.out + ": without " + how_many(merged.left_out.size(), "shard") + " (" +
                        names + "); the same command without --shard and with --resume draws the rest");
  }
  if (!options.quiet)
    out << table_of(merged.summary) << "\nmerged "
        << how_many(static_cast<std::size_t>(merged.shards), "shard") << ", results in " << options.out
        << "\n";
  if (!merged.without_video.empty())
    throw PartialResult(merged.without_video + "; all frames and results are there");
  return kSuccess;
}

}  // namespace talisman::sequences
