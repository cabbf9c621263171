// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What the live view shows, and how its settings are understood. The words of the command line are in a room above
/// this one, so it is given what it needs of them.

#include <functional>
#include <string>
#include <vector>

#include "sequences/experiments/variant.h"

namespace talisman::sequences {

/// A setting that the page offers.
struct ViewControl {
  std::string option;              ///< "geometric-px"
  std::string group;               ///< "Thresholds"
  std::string meaning;             ///< as the help says it
  std::vector<std::string> words;  ///< of a choice; empty: a number or a text
};

struct ViewSource {
  std::string name;                ///< as it was asked for
  std::string fault;               ///< why the scene cannot be read; empty: it can
  std::string out;                 ///< the only folder in which anything is written
  std::string base;                ///< the sequence file that a recorded flight extends; empty: a bare model
  std::vector<std::string> given;  ///< options of the command line, "--geometric-px=2"
  std::vector<ViewControl> controls{};  ///< in the order of the help
  std::function<Variant(const std::vector<std::string>& words)>
      resolve;  ///< throws InputError, as the tool would say it
};

}  // namespace talisman::sequences
