// SPDX-License-Identifier: Apache-2.0
#include "chunker/multipass.h"

namespace talisman::chunker {

LinearColor predicted_factoring_error(const LinearColor& base, float shadow_alpha, layers::vec3 behind) {
  const float open = (1 - base.a) * shadow_alpha;  // β (1 - β) (1 - s) / β
  return {open * (base.r / base.a - behind.x), 0, 0, 0};
}

}  // namespace talisman::chunker
