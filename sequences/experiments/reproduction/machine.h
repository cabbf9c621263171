// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Is what is drawn on demand within the published machine? Derived, not said: [LS97] has two rates (footnote 1), others
/// have the display (regulator/profile.h).
///
///   depth           320e6 / (1344 · 1024 · 75)       sprites over each pixel that the compositor can read
///   screen          40e6 / 75 / (1344 · 1024)        share of one screen that the renderer fills in a frame
///   missed frames   max(polygons / 1.5e6, texels / 40e6) > 1 / 75 s
///
/// Texels are those of the sprites' rectangles, each filled once: hidden surfaces come on top, empty chunks go off.

#include <string>
#include <vector>

#include "sequences/experiments/reproduction/paper.h"

namespace talisman::sequences {

struct MachineUse {
  std::string name;
  std::vector<double> depth;         ///< by frame: sprites over a pixel
  std::vector<double> drawing_ms;    ///< by frame, drawn on demand
  std::vector<double> reference_ms;  ///< by frame, all layers
};

struct MachineLimits {
  double depth = 0, screen = 0, frame_ms = 0;
};
MachineLimits machine_limits();

Finding limit_of_depth(const MachineLimits& limits);   ///< 3.1
Finding limit_of_screen(const MachineLimits& limits);  ///< 39 %
/// No frame of any sequence is deeper in the mean over the display.
Finding depth_is_kept(const std::vector<MachineUse>& uses, const MachineLimits& limits);
/// On demand every sequence misses fewer frames than with all layers in each; or neither misses one.
Finding fewer_frames_miss(const std::vector<MachineUse>& uses, const MachineLimits& limits);

Item published_machine();

}  // namespace talisman::sequences
