// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Are the pictures of a frame still what a run wrote? Each line of frames.jsonl has a hash of them, and --resume keeps a
/// frame only while its files have it: a picture that was emptied, cut off or replaced is drawn anew.
///
///   one file           XXH3-128 of its bytes
///   with --separate    of that hash, and of the name and the hash of each picture beside it, in the order of names

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sequences/files/content_hash.h"
#include "sequences/results/run_options.h"

namespace talisman::sequences {

/// Files of --separate of each frame: names in DIR/separate.
using SeparateNames = std::map<int, std::vector<std::string>>;
SeparateNames separate_names(const RunOptions& options);

/// Hexadecimal; empty where nothing was written. `frame`: of the picture itself; none with --format none. `separate`: names
/// in DIR/separate, which are read; empty text too where one of them cannot be.
std::string picture_hash(const RunOptions& options, const std::optional<ContentHash>& frame,
                         std::vector<std::string> separate);

}  // namespace talisman::sequences
