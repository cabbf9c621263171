// SPDX-License-Identifier: Apache-2.0
#include "regulator/decision.h"
#include "regulator/policies.h"

namespace talisman::regulator {

/// All layers in lock step, every N-th frame; in between the picture is that of the beat, also of what has left
/// the view since, and without what has come into view. N = 3 is the triple framing of [LS97 7.2], whose error
/// is a saw-tooth [LS97 Fig. 23].
LayerDecision decide_hold(const FrameBeat& beat, const LayerAssessment& layer,
                          const RegulatorOptions& options) {
  const std::string policy = "policy: hold " + std::to_string(options.hold_frames);
  if (beat.is_now()) return draw_on_beat(layer, policy);
  return beat.drew(layer) ? reuse_in_place(layer, policy) : wait_for_beat(layer, policy);
}

}  // namespace talisman::regulator
