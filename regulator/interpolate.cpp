// SPDX-License-Identifier: Apache-2.0
#include "regulator/decision.h"
#include "regulator/policies.h"

namespace talisman::regulator {

/// The same renders as `hold`, but between them the sprite is carried by the warp: "interpolated
/// triple-framing" of [LS97 7.2]. Costs the same, looks far better. A sprite whose motion cannot be fitted at
/// all is left in place.
LayerDecision decide_interpolate(int frame, const LayerAssessment& layer, const RegulatorOptions& options) {
  const std::string policy = "policy: interpolate " + std::to_string(options.hold_frames);
  if (frame % options.hold_frames == 0) return rerender(layer, policy);
  if (!layer.fitted.usable() || layer.matched_points < kFewestMatchedPoints)
    return reuse_in_place(layer, policy + ", no warp");
  return reuse(layer, policy);
}

}  // namespace talisman::regulator
