// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman accuracy --latency SEQUENCE [--warp-ms W]`: error over latency and predictor, and what a last warp saves
/// (experiments/latency/latency_curve.h); and what is shown by layers and by whole frames that are reprojected
/// (experiments/latency/displayed.h).

#include <iosfwd>
#include <string>

#include "sequences/commands/experiment_options.h"

namespace talisman::sequences {

/// Throws InputError and OutputError.
int run_latency_accuracy(const ExperimentOptions& options, const std::string& dir, std::ostream& out);

}  // namespace talisman::sequences
