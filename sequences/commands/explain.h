// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `talisman explain SEQUENCE|MODEL|DIR --frame N [--layer NAME]`: why was it drawn in this frame?

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "sequences/commands/options.h"

namespace talisman::sequences {

struct ExplainOptions {
  CommandLine line;  ///< of the run; its `sequence` may be the folder of one
  std::optional<int> frame;
  std::string layer;                ///< empty: all, a line each
  std::vector<std::string> others;  ///< names of the options given besides --frame and --layer
};

/// Throws InputError. Of a folder only what stands in it is said; of a sequence the layer's pictures and the threshold
/// at which it would have been decided otherwise come with it.
int run_explain(const ExplainOptions& options, std::ostream& out);

}  // namespace talisman::sequences
