// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman render|plan … --shard i/N [--plan DIR]`: one part of a run (results/shards/shard.h), and
/// `talisman merge OUT`: the run out of its parts (results/shards/merge.h).

#include <atomic>
#include <iosfwd>
#include <string>

#include "sequences/commands/options.h"

namespace talisman::sequences {

/// Throws InputError for options that have no meaning without a shard.
void require_shard_options(const CommandLine& line, bool plan_only);

/// Exit code. With --resume a shard that is complete is left as it is. Throws InputError, OutputError, PartialResult.
int run_shard(const CommandLine& line, bool plan_only, const std::atomic<bool>& stop, std::ostream& out);

struct MergeOptions {
  std::string out;
  bool allow_partial = false, force = false, quiet = false;
};

int run_merge(const MergeOptions& options, std::ostream& out);

}  // namespace talisman::sequences
