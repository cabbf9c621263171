// SPDX-License-Identifier: Apache-2.0
#include "layers/shading.h"
#include "layers/vectors.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "layers/casting.h"

namespace talisman::layers {

namespace {

constexpr double kFlatSurface = 1e-5;  ///< of the extent: what files call flat

const Material* material_of(const Scene& scene, const Part& part) {
  return part.material >= 0 ? &scene.materials[part.material] : nullptr;
}

std::string light_name(const Scene& scene, int light) {
  const std::string& name = scene.lights[light].name;
  return name.empty() ? "light " + std::to_string(light) : name;
}

std::vector<int> casting_lights(const Scene& scene) {
  std::vector<int> lights;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (scene.lights[i].casts_shadow) lights.push_back(static_cast<int>(i));
  return lights;
}

bool has_bright_light(const Scene& scene) {
  return std::any_of(scene.lights.begin(), scene.lights.end(),
                     [](const Light& light) { return light.kind != Light::Kind::Ambient; });
}

std::vector<int> parts_with(const Scene& scene, const Layer& layer,
                            bool (*property)(const Scene&, const Part&)) {
  std::vector<int> parts;
  for (const int part : layer.parts)
    if (property(scene, scene.parts[part])) parts.push_back(part);
  return parts;
}

// --- Flat surfaces ---

/// The triangles of some parts in the space of one node.
struct Soup {
  std::vector<dvec3> points;
  dvec3 area_normal{0, 0, 0};  ///< sum of the triangles' area vectors, turned to the side of the largest
  double extent = 0;
  bool finite = true;
};

void add_part(const dmat4& node_from_part, const Mesh& mesh, Soup& soup) {
  const std::size_t first = soup.points.size();
  soup.points.reserve(first + mesh.positions.size());
  for (const vec3& p : mesh.positions) {
    soup.points.push_back(dvec3(node_from_part * dvec4(dvec3(p), 1)));
    soup.finite = soup.finite && std::isfinite(glm::dot(soup.points.back(), soup.points.back()));
  }
  const double side = glm::determinant(dmat3(node_from_part)) < 0 ? -1 : 1;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const dvec3* corner[3];
    for (int k = 0; k < 3; ++k) corner[k] = &soup.points[first + mesh.indices[i + k]];
    soup.area_normal += side * glm::cross(*corner[1] - *corner[0], *corner[2] - *corner[0]);
  }
}

Soup soup_of(const Scene& scene, std::span<const int> parts, int node) {
  const SceneFrame frame = scene.at(0);  // between `node` and the parts nothing moves
  const dmat4 node_from_world = glm::inverse(frame.world_from_node[node]);
  Soup soup;
  for (const int part : parts)
    add_part(node_from_world * frame.world_from_node[scene.parts[part].node],
             scene.meshes[scene.parts[part].mesh], soup);
  WorldBounds bounds;
  for (const dvec3& p : soup.points) bounds.lo = glm::min(bounds.lo, p), bounds.hi = glm::max(bounds.hi, p);
  soup.extent = bounds.empty() ? 0 : glm::length(bounds.hi - bounds.lo);
  return soup;
}

// --- What the shading calls for ---

HeldTerms called_terms(const Scene& scene, const Layer& layer) {
  HeldTerms terms;
  terms.shadows = !casting_lights(scene).empty() && any_part(scene, layer, is_lit);
  terms.specular = any_part(scene, layer, is_highlighted);
  terms.reflection = any_part(scene, layer, is_reflecting) && reflection_defect(scene, layer).empty();
  terms.second_texture = any_part(scene, layer, has_second_texture);
  return terms;
}

std::shared_ptr<const std::vector<CastingTile>> tiles_of(const Scene& scene, const Layer& layer, bool casts) {
  if (!casts && !any_part(scene, layer, is_lit)) return nullptr;
  std::vector<CastingTile> tiles = casting_tiles(scene, layer.parts);
  if (tiles.empty()) return nullptr;
  return std::make_shared<const std::vector<CastingTile>>(std::move(tiles));
}

bool rests(const Scene& scene, const Layer& layer) {
  return std::none_of(layer.parts.begin(), layer.parts.end(), [&](int part) {
    return deforms(scene, scene.parts[part]) || is_animated(scene, scene.parts[part].node);
  });
}

bool rests(const Scene& scene, const Light& light) {
  return light.node < 0 || !is_animated(scene, light.node);
}

/// All tiles of a layer as one body at `frame`.
std::vector<dvec3> corners_of(const SceneFrame& frame, const Layer& layer) {
  std::vector<dvec3> points;
  for (const CastingTile& tile : *layer.tiles)
    for (const dvec3& p : tile.corners)
      points.push_back(tile.node < 0 ? p : dvec3(frame.world_from_node[tile.node] * dvec4(p, 1)));
  return points;
}

/// What of the layers of a set rests, where it is, and which lights cast; looked at once for all pairs.
class RestingCasters {
 public:
  RestingCasters(const Scene& scene, const LayerSet& set)
      : frame_(scene.at(0)), lights_(casting_lights(scene)), corners_(set.layers.size()) {
    lights_rest_ =
        std::all_of(lights_.begin(), lights_.end(), [&](int i) { return rests(scene, scene.lights[i]); });
    for (const Layer& layer : set.layers)
      if (lights_rest_ && layer.tiles && rests(scene, layer)) corners_[layer.id] = corners_of(frame_, layer);
  }

