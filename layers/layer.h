// SPDX-License-Identifier: Apache-2.0
#pragma once

/// From parts to layers: the factoring of geometry [LS97 2.1, 2.4].
///
/// A layer is a set of parts that are drawn into one sprite, together with the author's wishes for it. Layers
/// are named by the author; the parts that a layer takes are named by globs over the parts' names.

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
  double resolution_scale =
      1;  ///< sprite texels per display pixel, each axis; (0, 4]; cost grows with its square
  double min_update_rate = 0;  ///< renders per frame, 0 … 1: re-rendered at least that often
  double max_update_rate =
      1;  ///< renders per frame, (0, 1]: never re-rendered more often, after the first time
  double share_of_expected_motion = 1;  ///< scales the growth of extents by velocity × expected reuse; ≥ 0
  /// Each part has its own characteristic polyhedron instead of one around the whole layer. For layers whose
  /// parts lie far apart: one box around them all knows nothing of the parallax between them. Cost: fits in
  /// proportion to the parts.
  bool bound_each_part = false;
};

enum class LayerKind { Geometry };

/// The author's order. Groups are drawn in the order of these values; inside a group layers are sorted by who
/// can hide whom (layers/visibility.h).
enum class OrderGroup { Background = -1, Normal = 0, Foreground = 1 };

/// What an author writes: a name and the globs ('*' any run, '?' one character) of the parts.
struct LayerSpec {
  std::string name;
  std::vector<std::string> part_globs;
  OrderGroup group = OrderGroup::Normal;
  LayerPreferences preferences;
};

struct Layer {
  int id = -1;  ///< index in the LayerSet, stable over the sequence
  std::string name;
  LayerKind kind = LayerKind::Geometry;
  std::vector<int> parts;  ///< indices into Scene::parts, ascending
  OrderGroup group = OrderGroup::Normal;
  LayerPreferences preferences;
  int polygons = 0;  ///< triangles of all its parts
  int rigid_node =
      -1;  ///< the node that all parts follow rigidly; -1: they move against each other or deform
  std::vector<int>
      members;  ///< of an aggregate (layers/aggregate.h): the layers drawn in it, ascending; else empty
  bool is_aggregate() const { return !members.empty(); }
};

struct LayerSet {
  std::vector<Layer> layers;
  std::string defect;  ///< empty, or the first broken rule: "layer 'x': part glob 'ship*' matches no part"
  int unassigned_parts = 0;  ///< parts that no layer takes; they are not drawn
};

/// True if `text` matches `glob`: '*' is any run of characters, "/" and none included, '?' is one. Cost:
/// O(glob · text).
bool glob_matches(const std::string& glob, const std::string& text);

/// Layers from the author's specs, one per spec in the same order. A part belongs to the first layer that
/// takes it. Defects: a glob that matches no part, a layer that is left without parts, a name used twice, a
/// preference out of its range; the layers are returned all the same. `rigid_node` is the deepest node above
/// all parts (or theirs) if nothing between it and them moves by a track; for parts that stand still in
/// separate trees any of their nodes; tracks whose keys are all equal do not count. Cost: O(globs with
/// wildcards · parts + globs + parts).
LayerSet factor(const Scene& scene, std::span<const LayerSpec> specs);

/// One layer per moving node (its subtree without other moving nodes); parts at rest by their top-level node,
/// where a root (or a chain of them) that only holds the scene together does not count as a level; skinned
/// parts by the top-level node of their joints, so that a figure of several skins stays one layer. Names from
/// the nodes, made unique by "#2". Used for bare models; `factor` of the result has no defect and leaves no
/// part over.
std::vector<LayerSpec> default_layer_specs(const Scene& scene);

/// World-space axis-aligned bounds at one time.
struct WorldBounds {
  dvec3 lo{HUGE_VAL, HUGE_VAL, HUGE_VAL};
  dvec3 hi{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  bool empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
};

}  // namespace talisman::layers
