// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Layers that occlude each other in a cycle have no order: they are drawn into one sprite, where a z-buffer
/// decides [LS97 2.2]. Such an *aggregate* is a layer made at run time out of others, its members.
///
///   parts         the members' parts together
///   name          "a+b", the members in the order of their ids
///   preferences   the strictest of its members': the larger of any two weights, resolutions and update rates
///   bound         the members' bounds as bodies, so that the points of each member keep their indices and
///                 move with it
///   group         the members' group (layers of different groups never are in one cycle)
///   fade          that of the members if all have the same; else none, for one sprite has one multiplier:
///                 while they are merged, members are shown in full
///   textures      second textures are blended as the members' materials say, whatever their blends over time

#include <span>
#include <vector>

#include "layers/layer.h"
#include "layers/polyhedron.h"

namespace talisman::layers {

/// The layer that draws `members` (ids ascending, at least two, none of them an aggregate) in one. The name
/// is cut after three members of more than four ("a+b+c+7 more").
Layer aggregate_of(std::span<const Layer> layers, std::span<const int> members, int id);

/// Its bound, of the bounds of its members.
LayerBound aggregate_bound(std::span<const LayerBound* const> members);

/// The convex bodies of a layer whose characteristic points are `world_points`: one, or one for each of its
/// bodies. None if there are no points. The spans point into `world_points`.
std::vector<std::span<const dvec3>> convex_bodies(const LayerBound& bound,
                                                  std::span<const dvec3> world_points);

}  // namespace talisman::layers
