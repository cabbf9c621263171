// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman inspect`: what is in a sequence before anything is drawn: layers, polygons, memory, and the
/// effects that it calls for, with reasons; or its visibility order over time (inspect_order.h);
/// or what a trace of poses holds (inspect_motion.h).

#include <iosfwd>
#include <optional>
#include <string>

#include "sequences/commands/inspect/inspect_motion.h"
#include "sequences/commands/options.h"
#include "sequences/content/sequence.h"

namespace talisman::sequences {

struct InspectOptions {
  std::string sequence;            ///< name or path; may be empty where `profile` is asked for
  std::string cycles, compositor;  ///< of `order`; empty: the sequence's own
  std::string out;                 ///< picture of `parts`, plan of `cells`
  bool json = false, profile = false, order = false, parts = false, factoring = false;
  bool cells = false;
  std::optional<int> frame;       ///< of `cells`
  std::optional<int> max_layers;  ///< of `factoring`
  bool motion = false;            ///< `sequence` is the file of a trace
  MotionQuestion trace;           ///< of `motion`
  ContentWords content;
};

/// Throws InputError.
int run_inspect(const InspectOptions& options, std::ostream& out);

std::string inspection_text(const Sequence& sequence);
std::string inspection_json(const Sequence& sequence);  ///< schema talisman.inspect/1
/// Every number of the hardware profile, with source and whether it is confirmed or assumed.
std::string profile_text();

}  // namespace talisman::sequences
