// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Many settings × many sequences, each a run of its own. A sweep file:
///
///   out: out/sweep                   where results go, as --out of the working folder
///   sequences: [carousel, my.yaml]   names or paths, as `talisman plan` takes them
///   command: plan                    or render
///   options: {size: 160x120}         of every run: names of options without their dashes; true: a flag
///   settings: [{policy: hold, hold: 2}, {geometric-px: 4}]      one run each …
///   grid: {geometric-px: [1, 2, 4], warp: [aff, trn]}           … and every combination of these
///
/// Jobs are counted from 0: for each sequence the settings, then the combinations, keys of the grid by name, the last one fastest. Job k
/// writes into OUT/jobs/NNNN; what it cannot do stands in OUT/jobs/NNNN.failed, one line. Of N shards, task t is shard
/// t mod N of job ⌊t / N⌋.

#include <string>
#include <vector>

#include "sequences/commands/options.h"

namespace talisman::sequences {

inline constexpr std::size_t kMostJobs = 100'000;

struct SweepJob {
  std::string name;  ///< "0007"
  std::string sequence;
  std::vector<std::string> words;  ///< of the command line, without the sequence and --out
  std::vector<std::string> own;    ///< of these, what is not common to all
};

struct Sweep {
  std::string file, out;
  bool render = false;
  std::vector<SweepJob> jobs;
  std::string folder(const SweepJob& job) const { return out + "/jobs/" + job.name; }
};

/// Throws InputError with file, line and rule.
Sweep read_sweep(const std::string& file);

/// The command line of a job; of a shard where `shards` > 1. Throws InputError for a word that is none.
CommandLine command_line_of(const Sweep& sweep, const SweepJob& job, int shard, int shards);

/// Words as a shell takes them.
std::string in_shell(const std::vector<std::string>& words);

}  // namespace talisman::sequences
