// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Pictures of one frame in rows and columns, each under its name.

#include <string>
#include <vector>

#include "sequences/files/image_io.h"

namespace talisman::sequences {

/// As many columns as rows, or one more, of pictures of one size; `titles` has as many entries (programmer error
/// otherwise). Places that are left over are dark.
Image8 side_by_side(const std::vector<const Image8*>& pictures, const std::vector<std::string>& titles);

}  // namespace talisman::sequences
