// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which layers does the shading of a surface call for, beside the surface itself? Shade layers [LS97 2.3,
/// appendix].
///
/// The shading expression is factored into terms that `over` can put together again:
///
///   base        ambient + diffuse + emissive, first texture     over
///   texture     (N·L) T₂                                        + (over with alpha 0)
///   shadow      black with alpha (1 - s) β, one per light       over
///   specular    highlights, dimmed where their light's s is     +
///   reflection  reflectivity × mirrored picture                 +
///
/// They lie in this order in front of their base, so that a shadow darkens both textures but neither
/// highlights nor reflections, as in the unfactored expression  Π s · (B + T₂) + Σ s · specular + reflection.
///
/// Effects on demand: a term that nothing calls for makes no layer and is not held by any sprite.
///
///   shadows     a light that casts shadows, a lit part that receives, a part that casts: lit and opaque
///   specular    a lit material with specular > 0, and a light that is not ambient
///   reflection  a material with reflectivity > 0 on parts that lie in one plane and follow one node; and
///               other layers to be seen in it. One bounce: what is mirrored does not mirror again.
///   textures    a material with a second texture

#include <span>
#include <string>

#include "layers/layer.h"

namespace talisman::layers {

/// Does the part answer to light at all? (Whether there is any is not asked.)
bool is_lit(const Scene& scene, const Part& part);
/// Is it drawn into shadow maps: lit and opaque? (A depth map knows no half-transparent surfaces.)
bool casts_shadow(const Scene& scene, const Part& part);

bool is_highlighted(const Scene& scene, const Part& part);
bool is_reflecting(const Scene& scene, const Part& part);
bool has_second_texture(const Scene& scene, const Part& part);

/// Some part of the layer is so.
bool any_part(const Scene& scene, const Layer& layer, bool (*property)(const Scene&, const Part&));

/// The plane in which all vertices of these parts lie, to 1e-5 of their extent, facing the way that most of
/// the triangles' area does; empty if there is none, or if the parts do not follow `node` rigidly. Cost:
/// O(vertices).
std::optional<SurfacePlane> common_plane(const Scene& scene, std::span<const int> parts, int node);

/// Why the layer's reflective parts cannot mirror, or empty.
std::string reflection_defect(const Scene& scene, const Layer& layer);

/// The parts that some sprite's shadows come from, ascending: what is drawn into the shadow maps.
std::vector<int> casting_parts(const Scene& scene, std::span<const Layer> layers);

/// Adds the shade layers of `specs` (one per geometry layer of `set`, in order), says which terms each sprite
/// holds and what else they depend on, and numbers all layers again: each base is followed by its own.
void add_shade_layers(const Scene& scene, std::span<const LayerSpec> specs, LayerSet& set);

/// The order of the compositor from that of the geometry layers alone: each base followed by its shade
/// layers. Ids of shade layers in `geometry_order` are ignored.
std::vector<int> with_shade_layers(std::span<const Layer> layers, std::span<const int> geometry_order);

}  // namespace talisman::layers
