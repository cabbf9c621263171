// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which layers does the shading of a surface call for, beside the surface itself? Shade layers [LS97 2.3,
/// appendix].
///
/// The shading expression is factored into terms that `over` can put together again:
///
///   base        ambient + diffuse + emissive, first texture     over
///   texture     (N·L) T₂                                        + (over with alpha 0)
///   shadow      black with alpha (1 - s) β, one per light       over     (as shade)
///   light       v (N·L) T: where the light is seen, one each    +        (as light)
///   shadows     s per channel, of all lights together           *        (as multiply)
///   shadow      black with alpha 1 - s, one per light           atop     (as atop)
///   specular    highlights, dimmed where their light's v is     +
///   reflection  reflectivity × mirrored picture                 +
///
/// They lie in this order in front of their base, so that a shadow darkens both textures but neither
/// highlights nor reflections.
///
/// As *light*, base and second texture hold only what ambient light, emission and lights without shadow give;
/// each light that casts adds its own, albedo and all, through `over` with alpha 0. That is the sum
/// Σ v_l (D_l + S_l) itself, exact for any number of lights of any hue, whole cover or not, and each sprite
/// depends on its own light alone. It costs bytes where light is, and eight bits round each sprite by itself:
/// √x/255 of linear light x. Highlights that are not factored are with their lights. Of a second texture that
/// is factored every light has a sprite too. Sums above 1 saturate at 1 in the compositor, as they do in a
/// sprite; only a fade of a sum above 1 tells them apart: it fades each sprite before the sum is cut off.
///
/// As *shade*, s is the share that is left of the luminance of all lights: one number for three channels, and
/// one factor per light where light is a sum. Exact for one light, and ambient light of its hue, on a surface
/// that does not glow; there it is one sprite of alpha alone. Where the author leaves it open that is where
/// shade is chosen, and light everywhere else (`shadows_for`).
///
/// As *multiply*, s = (Σ v_l (D_l + S_l) + rest) / (the same without v) per channel, 1 where that is 0, times the
/// base alone; as *atop*, the shade's alpha is not multiplied by cover and lies atop the base alone. Both need
/// a compositor with a register, are never chosen by themselves, and do not go with factored textures (multiply),
/// whose factors change without a render.
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

/// Is the surface lit by the normals of a texture, where it is shaded per pixel?
bool has_normal_map(const Material& material, const Mesh& mesh);

/// Some part of the layer is so.
bool any_part(const Scene& scene, const Layer& layer, bool (*property)(const Scene&, const Part&));

/// The plane in which all vertices of these parts lie, to 1e-5 of their extent, facing the way that most of
/// the triangles' area does; empty if there is none, or if the parts do not follow `node` rigidly. Cost:
/// O(vertices).
std::optional<SurfacePlane> common_plane(const Scene& scene, std::span<const int> parts, int node);

/// Why the layer's reflective parts cannot mirror, or empty.
std::string reflection_defect(const Scene& scene, const Layer& layer);

/// May the light reach the layer at some time? Its colour, its range, its cone and the side that a flat surface
/// turns to it are looked at, at 33 times over the scene's motion; what stands between is not. Cost:
/// O(vertices) at each.
bool reaches(const Scene& scene, const Layer& layer, int light);

/// How the shadows of a layer are factored where its author does not say: Light where more than one light
/// reaches it, ambient light of another hue and the surface's own emission included; else Shade.
ShadowsAs shadows_for(const Scene& scene, const Layer& layer);

/// Does the sprite of `layer` hold what this light gives? Shade layers and surfaces hold all lights, but for
/// those that shadows as light have taken out.
bool holds_light(const Scene& scene, const Layer& layer, int light);

/// The parts that some sprite's shadows come from, ascending: what is drawn into the shadow maps.
std::vector<int> casting_parts(const Scene& scene, std::span<const Layer> layers);

/// Adds the shade layers of `specs` (one per geometry layer of `set`, in order), says which terms each sprite
/// holds and what else they depend on, and numbers all layers again: each base is followed by its own.
void add_shade_layers(const Scene& scene, std::span<const LayerSpec> specs, LayerSet& set);

/// The order of the compositor from that of the geometry layers alone: each base followed by its shade
/// layers. Ids of shade layers in `geometry_order` are ignored.
std::vector<int> with_shade_layers(std::span<const Layer> layers, std::span<const int> geometry_order);

}  // namespace talisman::layers
