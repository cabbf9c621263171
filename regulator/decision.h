// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What is decided about a layer, put into words and numbers: the decisions that every policy makes.

#include <string>

#include "regulator/plan.h"

namespace talisman::regulator {

/// Nothing of the layer is in view.
LayerDecision drop(const LayerAssessment& layer);
/// A fresh sprite; shown without a warp and without error.
LayerDecision rerender(const LayerAssessment& layer, std::string reason);
/// The policies `direct` and `reference`: a fresh sprite, whatever there is.
LayerDecision decide_every_frame(const LayerAssessment& layer, std::string reason);
/// Hold and Interpolate: all that is in view is drawn on the beat, and what was not there then waits for the
/// next one.
LayerDecision draw_on_beat(const LayerAssessment& layer, const std::string& policy);
LayerDecision wait_for_beat(const LayerAssessment& layer, const std::string& policy);
/// The old sprite, carried by the fitted warp.
LayerDecision reuse(const LayerAssessment& layer, std::string reason);
/// The old sprite, left where it was.
LayerDecision reuse_in_place(const LayerAssessment& layer, std::string reason);

/// The old sprite where a render is not worth it or not affordable: warped if its warp is sound.
LayerDecision keep_old(const LayerAssessment& layer, std::string reason);
/// "; resolution 0.81", or nothing at full resolution.
std::string at_resolution(double resolution);

/// "geometric 4.7 > 4 px" (relation is one of ">" "<=" "<" ">=").
std::string comparison(const char* what, double value, const char* relation, double limit,
                       const char* unit = "");

}  // namespace talisman::regulator
