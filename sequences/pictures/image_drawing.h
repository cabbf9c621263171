// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Words, lines and pictures in pictures, drawn by OpenCV on one thread. What lies outside is left out.

#include <array>
#include <cstdint>
#include <string>

#include "layers/geometry2.h"
#include "sequences/files/image_io.h"

namespace talisman::sequences {

using Rgb = std::array<std::uint8_t, 3>;

/// A rectangle of a picture; pixels.
struct Crop {
  int x = 0, y = 0, width = 0, height = 0;
};

/// A picture of one colour.
Image8 plain_image(int width, int height, Rgb color);

/// Letters in two sizes: of `scale` 1 they are 8 pixels high, of 2 they are 13.
/// The box that a line of text takes, with the room below the baseline.
layers::ivec2 text_size(const std::string& text, int scale);

/// A line of text, the upper left corner of its box at `at`. Signs beyond ASCII are question marks,
/// but for the middle dot.
void draw_text(Image8& image, const std::string& text, layers::ivec2 at, Rgb color, int scale);

/// An antialiased line between two places in the picture, in pixels (the centre of the first pixel is at 0.5,
/// 0.5), at most 32000 pixels from the picture. It covers 3.4 pixels across, of which two wholly.
void draw_line(Image8& image, layers::dvec2 from, layers::dvec2 to, Rgb color);

/// Mixes `color` into a rectangle; `share` of it, 0 … 1.
void tint(Image8& image, const Crop& where, Rgb color, double share);

/// Lays `picture` over `image`, its upper left corner at `at`.
void paste(Image8& image, const Image8& picture, layers::ivec2 at);

/// The part of `image` in `crop`, which lies inside it.
Image8 cropped(const Image8& image, const Crop& crop);

/// Every pixel as `scale` × `scale`. `scale` ≥ 1.
Image8 enlarged(const Image8& image, int scale);

/// The part of `image` around `center`, so that it fills `size_px` at `scale` pixels per pixel; moved inside
/// where it would reach over the border. `scale` ≥ 1.
Image8 magnified(const Image8& image, layers::ivec2 center, layers::ivec2 size_px, int scale);

/// |a - b| · gain per channel, clamped. Same sizes.
Image8 difference(const Image8& a, const Image8& b, int gain);

/// Largest channel difference. Same sizes.
int largest_difference(const Image8& a, const Image8& b);

/// A signed quantity as a colour: white at 0, to red at +1 and to blue at -1, clamped.
Rgb signed_color(double share);

}  // namespace talisman::sequences
