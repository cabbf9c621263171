// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A picture as OpenCV sees it: the same pixels, not a copy of them. Channels are red, green, blue.

#include <opencv2/core.hpp>

#include "sequences/files/image_io.h"

namespace talisman::sequences {

inline cv::Mat view_of(Image8& image) { return {image.height, image.width, CV_8UC3, image.rgb.data()}; }
/// To be read only: a cv::Mat knows no pixels that are constant.
inline cv::Mat view_of(const Image8& image) { return view_of(const_cast<Image8&>(image)); }

}  // namespace talisman::sequences
