// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which parts of a layer does a render of its sprite need, and each at which level?
///
/// A layer of many parts, above all one that stands for others (layers/aggregate.h), reaches from the eye to far away: one
/// level for all of it is too coarse there or too dear here. So each part has its own:
///
///   outside     no corner of its box lies in the rectangle of the sprite: not drawn, which changes no texel
///   rung r      the coarsest level with level_error_px ≤ kRungs_px[r], at the nearest depth of its box; or nothing at
///               all, where level_error_px of the diagonal of its box is no more than that
///   last rung   the coarsest level of all, whatever its error; nothing, where the diagonal is ≤ kLeftOut_px
///
/// What is morphed or skinned has no such box: it is drawn, and its depth is that of the layer.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "layers/layer.h"
#include "layers/lod/ladder.h"
#include "layers/sprite_transform.h"

namespace talisman::layers {

/// Allowed errors, px; the last is for the rung behind them, whose levels may err by more.
inline constexpr std::array kRungs_px = {0.0,  0.25, 0.5,  1.0,  2.0,  4.0, 8.0,
                                         16.0, 24.0, 32.0, 48.0, 64.0, 96.0};
inline constexpr int kRungs = static_cast<int>(kRungs_px.size()) + 1;
inline constexpr double kLeftOut_px = 128;
/// Triangles of the coarsest level from which on a part is left out at the whole of that; one of n at √(n / this) of it, so
/// that walls of a few triangles outlast what is dear for its size.
inline constexpr double kDearPart = 192;

/// A layer as it is drawn.
struct MemberLevels {
  std::vector<int> parts;     ///< in the order of the layer's; at least one
  std::int64_t polygons = 0;  ///< triangles of them
  double error_px = 0;        ///< the largest of what is drawn or left out; 0: as the layer itself
};

/// Does each part of the layer get a level of its own? Of scenes with levels, layers that may have them and have several
/// parts.
bool has_member_levels(const Scene& scene, const Layer& layer);

/// The parts of such a layer as its sprite shows them: looked at once, and asked at any number of levels. `scene` and `layer`
/// outlive it.
class ShownMembers {
 public:
  /// `now`, `placement`: as the sprite is drawn. Cost: O(parts).
  ShownMembers(const Scene& scene, const Layer& layer, const LayerState& now,
               const SpritePlacement& placement);

  MemberLevels at_rung(int rung) const;  ///< clamped to 0 … kRungs - 1. Cost: O(parts · levels)
  /// One level for all (layers/lod/levels.h): only what is outside is left out. Cost: O(parts).
  MemberLevels at_level(int level) const;

 private:
  struct Member {
    bool has_levels = false;  ///< else it is drawn as it is
    bool outside = false;
    double nearest_m = 0, diagonal_m = 0;  ///< of its box
    double stretch = 1;
  };
  struct Choice {
    int level = 0;  ///< -1: none, it is not drawn
    double error_px = 0;
  };
  double error_px(double error_m, double nearest_m) const;
  Choice at_level(std::size_t i, int level) const;
  Choice at_rung(std::size_t i, int rung) const;
  const std::vector<LadderLevel>& ladder_of(std::size_t i) const;
  template <typename Choose>
  MemberLevels chosen(const Choose& choose) const;

  const Scene* scene_;
  const Layer* layer_;
  double focal_px_, most_tangent_;
  std::vector<Member> members_;  ///< by part of the layer
};

}  // namespace talisman::layers
