// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman accuracy --renderer SEQUENCE`: what each knob and each effect of the renderer costs in time, and
/// what it buys in picture error. The files are those of experiments/renderer/report.h.

#include <iosfwd>
#include <string>

#include "sequences/commands/experiment_options.h"
#include "sequences/experiments/renderer/report.h"

namespace talisman::sequences {

/// Frames that are drawn from nothing, unless quality_every says otherwise: cost in proportion.
inline constexpr int kDefaultRendererSamples = 2;
/// Frames of the runs, unless the range is given: the first of the sequence.
inline constexpr int kDefaultRun_frames = 24;
inline constexpr int kRendererRounds = 3;

/// All measurements. `options` as for --regulator, its sequence is already read. The frames drawn from
/// nothing are spread over the range; the runs go through all of it where it is given, else through the first
/// kDefaultRun_frames frames. Throws InputError.
RendererReport measure_renderer_report(const Sequence& sequence, const ExperimentOptions& options);

/// Reads the sequence, measures, writes into the folder `dir` and prints. Throws InputError and OutputError.
int run_renderer_accuracy(const ExperimentOptions& options, const std::string& dir, std::ostream& out);

}  // namespace talisman::sequences
