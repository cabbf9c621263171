// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How much memory can this process still take before the system ends it?
///
///   free = min( MemAvailable + SwapFree               of /proc/meminfo
///             , memory.max − memory.current           of its control group and of every group above it (version 2)
///             , the limit of its address space − what it has of it )
///
/// What a file does not say limits nothing. All of it changes while it is read: an estimate, for a word of warning.

#include <cstdint>
#include <optional>
#include <string>

namespace talisman::sequences {

/// Bytes; empty where nothing says how much. `root`: where /proc and /sys lie.
std::optional<std::int64_t> free_memory_bytes(const std::string& root = "");

/// What the process holds now (VmRSS); 0 where the system does not say.
std::int64_t held_memory_bytes(const std::string& root = "");

}  // namespace talisman::sequences
