// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "sequences/files/errors.h"

namespace talisman::sequences {

/// Creates the folder and those above it where they are not there. Throws OutputError.
void create_folder(const std::string& path);

}  // namespace talisman::sequences
