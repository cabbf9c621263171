// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where a track puts its node at one time.
///
/// Keys. Before the first and after the last key the end value holds. Between keys i and i+1, with
/// τ = (t − tᵢ) / (tᵢ₊₁ − tᵢ):
///   Step        value i
///   Linear      (1 − τ) pᵢ + τ pᵢ₊₁; rotations by slerp along the shorter arc
///   CatmullRom  the *path* is the centripetal spline (knot distance dᵢ = |pᵢ₊₁ − pᵢ|^½: no loops or cusps
///               between keys), the *pace* on it a monotone cubic through (tᵢ, knot i), so that velocity is continuous
///               however unevenly the keys lie in time, and a camera that has two equal keys stands still
///               between them. End tangents are one-sided. Rotations are interpolated by slerp: constant rate
///               between keys, no overshoot.
/// Two equal neighbouring keys give that value bit by bit in between: what stands still must not look as if
/// it moved.
///
/// CubicSpline  cubic Hermite with the slopes of the keys, per second: with Δ = tᵢ₊₁ − tᵢ
///                (2τ³ − 3τ² + 1) pᵢ + Δ (τ³ − 2τ² + τ) outᵢ + (3τ² − 2τ³) pᵢ₊₁ + Δ (τ³ − τ²) inᵢ₊₁
///              of rotations component by component, then of unit length (glTF 2.0, appendix C)
///
/// Everything is pure and finite for finite keys and times.

#include "layers/scene.h"

namespace talisman::layers {

/// Value of a channel at `t_s`. The channel has at least one key. Cost: O(log keys).
dvec3 value_at(const Keys<dvec3>& keys, double t_s);
double value_at(const Keys<double>& keys, double t_s);
glm::dquat value_at(const Keys<glm::dquat>& keys, double t_s);

/// Unit direction of the path at `t_s` (along it when held at an end). Where the path stands still or is left
/// without a part that `horizontal` asks for (its x–z part, of at least 1e-8 of the length), the last good
/// direction before it, else the first one after it, else −z. Cost: O(log keys), O(keys) where the path
/// stands still.
dvec3 path_direction(const Keys<dvec3>& path, double t_s, bool horizontal);

/// Rotation of a node whose −z looks along `forward` with +y up, rolled to the right by `bank_rad`. Looking
/// straight up or down, the picture's right is that of a viewer heading along `heading` (horizontal, unit
/// length). A zero or non-finite `forward` looks along `heading`.
glm::dquat look_rotation(const dvec3& forward, const dvec3& heading, double bank_rad);

/// The node's transform at `t_s` under `track`, given the one without it. A spin turns about its axis in the
/// node's own space; a flight's positions and targets are in the parent's space. A looped TransformTrack
/// repeats from its earliest to its latest key over all channels. A MorphTrack moves no node.
Transform transform_at(const Track& track, const Transform& without, double t_s);

/// The time inside the first period of a looped track that shows the same as `t_s`; others: `t_s`.
double looped(const MorphTrack& track, double t_s);

/// Does the transform change with time? False for tracks whose keys are all equal.
bool moves(const Track& track);

/// For each node the nearest node at or above it that a track moves; -1: it stands still in the world. What
/// has the same carrier does not move against each other. Cost: O(nodes + tracks).
std::vector<int> moving_carriers(const Scene& scene);

/// Time of the last key, seconds; 0 for a spin.
double end_s(const Track& track);

/// The rotation with unit length; the identity where it has none.
glm::dquat unit(const glm::dquat& rotation);

}  // namespace talisman::layers
