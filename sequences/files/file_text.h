// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A whole file as text, or one line that says why not: streams throw the library's words where a folder stands, and wait
/// for ever at a pipe.

#include <optional>
#include <string>

#include "sequences/files/errors.h"

namespace talisman::sequences {

/// Empty where there is none of that name. Throws InputError where there is something else ("is no file"), or when it
/// cannot be read.
std::optional<std::string> text_of_file(const std::string& path);

/// Nothing, or a file: what may be written over. Throws InputError for all else.
void require_file_or_nothing(const std::string& path);
/// Nothing, or a folder. Throws InputError for all else.
void require_folder_or_nothing(const std::string& path);

}  // namespace talisman::sequences
