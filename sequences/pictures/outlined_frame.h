// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A frame with the outlines of the sprites that it shows (overlay.h).

#include "sequences/files/image_io.h"
#include "sequences/pipeline/frame_report.h"

namespace talisman::sequences {

/// Of a frame that was drawn.
Image8 with_outlines(const FrameReport& report);

}  // namespace talisman::sequences