  /// Neither of the two moves, nor any light that casts, and none of these throws a shadow of the one on the
  /// other (layers/casting.h). Where something moves that is asked anew in each frame (layers/shade_state.h).
  bool never_cast(const Layer& caster, const Layer& receiver) const {
    const auto &from = corners_[caster.id], &onto = corners_[receiver.id];
    if (!from || !onto) return false;
    return std::none_of(lights_.begin(), lights_.end(), [&](int light) {
      return may_cast(frame_, frame_.lights[light], {*caster.tiles, *from}, {*receiver.tiles, *onto});
    });
  }

 private:
  SceneFrame frame_;
  std::vector<int> lights_;
  bool lights_rest_ = true;
  std::vector<std::optional<std::vector<dvec3>>> corners_;  // by layer; only of what rests and has tiles
};

/// The geometry layers that may darken `receiver`. What is flat never shadows itself.
std::vector<int> casters_for(const Scene& scene, const LayerSet& set, const std::vector<bool>& casts,
                             const RestingCasters& resting, const Layer& receiver) {
  const bool flat = common_plane(scene, receiver.parts, receiver.rigid_node).has_value();
  std::vector<int> casters;
  for (const Layer& layer : set.layers)
    if (casts[layer.id] && !(flat && layer.id == receiver.id) && !resting.never_cast(layer, receiver))
      casters.push_back(layer.id);
  return casters;
}

std::vector<int> all_but(const LayerSet& set, int id) {
  std::vector<int> ids;
  for (const Layer& layer : set.layers)
    if (layer.id != id) ids.push_back(layer.id);
  return ids;
}

void describe_geometry(const Scene& scene, const std::vector<bool>& casts, const RestingCasters* resting,
                       const LayerSet& set, Layer& layer) {
  layer.holds = called_terms(scene, layer);
  if (layer.holds.reflection)
    layer.plane = common_plane(scene, parts_with(scene, layer, is_reflecting), layer.rigid_node);
  else if (layer.holds.shadows || layer.holds.specular)
    layer.plane = common_plane(scene, layer.parts, layer.rigid_node);
  if (layer.holds.shadows) layer.casters = casters_for(scene, set, casts, *resting, layer);
  layer.holds.shadows = !layer.casters.empty();
  if (layer.holds.reflection) layer.reflected = all_but(set, layer.id);
  layer.holds.reflection = !layer.reflected.empty();
}

/// One term of `base` as a layer.
Layer shade_layer(const Layer& base, LayerKind kind, const std::string& name,
                  const LayerPreferences& preferences) {
  Layer layer;
  layer.name = base.name + "/" + name;
  layer.kind = kind;
  layer.parts = base.parts;
  layer.group = base.group;
  layer.preferences = preferences;
  layer.preferences.bound_each_part = base.preferences.bound_each_part;
  layer.polygons = base.polygons;
  layer.rigid_node = base.rigid_node;
  layer.tiles = base.tiles;
  layer.base = base.id;
  layer.plane = base.plane;
  layer.fade = base.fade;
  layer.shadows_as = base.shadows_as;
  return layer;
}

/// A multiplier that never changes; none where it is 1.
Keys<double> constant(double value) {
  return value == 1 ? Keys<double>{} : Keys<double>{{0}, {value}, Interpolation::Step};
}

/// The blend factors of the layer's first material with two textures.
vec2 material_blend(const Scene& scene, const Layer& layer) {
  for (const int part : layer.parts)
    if (has_second_texture(scene, scene.parts[part]))
      return scene.materials[scene.parts[part].material].texture_blend;
  return {1, 1};
}

/// The terms that get layers: those that are asked for and called for, and whatever must leave the sprite
/// with them.
HeldTerms terms_to_factor(const ShadingSpec& shading, const HeldTerms& called) {
  HeldTerms terms;
  terms.second_texture = shading.textures && called.second_texture;
  terms.specular = called.specular && (shading.specular || terms.second_texture);
  const bool all = terms.second_texture || terms.specular;
  terms.shadows = called.shadows && (shading.shadows || all);
  terms.reflection = called.reflection && (shading.reflection || all);
  return terms;
}

/// The shade layers of one base, in the order of the compositor.
class Factoring {
 public:
  Factoring(const Scene& scene, const LayerSpec& spec, Layer& base)
      : scene_(scene), spec_(spec), base_(base) {
    const HeldTerms called = base.holds, terms = terms_to_factor(spec.shading, called);
    const std::optional<ShadowsAs>& asked = spec.shading.shadows_as;
    if (terms.shadows) base.shadows_as = asked ? *asked : shadows_for(scene, base);
    if (terms.second_texture) add_second_texture();
    if (terms.shadows) add_shadows(called, terms);
    if (terms.specular) {
      add(LayerKind::Specular, "specular", spec.shading.specular).holds.specular = true;
      shades_.back().holds.shadows = called.shadows;
      shades_.back().casters = base.casters;
    }
    if (terms.reflection) {
      add(LayerKind::Reflection, "reflection", spec.shading.reflection).holds.reflection = true;
      shades_.back().reflected = base.reflected;
    }
    leave_behind(called, terms);
  }
  std::vector<Layer> take() { return std::move(shades_); }

