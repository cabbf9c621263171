// SPDX-License-Identifier: Apache-2.0
#include "layers/shade_state.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "layers/animation.h"
#include "layers/built_effects.h"
#include "layers/casting.h"
#include "layers/moving_picture.h"
#include "layers/shading.h"

namespace talisman::layers {

namespace {

constexpr double kMargin = 0.1;    ///< of the receiver's size: its characteristic points are not its outline
constexpr double kGrazing = 1e-9;  ///< sine of the angle below which a ray is parallel to the surface
/// Of a shadow without end: so many places along it, each so much nearer than the one behind it.
constexpr int kPlacesOfRay = 24;
constexpr double kNearerBy = 1.3;
const dvec3 kNowhere(std::numeric_limits<double>::quiet_NaN());

bool exists(const dvec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

struct Plane {
  dvec3 point, normal;  ///< world, unit normal
};

Plane to_world(const SceneFrame& frame, const SurfacePlane& plane) {
  const dmat4& m = frame.world_from_node[plane.node];
  const dvec3 normal = glm::transpose(glm::inverse(dmat3(m))) * plane.normal;
  return {dvec3(m * dvec4(plane.point, 1)), normal / glm::length(normal)};
}

dvec3 mirrored(const Plane& plane, const dvec3& p) {
  return p - 2 * glm::dot(plane.normal, p - plane.point) * plane.normal;
}

/// Where the ray from `from` through `to`, as long as it likes, meets the plane.
dvec3 hit(const Plane& plane, const dvec3& from, const dvec3& to) {
  const dvec3 ray = to - from;
  const double slope = glm::dot(plane.normal, ray), height = glm::dot(plane.normal, plane.point - from);
  if (!(std::fabs(slope) > kGrazing * glm::length(ray))) return kNowhere;
  const double t = height / slope;
  return t > 0 ? from + t * ray : kNowhere;
}

dvec3 hit_along(const Plane& plane, const dvec3& from, const dvec3& direction) {
  return hit(plane, from, from + direction);
}

/// Effects that a build leaves out touch no layer.
bool looks_up_shadows(const Layer& layer) { return is_built(Effect::ShadowMap) && !layer.casters.empty(); }
bool mirrors(const Layer& layer) { return is_built(Effect::ReflectionMap) && layer.holds.reflection; }
bool is_highlight(const Layer& layer) {
  return is_built(Effect::SpecularLayer) && layer.kind == LayerKind::Specular;
}

/// What has stayed as it is in another frame that is known. An aggregate of the same number may have had other members;
/// what makes its traces is its points, as long as no plane is theirs.
class Rest {
 public:
  Rest() = default;  ///< nothing casts: nobody asks
  Rest(const SceneFrame& frame, const LayerSet& set, std::span<const LayerState> states,
       const KnownInfluences& known)
      : known_(known), layers_(states.size(), 0), lights_(frame.lights.size(), 0) {
    for (std::size_t i = 0; i < std::min(known.states.size(), states.size()); ++i)
      layers_[i] =
          !(set.layers[i].is_aggregate() && set.layers[i].plane) && is_same_body(known.states[i], states[i]);
    for (std::size_t i = 0; i < std::min(known.lights.size(), frame.lights.size()); ++i)
      lights_[i] = known.lights[i] == frame.lights[i];
  }

  /// The shadow that would be the trace number `index` of the receiver, if all that makes it rests; else null.
  const ShadeTrace* shadow(int receiver, int light, int caster, std::size_t index) const {
    if (!layers_[receiver] || !layers_[caster] || !lights_[light]) return nullptr;
    const std::vector<ShadeTrace>& traces = known_.states[receiver].traces;
    if (index >= traces.size()) return nullptr;
    const ShadeTrace& trace = traces[index];
    const bool is_it =
        trace.kind == ShadeTrace::Kind::Shadow && trace.light == light && trace.source == caster;
    return is_it ? &trace : nullptr;
  }

 private:
  static bool is_same_body(const LayerState& a, const LayerState& b) {
    return a.layer == b.layer && a.world_points == b.world_points && a.world_from_part == b.world_from_part;
  }

  KnownInfluences known_;
  std::vector<char> layers_, lights_;  ///< by id
};

/// One receiver at one instant.
class Receiver {
 public:
  Receiver(const SceneFrame& frame, const LayerSet& set, std::span<const LayerState> states,
           const Layer& layer)
      : frame_(frame), set_(set), states_(states), layer_(layer), own_(states[layer.id]) {
    const Scene& scene = *frame.scene;
    const int node = layer.rigid_node >= 0 ? layer.rigid_node : scene.parts[layer.parts.front()].node;
    world_from_receiver_ = frame.world_from_node[node];
    receiver_from_world_ = glm::inverse(world_from_receiver_);
    if (layer.plane) plane_ = to_world(frame, *layer.plane);
    eye_ = dvec3(frame.camera.world_from_camera[3]);
    const WorldBounds world = bounds_of(own_.world_points);
    center_ = 0.5 * (world.lo + world.hi);
    radius_ =
        0.5 * std::fmax(world.hi.x - world.lo.x, std::fmax(world.hi.y - world.lo.y, world.hi.z - world.lo.z));
    std::vector<dvec3> own_places;
    for (const dvec3& p : own_.world_points) own_places.push_back(to_receiver(p));
    bounds_ = bounds_of(own_places);
    const dvec3 margin(bounds_.empty() ? 0 : kMargin * glm::length(bounds_.hi - bounds_.lo));
    bounds_.lo -= margin;
    bounds_.hi += margin;
  }

  const dmat4& world_from_receiver() const { return world_from_receiver_; }

  std::vector<ShadeTrace> traces(const Rest& rest) const {
    std::vector<ShadeTrace> traces;
    if (own_.world_points.empty() || !exists(receiver_from_world_ * dvec4(center_, 1))) return traces;
    const Scene& scene = *frame_.scene;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
      const int light = static_cast<int>(i);
      if (looks_up_shadows(layer_) && layer_.holds.shadows && scene.lights[i].casts_shadow &&
          (layer_.light < 0 || layer_.light == light))
        for (const int caster : layer_.casters) {
          const ShadeTrace* known = rest.shadow(layer_.id, light, caster, traces.size());
          if (known)
            traces.push_back(*known);
          else
            add(traces, shadow(light, caster));
        }
      if (is_highlight(layer_) && scene.lights[i].kind != Light::Kind::Ambient) add(traces, highlight(light));
    }
    if (mirrors(layer_) && plane_)
      for (const int source : layer_.reflected) {
        add(traces, reflection(source));
        add_light_in_mirror(source, traces);
      }
    return traces;
  }

 private:
  dvec3 to_receiver(const dvec3& world) const { return dvec3(receiver_from_world_ * dvec4(world, 1)); }

  bool is_directional(int light) const { return frame_.lights[light].kind == Light::Kind::Directional; }

  /// From a place to the light, unit length.
  dvec3 to_light(int light, const dvec3& from) const {
    const LightState& l = frame_.lights[light];
    return is_directional(light) ? -l.direction : glm::normalize(l.position - from);
  }

  /// The surface for shadows: the receiver's plane, or the one through its centre that faces the light.
  Plane surface(int light) const { return plane_ ? *plane_ : Plane{center_, to_light(light, center_)}; }

  ShadeTrace shadow(int light, int caster) const {
    ShadeTrace trace{ShadeTrace::Kind::Shadow, light, caster, false, {}};
    const Plane plane = surface(light);
    const LightState& l = frame_.lights[light];
    bool before_surface = false;  // some of the caster is between the light and the receiver
    const std::span<const dvec3> points = states_[caster].world_points;
    for (const dvec3& c : points) {
      const dvec3 way = is_directional(light) ? l.direction : c - l.position;
      // A caster's point may lie behind a curved receiver's centre and still be part of what casts: rays of
      // directional lights are followed both ways.
      dvec3 place = is_directional(light) ? hit_along(plane, c, way) : hit(plane, l.position, c);
      if (!exists(place) && is_directional(light)) place = hit_along(plane, c, -way);
      const double beyond = glm::dot(c - place, way) / std::fmax(glm::length(way), 1e-300);
      before_surface = before_surface || (exists(place) && beyond < (plane_ ? 0 : radius_));
      trace.places.push_back(place);
    }
    if (!is_directional(light)) before_surface |= add_endless(plane, l.position, points, trace.places);
    trace.on_receiver = before_surface && may_fall(light, set_.layers[caster]);
    return trace;
  }

  /// What rises above the light throws a shadow that does not end: along the edge from the nearest point with a shadow
  /// of its own, b, to the point above, c, the shadow runs from that of b towards where the edge is as high as the light.
  /// Places along it, as far as it can lie on the receiver. True if there is any.
  bool add_endless(const Plane& plane, const dvec3& light, std::span<const dvec3> points,
                   std::vector<dvec3>& places) const {
    const std::size_t count = points.size();
    const double up = glm::dot(plane.normal, light - plane.point) < 0 ? -1 : 1;
    const auto height = [&](const dvec3& p) { return up * glm::dot(plane.normal, p - plane.point); };
    bool any = false;
    for (std::size_t i = 0; i < count; ++i) {
      if (exists(places[i]) || !(height(points[i]) > 0)) continue;
      std::size_t below = count;
      for (std::size_t k = 0; k < count; ++k)
        if (exists(places[k]) &&
            (below == count || glm::distance(points[k], points[i]) < glm::distance(points[below], points[i])))
          below = k;
      if (below == count) continue;
      const dvec3 &b = points[below], &c = points[i];
      const double share = (height(light) - height(b)) / (height(c) - height(b));
      const dvec3 way = b + share * (c - b) - light;
      double far = glm::distance(places[below], center_) + 2 * radius_;
      for (int k = 0; k < kPlacesOfRay; ++k, far /= kNearerBy) {
        const dvec3 place = places[below] + far / glm::length(way) * way;
        any |= exists(place);
        places.push_back(place);
      }
    }
    return any;
  }

  /// Aggregates and what deforms have no tiles: their hulls stand for them.
  bool may_fall(int light, const Layer& caster) const {
    const auto body = [this](const Layer& layer) {
      const std::span<const CastingTile> tiles =
          layer.tiles ? std::span<const CastingTile>(*layer.tiles) : std::span<const CastingTile>();
      return CastingBody{tiles, states_[layer.id].world_points};
    };
    return may_cast(frame_, frame_.lights[light], body(caster), body(layer_));
  }

  ShadeTrace highlight(int light) const {
    ShadeTrace trace{ShadeTrace::Kind::Highlight, light, -1, true, {}};
    if (!plane_) {
      const dvec3 half = to_light(light, center_) + glm::normalize(eye_ - center_);
      trace.places.push_back(center_ + radius_ * glm::normalize(half));
      return trace;
    }
    const dvec3 image = mirrored(*plane_, eye_);
    dvec3 place = kNowhere;
    if (is_directional(light)) {
      place = hit_along(*plane_, image, -frame_.lights[light].direction);
    } else {
      place = hit(*plane_, image, frame_.lights[light].position);
      const double height = glm::dot(plane_->normal, frame_.lights[light].position - plane_->point);
      if (height * glm::dot(plane_->normal, eye_ - plane_->point) <= 0) place = kNowhere;
    }
    trace.places.push_back(place);
    return trace;
  }

  ShadeTrace reflection(int source) const {
    ShadeTrace trace{ShadeTrace::Kind::Reflection, -1, source, true, {}};
    for (const dvec3& c : states_[source].world_points) trace.places.push_back(in_mirror(c));
    return trace;
  }

  /// Where a place in the world is seen in the mirror.
  dvec3 in_mirror(const dvec3& c) const {
    const double eye_height = glm::dot(plane_->normal, eye_ - plane_->point);
    const bool before = glm::dot(plane_->normal, c - plane_->point) * eye_height > 0;
    return before ? hit(*plane_, eye_, mirrored(*plane_, c)) : kNowhere;
  }

  /// What lies on a mirrored layer and runs over it: its shadows, and where each light strikes it (what faces a light on a
  /// sphere around it; of a spot where its axis meets the middle).
  void add_light_in_mirror(int source, std::vector<ShadeTrace>& traces) const {
    const Layer& layer = set_.layers[source];
    if (!any_part(*frame_.scene, layer, is_lit) || states_[source].world_points.empty()) return;
    const Receiver receiver(frame_, set_, states_, layer);
    for (std::size_t i = 0; i < frame_.lights.size(); ++i) {
      const int light = static_cast<int>(i);
      if (frame_.lights[i].kind == Light::Kind::Ambient) continue;
      add(traces, {ShadeTrace::Kind::Reflection, -1, source, true, {in_mirror(receiver.struck_by(light))}});
      if (!looks_up_shadows(layer) || !frame_.scene->lights[i].casts_shadow) continue;
      for (const int caster : layer.casters) {
        ShadeTrace shadow = receiver.shadow(light, caster);
        for (dvec3& place : shadow.places) place = in_mirror(place);
        add(traces, {ShadeTrace::Kind::Reflection, -1, source, shadow.on_receiver, std::move(shadow.places)});
      }
    }
  }

  dvec3 struck_by(int light) const {
    const LightState& l = frame_.lights[light];
    const dvec3 ahead = to_light(light, center_);
    if (l.kind == Light::Kind::Spot)
      if (const dvec3 place = hit_along({center_, ahead}, l.position, l.direction); exists(place))
        return place;
    return center_ + radius_ * ahead;
  }

  /// Finishes a trace whose places are still in the world.
  void add(std::vector<ShadeTrace>& traces, ShadeTrace trace) const {
    WorldBounds bounds;
    for (dvec3& place : trace.places) {
      place = to_receiver(place);
      if (!exists(place)) continue;
      bounds.lo = glm::min(bounds.lo, place);
      bounds.hi = glm::max(bounds.hi, place);
    }
    bool meets = !bounds.empty();
    for (int k = 0; meets && k < 3; ++k)
      meets = bounds.lo[k] <= bounds_.hi[k] && bounds.hi[k] >= bounds_.lo[k];
    trace.on_receiver = trace.on_receiver && meets;
    traces.push_back(std::move(trace));
  }

  const SceneFrame& frame_;
  const LayerSet& set_;
  std::span<const LayerState> states_;
  const Layer& layer_;
  const LayerState& own_;
  dmat4 world_from_receiver_{1.0}, receiver_from_world_{1.0};
  std::optional<Plane> plane_;
  dvec3 eye_{0}, center_{0};
  double radius_ = 0;
  WorldBounds bounds_;
};

/// Does light change what a mirror shows, however the mirror itself is lit?
bool mirrors_lit_parts(const Scene& scene, const LayerSet& set, const Layer& layer) {
  return is_built(Effect::Lighting) && mirrors(layer) &&
         std::any_of(layer.reflected.begin(), layer.reflected.end(),
                     [&](int id) { return any_part(scene, set.layers[id], is_lit); });
}

/// Is the layer an aggregate in which the renderer blends what the compositor blends while it is apart?
bool blends_textures(const LayerSet& set, const Layer& layer) {
  return is_built(Effect::TextureLayers) &&
         std::any_of(layer.members.begin(), layer.members.end(),
                     [&](int member) { return set.layers[member].factored.second_texture; });
}

/// The factors of the textures of an aggregate's members, sixteen to a matrix: they tell apart what matrices do.
void append_blends(const SceneFrame& frame, const LayerSet& set, const Layer& aggregate,
                   std::vector<dmat4>& matrices) {
  for (const int member : aggregate.members) {
    dmat4 factors(0.0);
    int next = 0;
    for (std::size_t k = member; k < set.layers.size(); ++k) {
      const Layer& held = set.layers[k];
      if (held.id != member && held.base != member) break;
      if (held.gain.values.empty()) continue;
      if (next == 16) matrices.push_back(std::exchange(factors, dmat4(0.0))), next = 0;
      factors[next / 4][next % 4] = value_at(held.gain, frame.time_s);
      ++next;
    }
    if (next > 0) matrices.push_back(factors);
  }
}

/// The moving pictures on what the layer mirrors; an aggregate mirrors what its members do.
void add_mirrored_pictures(const SceneFrame& frame, const LayerSet& set, const Layer& layer,
                           LayerState& state) {
  if (!is_built(Effect::MovingPicture) || frame.picture_frames.empty()) return;
  const auto add_of = [&](const Layer& mirror) {
    for (const int id : mirror.reflected) add_shown_pictures(frame, set.layers[id].parts, state.pictures);
  };
  add_of(layer);
  for (const int member : layer.members)
    for (std::size_t k = member; k < set.layers.size(); ++k) {
      if (set.layers[k].id != member && set.layers[k].base != member) break;
      add_of(set.layers[k]);
    }
}

/// `casters`: the matrices of all that casts.
std::vector<dmat4> influence_matrices(const SceneFrame& frame, const LayerSet& set, const Layer& layer,
                                      const std::vector<dmat4>& casters) {
  std::vector<dmat4> matrices;
  if (looks_up_shadows(layer)) matrices = casters;
  if (blends_textures(set, layer)) append_blends(frame, set, layer, matrices);
  if (!is_built(Effect::ReflectionMap)) return matrices;
  for (const int id : layer.reflected) {
    const std::vector<dmat4> of_layer = part_matrices(frame, set.layers[id].parts);
    matrices.insert(matrices.end(), of_layer.begin(), of_layer.end());
  }
  return matrices;
}

}  // namespace

LayerState shade_state(const LayerState& base, const Layer& shade) {
  LayerState state = base;
  state.layer = shade.id;
  return state;
}

void capture_influences(const SceneFrame& frame, const LayerSet& set, std::span<LayerState> states,
                        const KnownInfluences& known) {
  const bool any_shadow = is_built(Effect::ShadowMap) && !set.casting_parts.empty();
  const std::vector<dmat4> casters =
      any_shadow ? part_matrices(frame, set.casting_parts) : std::vector<dmat4>{};
  const Rest rest = any_shadow ? Rest(frame, set, states, known) : Rest();
  for (const Layer& layer : set.layers) {
    LayerState& state = states[layer.id];
    if (state.layer != layer.id) continue;  // an aggregate that does not exist now
    if (layer.base >= 0 && !state.lights.empty()) state.lights = lights_on(frame, layer);
    if (mirrors_lit_parts(*frame.scene, set, layer)) state.lights = frame.lights;
    add_mirrored_pictures(frame, set, layer, state);
    if (!looks_up_shadows(layer) && layer.reflected.empty() && !is_highlight(layer) &&
        !blends_textures(set, layer))
      continue;
    state.world_from_influence = influence_matrices(frame, set, layer, casters);
    const Receiver receiver(frame, set, states, layer);
    state.world_from_receiver = receiver.world_from_receiver();
    state.traces = receiver.traces(rest);
  }
}

}  // namespace talisman::layers
