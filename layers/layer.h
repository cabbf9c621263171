// SPDX-License-Identifier: Apache-2.0
#pragma once

/// From parts to layers: the factoring of geometry [LS97 2.1, 2.4].
///
/// A layer is a set of parts that are drawn into one sprite, together with the author's wishes for it. Layers
/// are named by the author; the parts that a layer takes are named by globs over the parts' names.

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "layers/scene.h"

namespace talisman::layers {

/// Importance of each kind of fiducial for a layer, relative to other layers. Range ≥ 0, default 1, no unit.
struct FiducialWeights {
  double geometric = 1, photometric = 1, sampling = 1, visibility = 1;
  bool operator==(const FiducialWeights&) const = default;
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
  /// Each part has its own characteristic polyhedron (true), or one polyhedron is around the whole layer
  /// (false). Without a value: one for all that moves as one, one for each of several that move against each
  /// other. For layers whose parts lie far apart: one box around them all knows nothing of the parallax between
  /// them. Cost: fits in proportion to the polyhedra.
  std::optional<bool> bound_each_part{};
  /// Share of the frame interval during which the shutter is open; 0 … 1; 0: no motion blur. The sprite's
  /// samples along the layer's motion are taken farther apart the faster it moves (PlacementOptions): blurred
  /// along that direction, and cheaper to draw as it grows [LS97 3.4].
  double motion_blur = 0;
  /// The sprite holds all of the layer that is within kWholeView_rad of the view axis, wherever the display
  /// ends: for a backdrop that is drawn once and turned under the camera. It costs the texels of all that, at
  /// a lower density where a side would exceed max_sprite_px; the density lost counts as magnification.
  bool whole_extents = false;
  std::string warp{};  ///< name of the curve that carries its sprite (warp/warp.h); empty: that of the run
  bool operator==(const LayerPreferences&) const = default;
};

/// How far from the view axis whole extents reach.
inline constexpr double kWholeView_rad = 1.3962634015954636;  // 80°

/// What a layer's sprite holds [LS97 2.3]. A geometry layer is a surface as it looks; the others are shade
/// layers, one term of the shading of their base layer, scan-converted over the same surface and composited
/// directly in front of it (layers/shading.h).
enum class LayerKind { Geometry, Shadow, Specular, Reflection, Texture, Light };

/// How the shadows of a layer are factored (layers/shading.h).
enum class ShadowsAs {
  Shade,  ///< black over all of the surface's light, one per light: exact for one light, or lights of one hue
  Light,  ///< what each light adds where it is seen, one per light: exact for any lights
  // With the extended compositor (sequences/pipeline/extended_composite.h), on the surface alone:
  Multiply,  ///< the share that is left of all light, per channel, times the surface: exact for any lights
  Atop,  ///< as Shade, atop the surface instead of over what is there: also right where cover is not whole
};

/// Does it ask for operators that `over` alone is not?
inline bool needs_registers(ShadowsAs as) { return as == ShadowsAs::Multiply || as == ShadowsAs::Atop; }

/// The terms of its shading that get sprites of their own, each with its own preferences (0.5 of the
/// resolution for a blurry shadow); a term that is empty stays in the layer's own sprite.
struct ShadingSpec {
  std::optional<LayerPreferences> shadows;     ///< a layer per light that casts shadows
  std::optional<ShadowsAs> shadows_as{};       ///< empty: as suits the lights that reach the layer
  std::optional<LayerPreferences> specular;    ///< the highlights of all lights
  std::optional<LayerPreferences> reflection;  ///< flat surfaces only
  std::optional<LayerPreferences> textures;    ///< the second texture of each material
  /// Multipliers of the two textures' sprites, 0 … 1, over time, that need no render. Empty:
  /// Material::texture_blend.
  Keys<double> first_blend, second_blend;
};

/// The plane of a flat surface, in the space of a node: it faces the way `normal` (unit length) points.
struct SurfacePlane {
  int node = -1;
  dvec3 point{0, 0, 0};
  dvec3 normal{0, 1, 0};
};

/// The author's order. Groups are drawn in the order of these values; inside a group layers are sorted by who
/// can hide whom (layers/visibility.h). Any other number is a group too, at its place in the order.
enum class OrderGroup { Background = -1, Normal = 0, Foreground = 1 };

/// What an author writes: a name and the globs of the parts (layers/glob.h).
struct LayerSpec {
  std::string name;
  std::vector<std::string> part_globs;
  OrderGroup group = OrderGroup::Normal;
  LayerPreferences preferences;
  ShadingSpec shading{};
  bool casts_shadows = true;  ///< its lit, opaque parts are drawn into the shadow maps
  Keys<double>
      fade{};  ///< alpha multiplier of its sprites, 0 … 1, over time: to see what is behind; empty: 1
};

/// Which terms of the shading a sprite holds that depend on more than its own surface and the lights. A term
/// that nothing calls for is not set.
struct HeldTerms {
  bool shadows = false;     ///< darkened by the shadow maps of `Layer::casters`
  bool reflection = false;  ///< shows `Layer::reflected`
  bool specular = false;
  bool second_texture = false;
  bool operator==(const HeldTerms&) const = default;
};

struct CastingTile;  // layers/casting.h

struct Layer {
  int id = -1;  ///< index in the LayerSet, stable over the sequence
  std::string name;
  LayerKind kind = LayerKind::Geometry;
  std::vector<int> parts;  ///< indices into Scene::parts, ascending
  OrderGroup group = OrderGroup::Normal;
  LayerPreferences preferences;
  int polygons = 0;  ///< triangles of all its parts, and of what is drawn again for its reflection
  int rigid_node =
      -1;          ///< the node that all parts follow rigidly; -1: they move against each other or deform
  int base = -1;   ///< shade layers: id of the geometry layer whose surface this is a term of
  int light = -1;  ///< Shadow, Light: index into Scene::lights
  HeldTerms holds;
  HeldTerms
      factored;  ///< Geometry, and Light and Shadow of their base: the terms that are called for and in shade layers
  /// Of a surface that factors its shadows, and of its shade layers: how.
  std::optional<ShadowsAs> shadows_as{};
  std::vector<int> casters;  ///< holds.shadows: ids of the geometry layers whose shadows may fall on it
  /// The tiles of its parts, where it casts shadows or receives them and does not deform; else null.
  std::shared_ptr<const std::vector<CastingTile>> tiles;
  std::vector<int> reflected;  ///< holds.reflection: ids of the geometry layers that it mirrors
  /// Where that matters and is so: all of it (with a reflection: all that reflects) lies in one plane.
  std::optional<SurfacePlane> plane;
  Keys<double> fade;  ///< multiplier of its sprite, colour and alpha, 0 … 1, over time; empty: 1
  Keys<double> gain;  ///< multiplier of its sprite's colour alone, likewise
  /// Of an aggregate (layers/aggregate.h): the layers drawn in it, ascending; else empty.
  std::vector<int> members;
  bool is_aggregate() const { return !members.empty(); }
};

struct LayerSet {
  std::vector<Layer> layers;
  std::string defect;  ///< empty, or the first broken rule: "layer 'x': part glob 'ship*' matches no part"
  int unassigned_parts = 0;  ///< parts that no layer takes; they are not drawn
  /// Parts drawn into the shadow maps, ascending; none if no light casts shadows or nothing receives them.
  std::vector<int> casting_parts;
};

/// Layers from the author's specs, one per spec in the same order, each followed by its shade layers
/// (layers/shading.h). A part belongs to the first layer that
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
