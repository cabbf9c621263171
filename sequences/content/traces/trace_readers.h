// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The formats of trace.h, one reader each: poses as body→world in the axes of the file, in the order of time, one after
/// the other into a sink, until there are none or the sink wants no more. Each throws InputError with file and line.

#include "sequences/content/traces/pose_sieve.h"

namespace talisman::sequences {

void read_tum(TraceText& text, const PoseSink& sink);
void read_euroc(TraceText& text, const PoseSink& sink);
/// Holds its images (kMostImages), since their lines are in no order.
void read_colmap(TraceText& text, double fps, const PoseSink& sink);
/// Characters go to a SAX parser: of the recording only the entry at hand is held.
void read_iwer(TraceText& text, const PoseSink& sink);
/// `fps`: instead of what the file says. Returns what is to be said of the file, or nothing.
std::string read_bvh(TraceText& text, const std::string& joint, std::optional<double> fps,
                     const PoseSink& sink);

/// The one of `options`. Returns what is to be said of the file, or nothing.
std::string read_poses(const TraceOptions& options, const PoseSink& sink);

}  // namespace talisman::sequences
