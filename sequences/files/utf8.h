// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Is a text UTF-8, and what does it say if it is not? YAML readers put a question mark where it is not, and go on with a
/// name that nobody wrote; JSON writers refuse all of it.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace talisman::sequences {

/// Where the first byte stands that is no part of a well-formed sequence (The Unicode Standard, table 3-7:
/// no overlong forms, no surrogates, nothing above U+10FFFF), or that is 0, as in UTF-16; empty: none.
std::optional<std::size_t> first_not_utf8(std::string_view text);

/// The text itself where it is UTF-8. Else each byte that is not is taken for the character of its number, as in
/// Latin-1, which is what old models and old file systems have; a 0 for U+2400. For names that go into results.
std::string utf8_from(std::string_view text);

}  // namespace talisman::sequences
