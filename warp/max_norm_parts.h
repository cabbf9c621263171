// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What the maximum-norm fits of all families share: refusing, giving up, and measuring. Internal to warp/.

#include <optional>
#include <span>

#include "warp/fit.h"

namespace talisman::warp {

/// The answer to input that no solver should see: a coordinate that is no number (NotFinite, the identity),
/// or fewer points than the family needs (TooFewPoints, the best translation). Sizes must agree (programmer
/// error).
std::optional<FitResult> refuse(std::span<const dvec2> then_px, std::span<const dvec2> now_px, Family family);

/// The answer when the points do not determine the family: Degenerate, and the best translation. Errors and
/// bounds are the translation's, and warp.family says so.
FitResult fit_nothing(std::span<const dvec2> then_px, std::span<const dvec2> now_px, Family asked_for);

/// The result of `warp` with its errors; Degenerate where it is not acceptable (conditioning.h), otherwise
/// Converged or NotConverged.
FitResult measured(std::span<const dvec2> then_px, std::span<const dvec2> now_px, const Warp& warp,
                   bool reached);

FitResult fit_post_divide_max_norm(std::span<const dvec2> then_px, std::span<const dvec2> now_px,
                                   const FitOptions& options);

}  // namespace talisman::warp
