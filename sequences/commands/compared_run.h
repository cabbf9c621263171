// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A setting of `talisman compare` as it is typed, POLICY[:VALUE | :KEY=VALUE[,KEY=VALUE…]], and the options of
/// `render` that it stands for:
///
///   threshold:1             --policy threshold --geometric-px 1
///   budget:ms=5,choice=best --policy budget --budget-ms 5 --choice best
///   hold:3                  --policy hold --hold 3
///
/// A bare number is the policy's main setting: geometric-px of threshold and oracle, hold of hold and interpolate,
/// lookahead of lookahead, budget-ms of budget. Keys are the options of `render` that decide, with - or _; of policy
/// budget also without "budget-".

#include <string>
#include <vector>

#include "sequences/commands/options.h"

namespace talisman::sequences {

/// Throws InputError that begins with the setting.
std::vector<std::string> words_of_setting(const std::string& setting);

/// The run that these words make of `given` (sequence, frames, size, content). An option that the policy does not
/// read is refused. Throws InputError that begins with the setting.
ResolvedRun resolve_setting(const std::string& setting, const CommandLine& given, const Sequence& sequence);

}  // namespace talisman::sequences
