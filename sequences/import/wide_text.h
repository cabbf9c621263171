// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Is a file text in UTF-16, and what does it say in UTF-8? Irrlicht writes its scenes so, and editors other formats.
///
/// It is where it begins with a byte order mark and holds whole characters, none of them 0: a binary file that happens to
/// begin so is left alone. Source: RFC 2781.

#include <istream>
#include <memory>
#include <optional>
#include <string>

namespace talisman::sequences {

/// The text without its mark; nothing when it is none. Cost: O(bytes) where the mark is there.
std::optional<std::string> utf8_of_utf16(const std::string& bytes);

/// Likewise of a file, of which all others cost two bytes read.
std::optional<std::string> utf8_of_wide_file(const std::string& path);

/// A file as a stream of UTF-8, if it is text.
std::unique_ptr<std::istream> open_text(const std::string& path);

}  // namespace talisman::sequences
