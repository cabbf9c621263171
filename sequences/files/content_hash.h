// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What is in a file, in 40 letters: SHA-1, hexadecimal, lower case. It tells contents apart and is no protection
/// against somebody who wants two of them to be taken for one.

#include <string>
#include <string_view>

namespace talisman::sequences {

/// `text` may be any bytes.
std::string hash_of_text(std::string_view text);

/// Throws InputError if the file cannot be read. Cost: about 2 ms per megabyte; the file is not held in memory.
std::string hash_of_file(const std::string& path);

}  // namespace talisman::sequences