 private:
  Layer& add(LayerKind kind, const std::string& name, const std::optional<LayerPreferences>& preferences) {
    shades_.push_back(shade_layer(base_, kind, name, preferences ? *preferences : spec_.preferences));
    return shades_.back();
  }

  void add_second_texture() {
    const ShadingSpec& shading = spec_.shading;
    const vec2 blend = material_blend(scene_, base_);
    Layer& layer = add(LayerKind::Texture, "texture 2", shading.textures);
    layer.holds.second_texture = true;
    layer.gain = second_gain_ =
        shading.second_blend.values.empty() ? constant(blend.y) : shading.second_blend;
    base_.gain = shading.first_blend.values.empty() ? constant(blend.x) : shading.first_blend;
  }

  /// It gives nothing here that could be missing. What moves is looked at at some times only: it may.
  bool never_reaches(int light) const {
    return rests(scene_, base_) && rests(scene_, scene_.lights[light]) && !reaches(scene_, base_, light);
  }

  void add_shadows(const HeldTerms& called, const HeldTerms& terms) {
    if (base_.shadows_as == ShadowsAs::Multiply) {
      add_seen_light(LayerKind::Shadow, "shadows", -1, terms).fade = {};
      return;
    }
    for (const int light : casting_lights(scene_)) {
      if (never_reaches(light)) continue;
      const std::string name = light_name(scene_, light);
      if (base_.shadows_as == ShadowsAs::Light)
        add_light(light, called, terms);
      else if (base_.shadows_as == ShadowsAs::Shade)
        add_seen_light(LayerKind::Shadow, "shadow of " + name, light, terms);
      else  // it darkens the surface as it is in the register, faded or not
        add_seen_light(LayerKind::Shadow, "shadow of " + name, light, terms).fade = {};
    }
  }

