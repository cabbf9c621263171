// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The live view on 127.0.0.1, by HTTP. What comes in is judged by a Gate before its body is read; a connection carries one
/// request and is bounded (connection.h); it ends when `stop` becomes true. No path names a file: there are the
/// page and the answers of LiveView, and nothing else.

#include <atomic>
#include <iosfwd>

#include "sequences/view/view_source.h"

namespace talisman::sequences {

/// Prints the address, then serves. `port` 0: any that is free. Throws OutputError where the port cannot be had.
void serve_view(ViewSource source, int port, const std::atomic<bool>& stop, std::ostream& out);

}  // namespace talisman::sequences
