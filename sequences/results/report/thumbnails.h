// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Small pictures of a run's frames, as many as a budget of bytes allows, evenly spaced.

#include <string>
#include <vector>

#include "sequences/files/image_io.h"
#include "sequences/results/report/report_run.h"

namespace talisman::sequences {

/// At most `kThumbnailBytes` of PNG in all, each at most `kThumbnailWidth_px` wide. Pictures that cannot be read are
/// left out.
std::vector<Thumbnail> thumbnails_of(const std::string& folder);

inline constexpr std::size_t kThumbnailBytes = 2'400'000;
inline constexpr int kThumbnailWidth_px = 320;

/// The mean of the pixels under each of the small ones. `width`: at most that of the picture.
Image8 shrunk(const Image8& image, int width);

}  // namespace talisman::sequences
