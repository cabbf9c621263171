// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which code is at work here? What it makes may be kept only for as long as it is the same.

#include <string>
#include <vector>

#include "sequences/files/content_hash.h"

namespace talisman::sequences {

/// The program, first, and every shared library that it has loaded.
std::vector<std::string> loaded_code();

/// Size and time of change of a file: enough to tell one installed library from another, without reading 200 MB
/// of them. Of a file that is not there the hash of nothing.
ContentHash stamp_of(const std::string& path);

/// The content of the program and the stamps of its libraries, as they were when this was first asked.
const ContentHash& hash_of_loaded_code();

}  // namespace talisman::sequences
