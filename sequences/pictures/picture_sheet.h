// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Pictures side by side, with words above them: to look at what numbers say.

#include <string>
#include <vector>

#include "sequences/pictures/image_drawing.h"

namespace talisman::sequences {

/// Where `others` differ most from `truth`: of all rectangles of the given size (made smaller where the
/// picture is), the one with the largest sum of squared differences; the first of equal ones. Same sizes.
Crop most_different(const std::vector<const Image8*>& others, const Image8& truth, int width, int height);
/// The same sum over a crop.
double squared_difference(const std::vector<const Image8*>& others, const Image8& truth, const Crop& crop);

/// One column of a sheet: words, and pictures below each other, all as large as those of the other columns.
struct SheetColumn {
  std::vector<std::string> words;
  std::vector<Image8> pictures;
};

/// `title` over all, every pixel drawn as `scale` × `scale`.
Image8 sheet_of(const std::vector<std::string>& title, const std::vector<SheetColumn>& columns, int scale);

}  // namespace talisman::sequences
