// SPDX-License-Identifier: Apache-2.0
#pragma once

/// One part of a run, so that many machines can make it: `--shard i/N`, i from 0 to N − 1.
///
/// The frames A … B of the run are cut into N contiguous ranges. Frame f belongs to the range
///   equally    ⌊(f − A) N / (B − A + 1)⌋
///   by cost    ⌊(C(f) + c(f)/2) N / C⌋, of a plan: c(f) is the modelled time of drawing frame f, C(f) the sum of those
///              before it, C of all; so each range costs about C / N, and a frame dearer than that is alone
/// Ranges may be empty (N > frames). Every shard plans from frame 0, as every run does, so that its frames have the bytes
/// that they have in one run; what it does not save is that plan, and to draw the sprites that live at its first frame.
///
///   OUT/shards/3-of-16.partial/   while it is made: a folder of a run, which --resume goes on with
///   OUT/shards/3-of-16/           complete: renamed when all of it, and shard.json (shard_file.h), is on the disk

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "sequences/results/planned.h"
#include "sequences/results/run_options.h"

namespace talisman::sequences {

inline constexpr const char* kShardsFolder = "shards";
inline constexpr int kMostShards = 100'000;

struct Shard {
  int index = 0;  ///< 0 ≤ index < of
  int of = 1;     ///< 1 … kMostShards
  bool operator==(const Shard&) const = default;
  std::string name() const { return std::to_string(index) + "-of-" + std::to_string(of); }
};

/// "3/16", "3-of-16"; empty for all else.
std::optional<Shard> shard_from(const std::string& text, const std::string& between);

/// OUT/shards/3-of-16
std::string shard_folder(const std::string& out, const Shard& shard);

/// The range of the shard; `last` below `first`: it is empty. `costs`: of the frames of `whole`, each ≥ 0; none: equally.
FrameRange part_of(const FrameRange& whole, const Shard& shard, const std::vector<double>& costs = {});

/// The modelled times of drawing the frames of `whole`, from the folder of a plan with this run.json. Throws InputError
/// when that is not complete, is of another run, or lacks frames.
std::vector<double> costs_in_plan(const std::string& folder, const FrameRange& whole,
                                  const nlohmann::ordered_json& run);

}  // namespace talisman::sequences
