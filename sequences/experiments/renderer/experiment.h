// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What does each knob of the renderer cost, and what does it buy? What does each effect?
///
/// Knobs: every rung of knobs.h on a few sampled frames, each drawn from nothing, against the one
/// stated truth. What all sprites lose, whatever the knob (over-only compositing of shade layers), would hide
/// what one knob loses; so the error of the knob *alone* is against the same picture with this knob, too, as
/// the truth has it: for knobs of the one pass that is the truth. Per rung, from the errors of the knob
/// alone, relative to the next coarser one of its knob:
///
///   gain in dB per ms    (PSNR - PSNR of the coarser) / (ms - ms of the coarser)
///   gain in FLIP per ms  (FLIP of the coarser - FLIP) / (ms - ms of the coarser)
///
/// ms: processor time of a frame, all threads together, which depends neither on the number of cores nor much
/// on what else the machine does. There is no price where the difference of the two times is within their
/// spreads, and no gain in dB where one of the two is the truth.
///
/// Effects: each one that is called for, taken away alone (effect_removal.h). Those that change the picture
/// of a single frame are judged on the sampled frames, under policy reference: the picture without against
/// the picture with the effect is what it buys. Those that pay off only over time are judged in runs through
/// consecutive frames under the sequence's own policy, with and without, each against its own `direct`.
///
/// Times are measured on this machine and differ from run to run; all other numbers are the same in every
/// run.

#include <vector>

#include "sequences/experiments/renderer/measured.h"
#include "sequences/files/progress.h"

namespace talisman::sequences {

/// From the coarser to the finer of two rungs.
Gain gain_of(const Measured& coarser, const PictureError& coarser_error, const Measured& finer,
             const PictureError& finer_error);

/// Work of a kind that a variant did for a frame.
double work_of(WorkKind kind, const Variant& variant, const Measured& measured);

KnobResults measure_knobs(const Variant& given, const std::vector<int>& frames, int rounds,
                          ProgressKind progress);

/// Does the effect pay off only over several frames?
bool pays_over_time(layers::Effect effect);

EffectResults measure_effects(const Variant& given, const std::vector<int>& frames,
                              const std::vector<int>& run, int rounds, ProgressKind progress);

}  // namespace talisman::sequences
