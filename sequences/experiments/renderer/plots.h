// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The plots of report.h: one series per knob, its rungs labelled. What has no error has no place on
/// a logarithmic axis and is left out.

#include <string>

#include "sequences/experiments/renderer/measured.h"
#include "sequences/pictures/plot.h"

namespace talisman::sequences {

/// FLIP of each knob alone against measured time, of the knobs in one pass or of those in sprites.
Plot knob_time_plot(const RendererReport& report, bool in_sprites);
/// FLIP against the work that a knob is paid in, in % of its last rung: no clock.
Plot knob_work_plot(const RendererReport& report, bool in_sprites);
/// Cost in ms against FLIP of the picture without.
Plot effect_plot(const RendererReport& report);
/// Time per frame against FLIP against direct, as it is and without each effect.
Plot run_plot(const RendererReport& report);

/// All of them, as SVG and CSV. Throws OutputError.
void write_renderer_plots(const RendererReport& report, const std::string& dir);

}  // namespace talisman::sequences
