// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman view SEQUENCE|MODEL`: plans and pictures in the browser, live.

#include <atomic>
#include <iosfwd>
#include <string>
#include <vector>

#include "sequences/commands/option_group.h"
#include "sequences/commands/options.h"
#include "sequences/view/view_source.h"

namespace talisman::sequences {

struct ViewOptions {
  CommandLine line;
  std::vector<std::string> given;     ///< those of its options that the page may set, "--geometric-px=2"
  std::vector<ViewControl> controls;  ///< all options that the page may set
  int port = 0;                       ///< 0: any that is free
};

/// Those options of the command that the page may set, as its help has them; and those of them that were given.
std::vector<ViewControl> view_controls(const CLI::App& command);
std::vector<std::string> given_settings(const CLI::App& command);

/// What is served. A scene that cannot be read is its `fault`, said on stderr. Throws InputError for what the command line
/// says of settings.
ViewSource view_source(const ViewOptions& options);

/// Serves until `stop` becomes true. A scene that cannot be read is shown as a page that says why; then the
/// exit code is that of bad input. Throws OutputError.
int run_view(const ViewOptions& options, const std::atomic<bool>& stop, std::ostream& out);

}  // namespace talisman::sequences
