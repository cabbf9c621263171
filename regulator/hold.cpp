// SPDX-License-Identifier: Apache-2.0
#include "regulator/decision.h"
#include "regulator/policies.h"

namespace talisman::regulator {

/// All layers in lock step, every N-th frame; in between the sprite stays where it was. N = 3 is the triple
/// framing of [LS97 7.2], whose error is a saw-tooth [LS97 Fig. 23].
LayerDecision decide_hold(int frame, const LayerAssessment& layer, const RegulatorOptions& options) {
  const std::string policy = "policy: hold " + std::to_string(options.hold_frames);
  return frame % options.hold_frames == 0 ? rerender(layer, policy) : reuse_in_place(layer, policy);
}

}  // namespace talisman::regulator
