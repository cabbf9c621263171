// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which cycles need no merging when the compositor has more operators than `over`? The decisions of the
/// profile `extended`, after Snyder & Lengyel 1998; the expressions are in layers/visibility_expression.h,
/// their pixels in sequences/pipeline/extended_composite.h.
///
/// A component of layers that go round, of which no two occlude each other, keeps its sprites and is shown by
///
///   Σ over layers L of   L out F₁ out F₂ …        F the layers in front of L
///
/// which is right for opaque and translucent layers. Merged as with `over` alone are
/// - two layers that occlude each other, and whatever is in one component with them: no expression exists;
/// - components with a layer that has shade layers: the expression would have to read the base with its
///   shadow, highlight and reflection as one operand, which is what merging draws;
/// - components that were merged in the last frame and have no cycle now: they are held as long as with `over`
///   alone, against flicker (layers/visibility.h).
/// One that was resolved stays resolved while it is held: it costs no rendering to be apart.
///
/// What it saves is rendering: sprites of members that move little are warped on, and whoever moves is drawn
/// alone. What it costs is in the compositor: out and plus beside over, two image registers of the size of a
/// picture (or of a band), and one more read of a sprite for each pair of layers that is related. In modelled time
/// each operator costs the compositor as many pixels as its image has, besides the reads of sprites. Talisman's
/// compositor has none of this.

#include <optional>
#include <string>
#include <vector>

#include "sequences/pipeline/frame_order.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

/// Why a component is merged although the compositor is extended; empty: it is resolved.
struct Resolution {
  std::optional<ResolvedCycle> cycle;
  std::string why_not;  ///< empty with a cycle, and where `over` alone says it all
};

/// `merged_before`: by layer id, the aggregate that drew the layer in the last frame, -1: none; empty in the
/// first frame.
Resolution resolve_cycle(const Pipeline& pipeline, const std::vector<int>& merged_before,
                         const layers::MergedComponent& component);

/// "in a cycle with a, b: composited by an expression"
std::string why_resolved(const LayerTable& layers, const ResolvedCycle& cycle, int layer);

}  // namespace talisman::sequences
