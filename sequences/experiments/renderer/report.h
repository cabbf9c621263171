// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The results of `talisman accuracy --renderer`, as tables, CSV, JSON and pictures.
///
/// - renderer.csv: one line per rung of every knob: error against the truth, counters, times, gain
/// - renderer-effects.csv: one line per effect taken away: what it buys, what it costs, with and without
/// - renderer.json: talisman.renderer/1, both, and what was not called for, with the reasons
/// - renderer-pixels.svg, renderer-sprites.svg: FLIP against processor time, one series per knob
/// - renderer-pixels-work.svg, renderer-sprites-work.svg: FLIP against the count that a knob is paid in
/// - renderer-effects.svg: what each effect of a frame costs and buys; renderer-over-time.svg: runs
/// - knob-NAME.png: the same place of the picture at each rung, where the rungs differ most
/// - effects.png: with and without each effect, where it changes most
/// - renderer.html: all of it as a page
///
/// Beside each SVG lies a CSV with the points that it shows. Columns named `wall_…` are measured times or
/// follow from them; all else is the same in every run.

#include <string>

#include "sequences/experiments/renderer/measured.h"
#include "sequences/pictures/page.h"

namespace talisman::sequences {

std::string knobs_csv(const RendererReport& report);
std::string effects_csv(const RendererReport& report);
std::string json_of(const RendererReport& report);

/// Writes all files into the folder, which is there. Throws OutputError.
void write_report(const RendererReport& report, const std::string& dir);

Page page_of(const RendererReport& report);

}  // namespace talisman::sequences
