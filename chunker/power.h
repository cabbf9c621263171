// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The logarithm and the power of layers/power.h: the decision side shades its characteristic points with the
/// same lobe as the pixels.

#include "layers/power.h"

namespace talisman::chunker {

using layers::coarse_log2;
using layers::power_of_unit;
using layers::precise_exp2;
using layers::precise_log2;

}  // namespace talisman::chunker
