// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Pictures like [LS97] Figure 4 and 6: each shade sprite alone, its base alone, and their sum.
///
///   NNNN-floor.png                  the base over the background
///   NNNN-floor-shadow of spot.png   a shadow over white; what is added (highlight, reflection, texture) over
///                                   black
///   NNNN-floor-sum.png              base and shades, composited in their order over the background

#include <string>
#include <vector>

#include "sequences/pipeline/frame_report.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// Writes them for every base with shade layers that is shown in `report`, into `folder` (which exists). Their names.
std::vector<std::string> write_separate(const Pipeline& pipeline, const PipelineState& state,
                                        const FrameReport& report, const std::string& folder);

}  // namespace talisman::sequences
