// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Ctrl-C: a command that heeds it finishes what is at work and says what is there; all others it ends.

#include <atomic>

namespace talisman::sequences {

inline std::atomic<bool> heeds_stop = false;
static_assert(std::atomic<bool>::is_always_lock_free, "read in a signal handler");

}  // namespace talisman::sequences
