// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which options were given that the chosen policy does not read? A value that changes nothing is nearly always a
/// slip: --budget-polygons without --policy budget.

#include <string>
#include <vector>

#include "regulator/plan.h"
#include "sequences/commands/options.h"

namespace talisman::sequences {

/// "--budget-polygons has no effect with policy threshold; policy budget reads it", a line per group of options
/// that the same policies read. Keys of a sequence are not looked at: they are there for every policy that may be
/// asked for.
std::vector<std::string> without_effect(const CommandLine& line, regulator::Policy policy);

}  // namespace talisman::sequences
