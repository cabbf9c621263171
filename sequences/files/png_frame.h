// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A frame that a run wrote as PNG, read back by libspng: no other library is loaded for it (png_encoding.h).

#include <string>

#include "sequences/files/image_io.h"

namespace talisman::sequences {

/// Three bytes of sRGB per pixel, whatever the file has; alpha is left out. Throws InputError with the file and what is
/// wrong: it cannot be read, is no PNG, is cut off, or has more than 16,384 pixels on a side. Cost: about 10 ns per pixel.
Image8 read_png_frame(const std::string& path);

}  // namespace talisman::sequences
