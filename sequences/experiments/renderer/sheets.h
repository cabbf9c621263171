// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The contact sheets of report.h: of all places and sampled frames the one where the rungs of a
/// knob differ most from its base (the picture with this knob, too, as the truth has it), at each rung, the
/// truth last; below, the difference from the base, brightened by a power of two that is written above.

#include <string>

#include "sequences/experiments/renderer/measured.h"
#include "sequences/pictures/picture_sheet.h"

namespace talisman::sequences {

/// The knob is measured (programmer error otherwise).
Image8 knob_sheet(const KnobResults& results, std::size_t knob);

/// With and without each effect of a frame, each where it changes most.
Image8 effect_sheet(const EffectResults& effects);

/// "knob-NAME.png".
std::string knob_sheet_file(const Knob& knob);

/// knob-NAME.png for every knob that is measured, and effects.png. Throws OutputError.
void write_renderer_sheets(const RendererReport& report, const std::string& dir);

}  // namespace talisman::sequences
