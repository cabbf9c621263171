// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What names of strangers' files must not do to a terminal: move its cursor, set its title, turn the direction of what
/// follows, or end the line of a table.

#include <string>
#include <string_view>

namespace talisman::sequences {

/// The text with each control character (below 0x20, 0x7f, U+0080 to U+009F), line separator and mark of direction
/// (U+2028 to U+202E, U+2066 to U+2069, U+200E, U+200F) written as "\x1b" or "\u202e". Bytes that are no UTF-8 are left to the terminal.
/// `keeps_lines`: the ends of lines stay.
std::string harmless(std::string_view text, bool keeps_lines = false);

}  // namespace talisman::sequences
