// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The hidden names under which files are written before they get their own, and what becomes of them when
/// their writer is killed.
///
///   .tmp-PID-START-N-NAME    beside NAME; PID and START (clock ticks since the machine started) say which
///                            process writes it, N which of its files
///
/// A process that was killed cannot tidy up; whoever works in the same folder next does it for it.

#include <string>

namespace talisman::sequences {

/// A name in the folder of `path` that no other process or thread has. The extension stays last.
std::string temporary_name(const std::string& path);

/// Removes the temporary files in `folder` whose process is gone. Files of processes that still live, and any
/// that are not named as above, stay; so does what cannot be removed. Without such a folder nothing happens.
void remove_abandoned_files(const std::string& folder);

}  // namespace talisman::sequences
