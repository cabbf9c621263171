// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A run on a time axis, for viewers that people have (ui.perfetto.dev, chrome://tracing, speedscope): `trace.json` in
/// the Trace Event Format of Chrome.
///
/// Time is the sequence's: frame f begins at f / fps, rounded to whole microseconds. Process 1 is the run:
///
///   track `frames`       a slice per frame
///   a track per layer    in the order of `layers` in summary.json, the author's; a slice is a sprite's life: from the
///                        frame that drew it up to the one that draws the next, or no longer shows it. Its name is why
///                        it was drawn; its args are that decision's reason, fiducials and cost, how many frames it
///                        lasted, its largest geometric_px, and why it ended. So slices of a track never overlap.
///   counters             of frames.jsonl
///   flows                from the frame that a sprite depicts to its life; back to it where that frame comes later
///
/// Process 2, where it is asked for, is what was measured: a track of its own clock, on which the stages of the frames
/// follow each other, writing (beside the drawing of the next) on another. Without it the trace has the same bytes on
/// every machine.

#include <string>

namespace talisman::sequences {

/// Writes the file beside the results that it is made from; returns its name. Throws InputError where `folder` holds no
/// complete run, OutputError where the file cannot be written.
std::string export_trace(const std::string& folder, bool with_timing);

}  // namespace talisman::sequences