  void add_light(int light, const HeldTerms& called, const HeldTerms& terms) {
    const std::string name = "light of " + light_name(scene_, light);
    Layer& first = add_seen_light(LayerKind::Light, name, light, terms);
    first.gain = base_.gain;
    first.holds.specular = called.specular && !terms.specular;
    first.holds.second_texture = called.second_texture && !terms.second_texture;
    if (!terms.second_texture) return;
    Layer& second = add_seen_light(LayerKind::Light, name + ", texture 2", light, terms);
    second.gain = second_gain_;
    second.holds.second_texture = true;
  }

  Layer& add_seen_light(LayerKind kind, const std::string& name, int light, const HeldTerms& terms) {
    Layer& layer = add(kind, name, spec_.shading.shadows);
    layer.light = light;
    layer.factored = terms;
    layer.holds.shadows = true;
    layer.casters = base_.casters;
    return layer;
  }

  void leave_behind(const HeldTerms& called, const HeldTerms& terms) {
    base_.factored = terms;
    base_.holds = {called.shadows && !terms.shadows, called.reflection && !terms.reflection,
                   called.specular && !terms.specular, called.second_texture && !terms.second_texture};
    if (!base_.holds.shadows) base_.casters.clear();
    if (!base_.holds.reflection) base_.reflected.clear();
  }

  const Scene& scene_;
  const LayerSpec& spec_;
  Layer& base_;
  Keys<double> second_gain_;  ///< multiplier of what holds the second texture
  std::vector<Layer> shades_;
};

/// Ids as positions in the list, and references to geometry layers likewise.
void renumber(std::vector<Layer>& layers) {
  std::vector<int> id_of_geometry;  // by the number among geometry layers, which was the id so far
  for (std::size_t i = 0; i < layers.size(); ++i) {
    layers[i].id = static_cast<int>(i);
    if (layers[i].kind == LayerKind::Geometry) id_of_geometry.push_back(layers[i].id);
  }
  for (Layer& layer : layers) {
    if (layer.base >= 0) layer.base = id_of_geometry[layer.base];
    for (int& id : layer.casters) id = id_of_geometry[id];
    for (int& id : layer.reflected) id = id_of_geometry[id];
  }
}

/// Each render of a mirror draws what it mirrors once more.
void add_mirrored_polygons(std::vector<Layer>& layers) {
  std::vector<int> own;
  own.reserve(layers.size());
  for (const Layer& layer : layers) own.push_back(layer.polygons);
  for (Layer& layer : layers)
    for (const int id : layer.reflected) layer.polygons += own[id];
}

}  // namespace

bool is_lit(const Scene& scene, const Part& part) {
  const Material* material = material_of(scene, part);
  return !material || !material->unlit;
}

bool casts_shadow(const Scene& scene, const Part& part) {
  const Material* material = material_of(scene, part);
  if (!is_lit(scene, part)) return false;
  const std::vector<float>& alphas = scene.meshes[part.mesh].alphas;
  if (std::any_of(alphas.begin(), alphas.end(), [](float a) { return a < 1; })) return false;
  return !material ||
         (material->opacity >= 1 && (material->texture < 0 || !scene.textures[material->texture].has_alpha));
}

bool has_normal_map(const Material& material, const Mesh& mesh) {
  return !material.unlit && material.normal_texture >= 0 && material.normal_scale != 0 &&
         !mesh.tangents.empty();
}

bool is_highlighted(const Scene& scene, const Part& part) {
  const Material* material = material_of(scene, part);
  return material && is_lit(scene, part) && has_bright_light(scene) && !is_zero(material->specular);
}

bool is_reflecting(const Scene& scene, const Part& part) {
  const Material* material = material_of(scene, part);
  return material && material->reflectivity > 0;
}

bool has_second_texture(const Scene& scene, const Part& part) {
  const Material* material = material_of(scene, part);
  return material && material->texture2 >= 0;
}

