// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/init.h"

#include <ostream>

#include "sequences/content/starter/starter.h"

namespace talisman::sequences {

int run_init(const InitOptions& options, std::ostream& out) {
  const Starter starter = starter_sequence(options.model, content_options(options.content));
  say_content(starter.warnings, starter.notes);
  require_none(starter.warnings, options.content.strict, options.model);
  out << starter.yaml;
  return kSuccess;
}

}  // namespace talisman::sequences
