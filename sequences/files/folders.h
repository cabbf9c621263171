// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "sequences/files/errors.h"

namespace talisman::sequences {

/// Creates the folder and those above it where they are not there. Throws OutputError.
void create_folder(const std::string& path);

/// The same for a folder to which results are to be written: what a killed writer left there is removed
/// (files/temporary_files.h).
void prepare_folder(const std::string& path);

}  // namespace talisman::sequences
