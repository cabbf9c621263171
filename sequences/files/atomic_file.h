// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Whole files or none. A file is written to a temporary name in the same folder, flushed, checked and renamed,
/// so that a final name never holds half a file, and the old file stays until the new one is whole.

#include <functional>
#include <string>

#include "sequences/files/errors.h"

namespace talisman::sequences {

/// Writes `content(path)` to a temporary file, then renames it. Throws OutputError (and removes the
/// temporary) when anything fails.
void write_atomically(const std::string& path,
                      const std::function<void(const std::string& temporary)>& content);
/// `text` may be any bytes.
void write_text_atomically(const std::string& path, const std::string& text);

}  // namespace talisman::sequences
