// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A font of 5×7 dots for labels in pictures: digits, capital letters (small ones are shown as capitals) and
/// some signs. Everything else, UTF-8 sequences included, is a hollow box per byte sequence.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace talisman::sequences {

inline constexpr int kGlyphWidth = 5, kGlyphHeight = 7;
inline constexpr int kGlyphAdvance = kGlyphWidth + 1;

/// Seven rows from the top; bit 4 is the leftmost dot.
using Glyph = std::array<std::uint8_t, kGlyphHeight>;

std::vector<Glyph> glyphs_of(const std::string& text);

}  // namespace talisman::sequences
