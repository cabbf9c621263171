// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The counters of the visibility sort by the names that they have in all result files.

#include "layers/visibility.h"

namespace talisman::sequences {

struct VisibilityField {
  const char* name;
  int layers::VisibilityCounters::*field;
};
inline constexpr VisibilityField kVisibilityFields[] = {
    {"layers", &layers::VisibilityCounters::layers},
    {"queries", &layers::VisibilityCounters::queries},
    {"pairs", &layers::VisibilityCounters::pairs},
    {"exact_tests", &layers::VisibilityCounters::exact_tests},
    {"edges", &layers::VisibilityCounters::edges},
    {"swaps", &layers::VisibilityCounters::swaps},
    {"components", &layers::VisibilityCounters::components},
    {"merged_components", &layers::VisibilityCounters::merged_components},
    {"merged_layers", &layers::VisibilityCounters::merged_layers}};

}  // namespace talisman::sequences
