// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Frames as PNG files, by libspng: the one format that every run writes, and a library of 90 kB that is there with the
/// program. All other pictures go through OpenImageIO (picture_codec.h), which takes longer to load than a small
/// sequence to draw.

#include "sequences/files/picture_codec.h"

namespace talisman::sequences {

/// An 8-bit sRGB picture, three bytes per pixel, row by row; it is marked as sRGB. The same picture always gives the
/// same bytes. Any number of threads may call it. Cost: about 6 ns per pixel.
EncodedPicture encoded_as_png(int width, int height, const std::uint8_t* rgb);

}  // namespace talisman::sequences
