// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What is in the folder of a shard, and is it still what was written? shard.json (talisman.shard/1):
///
///   version          of talisman
///   shard            [i, N]
///   frames           [first, last] of the shard; null: it has none
///   run              run.json of the whole run, with its identity
///   summary          of its frames (summary_parts.h)
///   what_if          of the shard with the run's last frame, where the run says it: the plans at ½ and 2 times the
///                    threshold (report/what_if.h)
///   report, thumbnails, video, fps    what is made of the whole run when it is merged
///   files            hash (XXH3-128) of every other file, by its path in the folder

#include <map>
#include <string>

#include <nlohmann/json.hpp>

#include "sequences/results/shards/shard.h"
#include "sequences/results/summary.h"

namespace talisman::sequences {

/// What the merge is to make besides.
struct ShardWishes {
  bool report = false, thumbnails = true, video = false;
  double fps = 24;
  nlohmann::ordered_json what_if;  ///< null: none
};

struct ShardFile {
  Shard shard;
  FrameRange range;  ///< `last` below `first`: empty
  std::string version;
  nlohmann::ordered_json run;
  Summary summary;
  ShardWishes wishes;
  std::map<std::string, std::string> files;
};

/// Hashes the folder and writes its shard.json. Throws OutputError.
void write_shard_file(const std::string& folder, const Shard& shard, const FrameRange& range,
                      const nlohmann::ordered_json& run, const Summary& summary, const ShardWishes& wishes);

/// Empty where it is none of this form.
std::optional<ShardFile> read_shard_file(const std::string& folder);

/// The first file of the folder that is not there, or has another hash; empty: all are as they were written.
std::string first_damaged(const std::string& folder, const ShardFile& shard);

}  // namespace talisman::sequences
