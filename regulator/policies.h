// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The policies, one file each. Each answers for one layer that is in view and has been rendered before: draw
/// it again, or show the old sprite? What is common to all (layers out of view, first appearances) is decided
/// in plan.cpp; Hold and Interpolate, which have a beat, answer for every layer.

#include <string>

#include "regulator/plan.h"

namespace talisman::regulator {

/// `beat`: when all layers were drawn last (FrameBeat); the layer may have no sprite of that beat.
LayerDecision decide_hold(const FrameBeat& beat, const LayerAssessment& layer,
                          const RegulatorOptions& options);
LayerDecision decide_interpolate(const FrameBeat& beat, const LayerAssessment& layer,
                                 const RegulatorOptions& options);
LayerDecision decide_threshold(const LayerAssessment& layer, const RegulatorOptions& options);

/// Why the old sprite, carried by the fitted warp, is not good enough ("geometric 4.7 > 4 px"); empty if it
/// is. The one test of Threshold, Lookahead and Oracle, so that their renders can be compared.
std::string violation_of(const LayerAssessment& layer, const RegulatorOptions& options);

/// Wishes of the author [LS97 2.4]: is it time for a render, or too early for one?
bool due_by_minimum_rate(const LayerAssessment& layer);
bool barred_by_maximum_rate(const LayerAssessment& layer);

/// The fit is usable and rests on enough points to say something about the motion.
bool has_sound_fit(const LayerAssessment& layer);

/// May the old sprite be shown a little longer, mixed with the fresh one (RegulatorOptions::blend_frames)? Its place and
/// its light may be kMostFadedError times as far off as those of one that is reused; farther, two pictures would be seen
/// beside each other. What it never held cannot fade: the threshold of uncovered edges stands as it is, and a source that
/// shows its next picture cuts. Nothing fades under a threshold of 0 px.
bool may_fade_out(const LayerAssessment& old, const RegulatorOptions& options);
inline constexpr double kMostFadedError = 2;

/// Fewer matched points than this say too little about the motion to trust a small error.
inline constexpr int kFewestMatchedPoints = 3;

}  // namespace talisman::regulator
