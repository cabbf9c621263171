// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman inspect --motion FILE`: what a trace of poses holds before a sequence uses it: how often and how evenly it
/// was sampled, how fast it moves and turns, its gaps and jumps with their lines (content/traces/trace.h). The whole file
/// is read, none of it is kept.

#include <optional>
#include <string>

#include "sequences/content/traces/trace.h"

namespace talisman::sequences {

/// Words of the command line; empty: as TraceOptions has them.
struct MotionQuestion {
  std::string format, joint;
  std::optional<double> fps, scale;
  bool any() const { return !format.empty() || !joint.empty() || fps || scale; }
};

/// Text, or JSON (schema talisman.motion_trace/1). Throws InputError.
std::string inspect_motion(const std::string& file, const MotionQuestion& question, bool json);

}  // namespace talisman::sequences
