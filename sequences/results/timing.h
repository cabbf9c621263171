// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What was measured with a clock, and where: timing.jsonl. Nothing else in a result folder depends on the machine,
/// the number of threads or the day.
///
///   talisman.process/1        one line per process that worked on the run, before its frames: version, start,
///                             machine, threads. A resumed run has several.
///   talisman.timing/1         one line per frame: wall time of its stages
///   talisman.timing_total/1   the last line of a complete run: their sums
///
/// Each measurement is of the process that drew the frame; planning a frame again to resume is not counted twice.

#include <optional>
#include <string>

#include "sequences/results/summary.h"

namespace talisman::sequences {

std::string timing_json(const FrameLine& line);
struct FrameTiming {
  int frame = 0;
  FrameTimes times;
};
/// Empty if the text is not a whole line talisman.timing/1.
std::optional<FrameTiming> timing_from_json(const std::string& text);

/// The line of this process, as of now.
std::string process_json();
/// Is the text a line talisman.process/1?
bool is_process_line(const std::string& text);

std::string total_timing_json(const Summary& summary);

}  // namespace talisman::sequences
