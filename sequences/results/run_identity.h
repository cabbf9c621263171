// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What is this run? run.json (talisman.run/2) says it in full, for people and for --resume:
///
///   identity   hash (XXH3-128) of the version, the sequence's name, all settings and the content: two runs with the same
///              identity make the same decisions and the same pictures, frame by frame
///   version    of talisman
///   kind       "render" or "plan"
///   frames, format, overlay, separate, quality    which of it is written: not part of the identity
///   settings   every field of Settings (settings_json.h)
///   options    what the command line asked of the content, where it did: exposure, turntable, stage
///   content    hash (XXH3-128) of every file that the sequence was read from, by name: its YAML files, models and what
///              they refer to, textures, terrain and lists. Names do not depend on the machine: that in the
///              Debian package, or the path from the sequence file.

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "sequences/content/sequence.h"
#include "sequences/pipeline/step.h"
#include "sequences/results/run_options.h"

namespace talisman::sequences {

/// Reads all content files once. Throws InputError if one cannot be read any more.
nlohmann::ordered_json run_json(const Sequence& sequence, const Settings& settings,
                                const RunOptions& options);

/// The first thing in which the run of `before` is another one than that of `now`, and the rule, in words:
/// "geometric_px was 4.0, is 8.0, --resume must continue with the same options"; empty if they are the same.
std::string first_difference(const nlohmann::ordered_json& before, const nlohmann::ordered_json& now);

}  // namespace talisman::sequences
