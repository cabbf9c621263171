// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace talisman::sequences {

/// "budget-ms-5" of "budget:ms=5": what a file of a setting may be called.
std::string file_name_of(const std::string& setting);

}  // namespace talisman::sequences
