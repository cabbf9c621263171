// SPDX-License-Identifier: Apache-2.0
#include "regulator/decision.h"
#include "regulator/policies.h"

namespace talisman::regulator {

namespace {

/// Staggered, layer k is drawn in the frames f with (f + k) mod N = 0, and when it appears: as many renders, but each
/// frame has its share of them, and no two neighbours in the list step at once.
LayerDecision decide_staggered(int frame, const LayerAssessment& layer, const RegulatorOptions& options,
                               const std::string& policy) {
  if (!layer.in_view) return drop(layer);
  if (!layer.has_sprite) return rerender(layer, "first_appearance");
  if ((frame + layer.layer) % options.hold_frames == 0) return draw_on_beat(layer, policy);
  if (has_sound_fit(layer)) return reuse(layer, policy);
  return rerender(layer, policy + ", no warp");
}

}  // namespace

/// The same renders as `hold`, but between them each sprite is carried by its warp: "interpolated
/// triple-framing" of [LS97 7.2]. Costs the same, looks far better. A sprite whose motion cannot be fitted at
/// all is left in place; what has left the view is not shown.
LayerDecision decide_interpolate(const FrameBeat& beat, const LayerAssessment& layer,
                                 const RegulatorOptions& options) {
  const std::string policy = "policy: interpolate " + std::to_string(options.hold_frames);
  if (options.stagger) return decide_staggered(beat.frame, layer, options, policy + ", staggered");
  if (beat.is_now()) return draw_on_beat(layer, policy);
  if (!layer.in_view) return drop(layer);
  if (!beat.drew(layer)) return wait_for_beat(layer, policy);
  return has_sound_fit(layer) ? reuse(layer, policy) : reuse_in_place(layer, policy + ", no warp");
}

}  // namespace talisman::regulator
