// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/audit.h"

#include "sequences/commands/render.h"

namespace talisman::sequences {

int run_audit(CommandLine line, const std::atomic<bool>& stop, std::ostream& out) {
  constexpr int kUsually = 8;
  line.audit = line.audit.value_or(kUsually);
  line.audit_alone = true;
  line.format = "none";
  return run_sequence(line, false, stop, out);
}

}  // namespace talisman::sequences
