// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/effect_removal.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "chunker/texture.h"
#include "layers/check.h"
#include "layers/shading.h"
#include "sequences/results/summary.h"

namespace talisman::sequences {
namespace {

using layers::dmat3;
using layers::dmat4;
using layers::dvec3;
using layers::dvec4;
using layers::Effect;
using layers::Layer;
using layers::LayerKind;
using layers::LayerPreferences;
using layers::LayerSpec;
using layers::Material;
using layers::Scene;
using layers::vec3;
using layers::vec4;

// --- Scenes without an effect ---

/// Premultiplied, linear; white where there is no texture.
vec4 mean_of(const Scene& scene, int texture) {
  if (texture < 0) return vec4(1);
  const chunker::Pyramid pyramid = chunker::build_pyramid(scene.textures[texture]);
  if (pyramid.empty()) return vec4(1);
  const chunker::Float4 mean = pyramid.mean();
  return {mean[0], mean[1], mean[2], mean[3]};
}

/// The surface that a texture looks like from far away: k₁ T₁ + k₂ α₁ T₂ at the means of both.
void flatten_textures(const Scene& scene, Material& material) {
  if (material.texture < 0 && material.texture2 < 0) return;
  vec4 mean = mean_of(scene, material.texture);
  const float alpha = mean.w;
  if (material.texture2 >= 0)
    mean = material.texture_blend.x * mean +
           material.texture_blend.y * alpha * mean_of(scene, material.texture2);
  if (alpha > 0) material.base_color *= vec3(mean) / alpha;
  material.opacity *= alpha;
  material.texture = material.texture2 = -1;
  material.alpha_cutoff = 0;
}

void remove_emissive_maps(Scene& scene) {
  for (Material& material : scene.materials) {
    const vec4 mean = mean_of(scene, material.emissive_texture);
    if (material.emissive_texture >= 0 && mean.w > 0) material.emissive *= vec3(mean) / mean.w;
    material.emissive_texture = -1;
  }
}

void remove_normal_maps(Scene& scene) {
  for (Material& material : scene.materials) material.normal_texture = -1;
}

/// They stand still at their first frame.
void remove_moving_pictures(Scene& scene) { scene.moving_pictures.clear(); }

void remove_textures(Scene& scene) {
  remove_moving_pictures(scene);
  remove_emissive_maps(scene);
  remove_normal_maps(scene);
  for (Material& material : scene.materials) flatten_textures(scene, material);
  scene.textures.clear();
}

void remove_lighting(Scene& scene) {
  for (Material& material : scene.materials) material.unlit = true;
}

void remove_highlights(Scene& scene) {
  for (Material& material : scene.materials) material.specular = vec3(0);
}

void remove_translucency(Scene& scene) {
  for (Material& material : scene.materials) material.opacity = 1, material.alpha_cutoff = 0;
  for (layers::Mesh& mesh : scene.meshes) mesh.alphas.clear();
  for (layers::Texture& texture : scene.textures) {
    if (!texture.has_alpha) continue;
    for (std::size_t i = 3; i < texture.rgba.size(); i += 4) texture.rgba[i] = 255;
    texture.has_alpha = false;
  }
}

void remove_shadows(Scene& scene) {
  for (layers::Light& light : scene.lights) light.casts_shadow = false;
}

void remove_mirrors(Scene& scene) {
  for (Material& material : scene.materials) material.reflectivity = 0;
}

/// Deepest node at or above both; -1: none. A parent's index is below its children's.
int common_ancestor(const Scene& scene, int a, int b) {
  while (a != b) (a > b ? a : b) = scene.nodes[std::max(a, b)].parent;
  return a;
}

/// What carries a skinned part as a whole: the deepest node above it and its joints, or above the joints
/// alone.
int carrier_of(const Scene& scene, const layers::Part& part) {
  const std::vector<int>& joints = scene.skins[part.skin].joints;
  int above_joints = joints.empty() ? part.node : joints.front();
  for (const int joint : joints) above_joints = common_ancestor(scene, above_joints, joint);
  const int above_all = above_joints < 0 ? -1 : common_ancestor(scene, above_joints, part.node);
  return above_all >= 0 ? above_all : above_joints >= 0 ? above_joints : part.node;
}

/// Normals turn with the joint that weighs most: a pose is kept, not animated.
dvec3 posed_normal(const layers::Mesh& mesh, std::size_t vertex, const std::vector<dmat3>& turned_by) {
  const vec4& weights = mesh.weights[vertex];
  int heaviest = 0;
  for (int k = 1; k < 4; ++k)
    if (weights[k] > weights[heaviest]) heaviest = k;
  const dvec3 normal = turned_by[mesh.joints[vertex][heaviest]] * dvec3(mesh.normals[vertex]);
  const double length = glm::length(normal);
  return length > 0 ? normal / length : dvec3(mesh.normals[vertex]);
}

/// Unit length, the sign as it is; nothing where the direction is lost.
vec4 turned_tangent(const dvec3& tangent, float sign) {
  const double length = glm::length(tangent);
  return length > 0 ? vec4(vec3(tangent / length), sign) : vec4(0);
}

void pose_tangents(const dmat4& node_from_world, const std::vector<dmat4>& joints, layers::Mesh& mesh) {
  for (std::size_t i = 0; i < mesh.tangents.size(); ++i) {
    dvec3 sum(0.0);
    for (int k = 0; k < 4; ++k)
      sum += static_cast<double>(mesh.weights[i][k]) *
             (dmat3(node_from_world * joints[mesh.joints[i][k]]) * dvec3(mesh.tangents[i]));
    mesh.tangents[i] = turned_tangent(sum, mesh.tangents[i].w);
  }
}

/// The mesh of a skinned part as it is at `frame`, in the space of `node`.
layers::Mesh posed_mesh(const layers::SceneFrame& frame, const layers::Part& part, int node) {
  layers::Mesh mesh = frame.scene->meshes[part.mesh];
  const dmat4 node_from_world = glm::inverse(frame.world_from_node[node]);
  const std::vector<dvec3> world = layers::world_positions(frame, part);
  for (std::size_t i = 0; i < world.size(); ++i)
    mesh.positions[i] = vec3(node_from_world * dvec4(world[i], 1));
  std::vector<dmat3> turned_by;
  const std::vector<dmat4> joints = layers::joint_palette(frame, part);
  for (const dmat4& joint : joints)
    turned_by.push_back(glm::transpose(glm::inverse(dmat3(node_from_world * joint))));
  for (std::size_t i = 0; i < mesh.normals.size(); ++i)
    mesh.normals[i] = vec3(posed_normal(mesh, i, turned_by));
  pose_tangents(node_from_world, joints, mesh);
  mesh.joints.clear();
  mesh.weights.clear();
  return mesh;
}

void remove_skins(Scene& scene) {
  Scene posed = scene;
  const layers::SceneFrame first = scene.at(0);
  for (layers::Part& part : posed.parts) {
    if (part.skin < 0) continue;
    const int carrier = carrier_of(scene, part);
    posed.meshes.push_back(posed_mesh(first, part, carrier));
    part.mesh = static_cast<int>(posed.meshes.size()) - 1;
    part.node = carrier;
    part.skin = -1;
  }
  posed.skins.clear();
  scene = std::move(posed);
}

/// The shape of the first frame.
void remove_morphs(Scene& scene) {
  Scene still = scene;
  const layers::SceneFrame first = scene.at(0);
  for (layers::Part& part : still.parts) {
    if (scene.meshes[part.mesh].morphs.empty()) continue;
    layers::Mesh mesh = scene.meshes[part.mesh];
    const std::vector<dvec3> places = layers::morphed_positions(first, part);
    const std::vector<dvec3> normals = layers::morphed_normals(first, part);
    for (std::size_t i = 0; i < places.size(); ++i) mesh.positions[i] = vec3(places[i]);
    for (std::size_t i = 0; i < normals.size(); ++i)
      if (const double length = glm::length(normals[i]); length > 0)
        mesh.normals[i] = vec3(normals[i] / length);
    const std::vector<dvec3> tangents = layers::morphed_tangents(first, part);
    for (std::size_t i = 0; i < tangents.size(); ++i)
      mesh.tangents[i] = turned_tangent(tangents[i], mesh.tangents[i].w);
    mesh.morphs.clear();
    part.mesh = static_cast<int>(still.meshes.size());
    still.meshes.push_back(std::move(mesh));
  }
  for (layers::Mesh& mesh : still.meshes) mesh.morphs.clear();
  std::erase_if(still.tracks, [](const layers::Track& track) {
    return std::holds_alternative<layers::MorphTrack>(track.motion);
  });
  scene = std::move(still);
}

/// The brightness that the lamp has at 1 m.
void remove_falloff(Scene& scene) {
  for (layers::Light& light : scene.lights) {
    const dvec3& a = light.attenuation;
    light.color *= static_cast<float>(1 / (a.x + a.y + a.z));
    light.attenuation = {1, 0, 0};
    light.range_m = 0;
  }
}

// --- Layers ---

/// Ids change where shade layers come or go; names do not.
std::vector<layers::ExplicitPair> renamed(const std::vector<layers::ExplicitPair>& pairs,
                                          const std::vector<Layer>& before, const std::vector<Layer>& after) {
  std::map<std::string, int> id_of;
  for (const Layer& layer : after) id_of[layer.name] = layer.id;
  std::vector<layers::ExplicitPair> result;
  for (const layers::ExplicitPair& pair : pairs) {
    const auto behind = id_of.find(before[pair.behind].name), front = id_of.find(before[pair.front].name);
    if (behind != id_of.end() && front != id_of.end()) result.push_back({behind->second, front->second});
  }
  return result;
}

}  // namespace

void factor_again(Variant& variant) {
  Sequence& sequence = variant.sequence;
  layers::LayerSet factored = layers::factor(*sequence.scene, sequence.layer_specs);
  for (auto* pairs : {&sequence.explicit_order, &variant.settings.explicit_order})
    *pairs = renamed(*pairs, sequence.layers.layers, factored.layers);
  sequence.layers = std::move(factored);
}

namespace {

void change_scene(Variant& variant, void (*change)(Scene&)) {
  Scene scene = *variant.sequence.scene;
  change(scene);
  variant.sequence.scene = std::make_shared<const Scene>(std::move(scene));
  factor_again(variant);
}

/// Layers none of whose parts casts a shadow must not begin to when they become opaque.
void keep_casters(Variant& variant) {
  const Sequence& sequence = variant.sequence;
  std::size_t spec = 0;
  for (const Layer& layer : sequence.layers.layers) {
    if (layer.kind != LayerKind::Geometry) continue;
    LayerSpec& asked = variant.sequence.layer_specs[spec++];
    asked.casts_shadows =
        asked.casts_shadows && layers::any_part(*sequence.scene, layer, layers::casts_shadow);
  }
}

template <typename Change>
void change_preferences(Variant& variant, Change change) {
  for (LayerSpec& spec : variant.sequence.layer_specs) {
    change(spec.preferences);
    layers::ShadingSpec& shading = spec.shading;
    for (auto* term : {&shading.shadows, &shading.specular, &shading.reflection, &shading.textures})
      if (*term) change(**term);
  }
  factor_again(variant);
}

using Term = std::optional<LayerPreferences> layers::ShadingSpec::*;

void remove_shade_layers(Variant& variant, LayerKind kind, Term term) {
  std::vector<LayerSpec>& specs = variant.sequence.layer_specs;
  for (LayerSpec& spec : specs) spec.shading.*term = std::nullopt;
  factor_again(variant);
  // What is still there was not asked for, but must leave a sprite together with highlights or textures.
  std::size_t base = 0, geometry = 0;
  for (const Layer& layer : variant.sequence.layers.layers) {
    if (layer.kind == LayerKind::Geometry) base = geometry++;
    const bool is_light = kind == LayerKind::Shadow && layer.kind == LayerKind::Light;
    if (layer.kind == kind || is_light)
      specs[base].shading.specular = specs[base].shading.textures = std::nullopt;
  }
  factor_again(variant);
}

/// Ids of the geometry layers in the order in which the first frame shows them, merged ones side by side.
std::vector<int> first_order(const Variant& variant) {
  const Pipeline pipeline = make_pipeline(*variant.sequence.scene, variant.sequence.layers, variant.settings);
  PipelineState state(pipeline);
  const FrameReport report = step(pipeline, state, 0, nullptr);
  const LayerTable& layers = report.layers;
  std::vector<int> order;
  for (const int id : report.order.back_to_front)
    if (layers[id].is_aggregate())
      order.insert(order.end(), layers[id].members.begin(), layers[id].members.end());
    else if (layers[id].base < 0)
      order.push_back(id);
  return order;
}

void order_by_groups(Variant& variant) {
  std::vector<LayerSpec>& specs = variant.sequence.layer_specs;
  const std::vector<int> seen = first_order(variant);
  std::vector<std::tuple<layers::OrderGroup, std::size_t, std::size_t>> places;  // group, rank, spec
  for (const Layer& layer : variant.sequence.layers.layers)
    if (layer.kind == LayerKind::Geometry)
      places.emplace_back(layer.group, std::find(seen.begin(), seen.end(), layer.id) - seen.begin(),
                          places.size());
  std::sort(places.begin(), places.end());
  for (std::size_t place = 0; place < places.size(); ++place)
    specs[std::get<2>(places[place])].group = static_cast<layers::OrderGroup>(place);
  variant.sequence.explicit_order.clear();
  variant.settings.explicit_order.clear();
  factor_again(variant);
}

void stop_following_light(regulator::RegulatorOptions& options) {
  options.color_warp = false;
  options.thresholds.photometric = options.thresholds.light_angle_rad = 0;
}

/// What has to go from the scene, for effects that are called for by that alone; null for others.
void (*scene_change(Effect effect))(layers::Scene&) {
  switch (effect) {
    case Effect::Texture:
      return remove_textures;
    case Effect::Lighting:
      return remove_lighting;
    case Effect::SpecularHighlight:
      return remove_highlights;
    case Effect::Translucency:
      return remove_translucency;
    case Effect::Skinning:
      return remove_skins;
    case Effect::ShadowMap:
      return remove_shadows;
    case Effect::ReflectionMap:
      return remove_mirrors;
    case Effect::EmissiveMap:
      return remove_emissive_maps;
    case Effect::Morphing:
      return remove_morphs;
    case Effect::LightFalloff:
      return remove_falloff;
    case Effect::NormalMap:
      return remove_normal_maps;
    case Effect::MovingPicture:
      return remove_moving_pictures;
    default:
      return nullptr;
  }
}

void remove_request(Variant& variant, Effect effect) {
  switch (effect) {
    case Effect::MipFilter:
      variant.settings.render.mipmaps = false;
      return;
    case Effect::LayerResolution:
      return change_preferences(variant, [](LayerPreferences& p) { p.resolution_scale = 1; });
    case Effect::MotionBlur:
      return change_preferences(variant, [](LayerPreferences& p) { p.motion_blur = 0; });
    case Effect::SpriteCompression:
      variant.sequence.compression.reset();
      variant.settings.compression.reset();
      return;
    case Effect::Predictive:
      variant.sequence.regulator.policy = variant.settings.regulator.policy = regulator::Policy::Threshold;
      return;
    case Effect::VisibilitySort:
      return order_by_groups(variant);
    case Effect::ColorWarp:
      stop_following_light(variant.sequence.regulator);
      stop_following_light(variant.settings.regulator);
      return;
    case Effect::ShadowLayer:
      return remove_shade_layers(variant, LayerKind::Shadow, &layers::ShadingSpec::shadows);
    case Effect::SpecularLayer:
      return remove_shade_layers(variant, LayerKind::Specular, &layers::ShadingSpec::specular);
    case Effect::ReflectionLayer:
      return remove_shade_layers(variant, LayerKind::Reflection, &layers::ShadingSpec::reflection);
    case Effect::TextureLayers:
      return remove_shade_layers(variant, LayerKind::Texture, &layers::ShadingSpec::textures);
    default:
      TALISMAN_CHECK(false);  // an effect that nothing of the above can leave out
  }
}

void remove(Variant& variant, Effect effect) {
  if (effect == Effect::Translucency) keep_casters(variant);
  if (const auto change = scene_change(effect)) return change_scene(variant, change);
  remove_request(variant, effect);
}

}  // namespace

Variant without_effect(const Variant& given, Effect effect) {
  TALISMAN_CHECK(!given.sequence.layer_specs.empty());
  Variant variant = given;
  if (effect_call(given, effect).called) remove(variant, effect);
  return variant;
}

}  // namespace talisman::sequences
