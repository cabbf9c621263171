// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which options were given that the chosen policy does not read? A value that would change nothing is a slip, or a
/// misunderstanding of the policy: --budget-polygons without --policy budget.

#include <string>
#include <vector>

#include "regulator/plan.h"
#include "sequences/commands/options.h"

namespace talisman::sequences {

/// "--budget-polygons is no option of policy threshold; policy budget has it": of the first group of options that
/// the same policies read; empty if all that was given is read. Keys of a sequence are not looked at: they are
/// there for every policy that may be asked for. `is_late`: old poses are expected on, whatever the policy.
std::string of_another_policy(const CommandLine& line, regulator::Policy policy, bool is_late);

/// All of them: "--budget-polygons", …
std::vector<std::string> options_of_other_policies(const CommandLine& line, regulator::Policy policy);

}  // namespace talisman::sequences
