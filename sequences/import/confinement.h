// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a reader of strangers' files may not do, whatever they make it do. It is set by the reader itself, before it opens
/// the first of them, and cannot be taken back.
///
///   processor time, memory   as many seconds and megabytes as it is told (RLIMIT_CPU, RLIMIT_AS)
///   files                    it may read, because models have others beside them; it makes, writes, renames and removes
///                            none, leaves no core, and has 256 open at once
///   network                  none: no socket
///   processes                none besides itself: no fork, no exec, no look into others
///
/// The limits are the kernel's resource limits. The rest is a filter of its calls (seccomp): what is not allowed fails
/// with EPERM. Where the kernel takes no filter the limits hold all the same, and `talisman --version` says so.

#include <string>

namespace talisman::sequences {

/// Empty when all of it holds; else why the filter does not. Builds with sanitizers have neither a filter nor a limit of
/// memory: they need more than a reader does.
std::string confine(int seconds, long megabytes);

/// The word with which talisman_import says it, and does nothing else.
inline constexpr const char* kAskForConfinement = "--confinement";

/// Both cases in words: "no network, no new files, no new processes".
std::string confinement_in_words(const std::string& why_no_filter);

}  // namespace talisman::sequences