bool any_part(const Scene& scene, const Layer& layer, bool (*property)(const Scene&, const Part&)) {
  return std::any_of(layer.parts.begin(), layer.parts.end(),
                     [&](int part) { return property(scene, scene.parts[part]); });
}

std::optional<SurfacePlane> common_plane(const Scene& scene, std::span<const int> parts, int node) {
  if (parts.empty() || node < 0) return std::nullopt;
  const Soup soup = soup_of(scene, parts, node);
  const double length = glm::length(soup.area_normal);
  if (!soup.finite || !(soup.extent > 0) || !(length > kFlatSurface * soup.extent * soup.extent))
    return std::nullopt;
  SurfacePlane plane{node, soup.points.front(), soup.area_normal / length};
  for (const dvec3& p : soup.points)
    if (!(std::fabs(glm::dot(p - plane.point, plane.normal)) <= kFlatSurface * soup.extent))
      return std::nullopt;
  return plane;
}

std::string reflection_defect(const Scene& scene, const Layer& layer) {
  const std::vector<int> mirrors = parts_with(scene, layer, is_reflecting);
  if (mirrors.empty()) return "no material reflects";
  if (layer.rigid_node < 0) return "its parts move against each other or deform";
  if (!common_plane(scene, mirrors, layer.rigid_node)) return "what reflects in it is not flat";
  return {};
}

bool holds_light(const Scene& scene, const Layer& layer, int light) {
  if (layer.kind == LayerKind::Light) return layer.light == light;
  const bool left_out = layer.shadows_as == ShadowsAs::Light &&
                        (layer.kind == LayerKind::Geometry || layer.kind == LayerKind::Texture);
  return !(left_out && scene.lights[light].casts_shadow);
}

std::vector<int> casting_parts(const Scene& scene, std::span<const Layer> layers) {
  std::vector<bool> used(layers.size(), false);
  for (const Layer& layer : layers)
    for (const int caster : layer.casters) used[caster] = true;
  std::vector<int> parts;
  for (const Layer& layer : layers) {
    if (!used[layer.id]) continue;
    const std::vector<int> own = parts_with(scene, layer, casts_shadow);
    parts.insert(parts.end(), own.begin(), own.end());
  }
  std::erase_if(parts, [&](int part) { return scene.parts[part].is_seam; });  // its own layer casts it
  std::sort(parts.begin(), parts.end());
  return parts;
}

void add_shade_layers(const Scene& scene, std::span<const LayerSpec> specs, LayerSet& set) {
  std::vector<bool> casts(set.layers.size(), false);
  for (std::size_t i = 0; i < set.layers.size(); ++i)
    casts[i] = specs[i].casts_shadows && any_part(scene, set.layers[i], casts_shadow);
  std::optional<RestingCasters> resting;
  if (!casting_lights(scene).empty()) {
    for (Layer& layer : set.layers) layer.tiles = tiles_of(scene, layer, casts[layer.id]);
    resting.emplace(scene, set);
  }
  for (Layer& layer : set.layers) describe_geometry(scene, casts, resting ? &*resting : nullptr, set, layer);
  std::vector<Layer> all;
  for (const Layer& geometry : set.layers) {
    Layer base = geometry;  // its id is still its number among the geometry layers
    std::vector<Layer> shades = Factoring(scene, specs[geometry.id], base).take();
    all.push_back(std::move(base));
    all.insert(all.end(), std::make_move_iterator(shades.begin()), std::make_move_iterator(shades.end()));
  }
  renumber(all);
  add_mirrored_polygons(all);
  set.layers = std::move(all);
  set.casting_parts = casting_parts(scene, set.layers);
}

std::vector<int> with_shade_layers(std::span<const Layer> layers, std::span<const int> geometry_order) {
  std::vector<int> order;
  order.reserve(layers.size());
  for (const int id : geometry_order) {
    if (layers[id].base >= 0) continue;
    order.push_back(id);
    for (std::size_t next = id + 1; next < layers.size() && layers[next].base == id; ++next)
      order.push_back(static_cast<int>(next));
  }
  return order;
}

}  // namespace talisman::layers
