// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Words and pictures in pictures.

#include <array>
#include <cstdint>
#include <string>

#include "layers/geometry2.h"
#include "sequences/files/image_io.h"

namespace talisman::sequences {

using Rgb = std::array<std::uint8_t, 3>;

/// A picture of one colour.
Image8 plain_image(int width, int height, Rgb color);

/// Dots of `scale` pixels (bitmap_font.h), upper left corner at `at`. What lies outside is left out.
void draw_text(Image8& image, const std::string& text, layers::ivec2 at, Rgb color, int scale);

/// Lays `picture` over `image`, its upper left corner at `at`. What lies outside is left out.
void paste(Image8& image, const Image8& picture, layers::ivec2 at);

/// The part of `image` around `center`, so that it fills `size_px` at `scale` pixels per pixel; moved inside
/// where it would reach over the border. `scale` ≥ 1.
Image8 magnified(const Image8& image, layers::ivec2 center, layers::ivec2 size_px, int scale);

/// A signed quantity as a colour: white at 0, to red at +1 and to blue at -1, clamped.
Rgb signed_color(double share);

}  // namespace talisman::sequences
