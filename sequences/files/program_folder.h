// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace talisman::sequences {

/// Folder of the running program, without a slash at its end.
std::string program_folder();

}  // namespace talisman::sequences
