// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The keys of `trace` in a sequence file (trace.h).

#include "sequences/content/key_table.h"
#include "sequences/content/traces/trace.h"

namespace talisman::sequences {

const Table<TraceOptions>& trace_keys();

}  // namespace talisman::sequences
