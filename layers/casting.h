// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Can a shadow of one layer fall on another at all?
///
/// A point c of the caster C darkens a point r of the receiver R where c lies between r and the light: on the
/// segment from r to the light's place l, or on the ray from r against the light's direction d. For convex
/// bodies that is one question about two convex bodies:
///
///   point, spot    C meets conv(R ∪ {l})
///   directional    C meets conv(R ∪ (R - s d)),  s so long that R - s d lies behind all of C
///
/// answered by layers/convex.h. They meet where they touch, and where the light is in the hull of the caster.
/// A light with a range reaches no farther; a spot lights only what meets its outer cone (the pyramid of
/// kConeSides sides around it, while the cone is no wider than kWidestCone).
///
/// What is not convex is more than its hull: the hull of a land holds the air of its valley. So bodies are cut
/// into tiles, each with the box of its triangles, as long as that makes them smaller.

#include <array>
#include <span>
#include <vector>

#include "layers/scene.h"

namespace talisman::layers {

inline constexpr int kConeSides = 8;
inline constexpr double kWidestCone_rad = 1.2;

/// The corners of one tile's box in the space of a node that carries it.
struct CastingTile {
  int node = -1;
  std::array<dvec3, 8> corners{};
};

/// The tiles of some parts, all of which are rigid; empty where one deforms. Cost: O(triangles · log tiles).
std::vector<CastingTile> casting_tiles(const Scene& scene, std::span<const int> parts);

/// May a shadow of the hull of `caster` fall on the hull of `receiver` in this light? World coordinates; true
/// where something is not finite. Cost: some supports of both sets, typically 1 µs.
bool may_cast(const LightState& light, std::span<const dvec3> caster, std::span<const dvec3> receiver);

/// The same of bodies of tiles, at one frame: first as wholes, then tile by tile. Without tiles the hulls of
/// `caster_points` and `receiver_points` stand for them.
struct CastingBody {
  std::span<const CastingTile> tiles;
  std::span<const dvec3> points;  ///< world
};
bool may_cast(const SceneFrame& frame, const LightState& light, const CastingBody& caster,
              const CastingBody& receiver);

}  // namespace talisman::layers
