// SPDX-License-Identifier: Apache-2.0
#include "regulator/settle.h"

#include "regulator/decision.h"
#include "regulator/resolution.h"

namespace talisman::regulator {

bool settles(const LayerAssessment& layer, const RegulatorOptions& options) {
  if (options.settle_frames < 1 || layer.frames_at_rest < options.settle_frames) return false;
  if (nothing_to_gain(layer)) return false;
  return layer.fiducials.sampling.magnification * layer.resolution > 1 + kUnseenEnlargement;
}

std::string settle_reason(const LayerAssessment& layer) {
  return "settled: at rest for " + std::to_string(layer.frames_at_rest) +
         (layer.frames_at_rest == 1 ? " frame, " : " frames, ") +
         comparison("magnification", layer.fiducials.sampling.magnification, ">", 1);
}

}  // namespace talisman::regulator
