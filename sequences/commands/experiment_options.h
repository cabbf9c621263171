// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Words and folders that the commands of the experiments have in common.

#include <string>

#include "layers/polyhedron.h"
#include "sequences/files/folders.h"
#include "sequences/files/progress.h"

namespace talisman::sequences {

/// Of "auto", "bar", "plain", "none" (option --progress). Throws InputError.
ProgressKind progress_kind_from(const std::string& name);

/// Of "box8", "dop14", "dop26" (option --bound). Throws InputError.
layers::BoundKind bound_kind_from(const std::string& name);

}  // namespace talisman::sequences
