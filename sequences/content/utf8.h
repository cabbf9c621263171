// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Is a text UTF-8? YAML readers put a question mark where it is not, and go on with a name that nobody wrote.

#include <cstddef>
#include <optional>
#include <string_view>

namespace talisman::sequences {

/// Where the first byte stands that is no part of a well-formed sequence (The Unicode Standard, table 3-7:
/// no overlong forms, no surrogates, nothing above U+10FFFF), or that is 0, as in UTF-16; empty: none.
std::optional<std::size_t> first_not_utf8(std::string_view text);

}  // namespace talisman::sequences
