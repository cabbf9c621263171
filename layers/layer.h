// SPDX-License-Identifier: Apache-2.0
#pragma once

/// From parts to layers: the factoring of geometry [LS97 2.1, 2.4].
///
/// A layer is a set of parts that are drawn into one sprite, together with the author's wishes for it. Layers are
/// named by the author; the parts that a layer takes are named by globs over the parts' names.

#include <span>
#include <string>
#include <vector>

#include "layers/scene.h"

namespace talisman::layers {

/// Importance of each kind of fiducial for a layer, relative to other layers. Range ≥ 0, default 1, no unit.
struct FiducialWeights {
  double geometric = 1, photometric = 1, sampling = 1, visibility = 1;
};

/// Resource-use preferences of a layer [LS97 2.4].
struct LayerPreferences {
  FiducialWeights importance;
  double resolution_scale = 1;     ///< sprite texels per display pixel, each axis; (0, 4]; cost grows with its square
  double min_update_rate = 0;      ///< renders per frame, 0 … 1: re-rendered at least that often
  double max_update_rate = 1;      ///< renders per frame, (0, 1]: never re-rendered more often, after the first time
  double share_of_expected_motion = 1;  ///< scales the growth of extents by velocity × expected reuse; ≥ 0
};

enum class LayerKind { Geometry };

/// The author's order. Groups are drawn in the order of these values; inside a group layers are sorted by depth.
enum class OrderGroup { Background = -1, Normal = 0, Foreground = 1 };

/// What an author writes: a name and the globs ('*' any run, '?' one character) of the parts.
struct LayerSpec {
  std::string name;
  std::vector<std::string> part_globs;
  OrderGroup group = OrderGroup::Normal;
  LayerPreferences preferences;
};

struct Layer {
  int id = -1;                     ///< index in the LayerSet, stable over the sequence
  std::string name;
  LayerKind kind = LayerKind::Geometry;
  std::vector<int> parts;          ///< indices into Scene::parts, ascending
  OrderGroup group = OrderGroup::Normal;
  LayerPreferences preferences;
  int polygons = 0;                ///< triangles of all its parts
  int rigid_node = -1;             ///< the node that all parts follow rigidly; -1: they move against each other or deform
};

struct LayerSet {
  std::vector<Layer> layers;
  std::string defect;              ///< empty, or the first broken rule: "layer 'x': part glob 'ship*' matches no part"
  int unassigned_parts = 0;        ///< parts that no layer takes; they are not drawn
};

/// True if `text` matches `glob`.
bool glob_matches(const std::string& glob, const std::string& text);

/// Layers from the author's specs. A part belongs to the first layer that takes it. Cost: O(specs · parts).
LayerSet factor(const Scene& scene, std::span<const LayerSpec> specs);

/// One layer per moving node (its subtree without other moving nodes) or, in a scene at rest, per top-level node that
/// carries parts; names from the nodes (made unique). Used for bare models.
std::vector<LayerSpec> default_layer_specs(const Scene& scene);

/// One triangle soup box per layer for sorting: world-space axis-aligned bounds at one time.
struct WorldBounds {
  dvec3 lo{HUGE_VAL, HUGE_VAL, HUGE_VAL};
  dvec3 hi{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  bool empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
};

/// Layer ids from back to front: groups in order; inside a group by separating planes of the world bounds along the axes as seen from the
/// eye, else by distance of the bounds' nearest points, else by id. Deterministic; ties go to the lower id first.
std::vector<int> back_to_front(const dvec3& eye, std::span<const Layer> layers, std::span<const WorldBounds> bounds);

}  // namespace talisman::layers
