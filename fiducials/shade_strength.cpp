// SPDX-License-Identifier: Apache-2.0
#include "fiducials/shade_strength.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "fiducials/lit_places.h"
#include "layers/built_effects.h"
#include "layers/point_shading.h"

namespace talisman::fiducials {
namespace {

using layers::dmat3;
using layers::dvec4;
using layers::LayerBound;
using layers::LayerState;
using layers::MeanSurface;
using layers::ShadeTrace;
using layers::SurfacePoint;

constexpr dvec3 kLuminance{0.2126, 0.7152, 0.0722};

/// One material point in the two states.
struct PointPair {
  SurfacePoint then, now;
};

bool exists(const dvec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// The lights whose shadows the layer holds.
std::vector<int> lights_of(const LayerState& then, const LayerState& now, const layers::Layer& shade) {
  if (shade.light >= 0) return {shade.light};
  std::vector<int> lights;
  for (const LayerState* state : {&then, &now})
    for (const ShadeTrace& trace : state->traces)
      if (trace.kind == ShadeTrace::Kind::Shadow) lights.push_back(trace.light);
  std::sort(lights.begin(), lights.end());
  lights.erase(std::unique(lights.begin(), lights.end()), lights.end());
  return lights;
}

// ---- where ----

/// Where shadows lie on a flat surface, in its own space.
std::vector<dvec3> places_of_shadows(const LayerState& state) {
  std::vector<dvec3> places;
  for (const ShadeTrace& trace : state.traces) {
    if (trace.kind != ShadeTrace::Kind::Shadow || !trace.on_receiver) continue;
    const std::size_t first = places.size();
    dvec3 middle(0.0);
    for (const dvec3& p : trace.places)
      if (exists(p)) places.push_back(p), middle += p;
    const std::size_t count = places.size() - first;
    if (count == 0) continue;
    middle *= 1 / static_cast<double>(count);
    places.push_back(middle);
    for (std::size_t k = 0; k < count; ++k) places.push_back(0.5 * (places[first + k] + middle));
  }
  return places;
}

SurfacePoint on_plane(const LayerState& state, const dvec3& place, const dvec3& normal) {
  const dvec3 turned = glm::transpose(glm::inverse(dmat3(state.world_from_receiver))) * normal;
  return {dvec3(state.world_from_receiver * dvec4(place, 1)), turned / glm::length(turned), state.eye()};
}

std::vector<PointPair> points_on_plane(const LayerState& then, const LayerState& now, const dvec3& normal) {
  std::vector<dvec3> places = places_of_shadows(then);
  const std::vector<dvec3> of_now = places_of_shadows(now);
  places.insert(places.end(), of_now.begin(), of_now.end());
  std::vector<PointPair> points;
  points.reserve(places.size());
  for (const dvec3& place : places)
    points.push_back({on_plane(then, place, normal), on_plane(now, place, normal)});
  return points;
}

std::vector<PointPair> points_all_over(const LayerState& then, const LayerState& now,
                                       const LayerBound& bound) {
  std::vector<PointPair> points;
  if (then.world_normals.size() == now.world_normals.size() &&
      now.world_normals.size() == now.world_points.size() &&
      then.world_points.size() == now.world_points.size())
    for (std::size_t i = 0; i < now.world_points.size(); ++i)
      points.push_back({{then.world_points[i], then.world_normals[i], then.eye()},
                        {now.world_points[i], now.world_normals[i], now.eye()}});
  for (const LitPair& pair : lit_pairs(then, now, bound)) points.push_back({pair.then, pair.now});
  return points;
}

// ---- how strong ----

/// The lights on a point, in one of the states.
class LightsAt {
 public:
  LightsAt(const LayerState& state, const MeanSurface& surface, const SurfacePoint& point)
      : state_(state), surface_(surface), point_(point), whole_(surface.constant) {
    for (const layers::LightState& light : state.lights) whole_ += share_of_light(surface, light, point);
  }
  const dvec3& whole() const { return whole_; }

  /// Of one light in all of them, per channel or of the luminance.
  dvec3 share_of(int light, bool per_channel) const {
    if (static_cast<std::size_t>(light) >= state_.lights.size()) return dvec3(0);
    const dvec3 part = share_of_light(surface_, state_.lights[static_cast<std::size_t>(light)], point_);
    const auto share = [](double a, double b) { return b > 0 ? std::min(a / b, 1.0) : 0.0; };
    if (!per_channel) return dvec3(share(glm::dot(kLuminance, part), glm::dot(kLuminance, whole_)));
    return {share(part.x, whole_.x), share(part.y, whole_.y), share(part.z, whole_.z)};
  }

 private:
  const LayerState& state_;
  const MeanSurface& surface_;
  const SurfacePoint& point_;
  dvec3 whole_;
};

/// By how much a point in full shadow of any of the lights is off.
double error_at(const PointPair& point, std::span<const int> lights, const LayerState& then,
                const LayerState& now, const MeanSurface& surface, bool per_channel) {
  const LightsAt before(then, surface, point.then), after(now, surface, point.now);
  dvec3 change(0.0);
  for (const int light : lights)
    change += glm::abs(after.share_of(light, per_channel) - before.share_of(light, per_channel));
  return glm::length(glm::min(after.whole(), dvec3(1.0)) * glm::min(change, dvec3(1.0)));
}

/// Surface, eye and lights as they were: every share is what it was.
bool nothing_moved(const LayerState& then, const LayerState& now) {
  return then.lights == now.lights && then.eye() == now.eye() && then.world_from_part == now.world_from_part;
}

}  // namespace

Photometric shade_strength_of(const LayerState& then, const LayerState& now, const LayerBound& bound,
                              const layers::Layer& shade) {
  Photometric result;
  result.why_not = bound.surface_why_not;
  if (!layers::is_built(layers::Effect::ColorWarp) || !bound.surface) return result;
  result.computed = true;
  if (nothing_moved(then, now)) return result;
  const bool is_flat = shade.plane && shade.plane->node == shade.rigid_node;
  const std::vector<PointPair> points =
      is_flat ? points_on_plane(then, now, shade.plane->normal) : points_all_over(then, now, bound);
  const std::vector<int> lights = lights_of(then, now, shade);
  const bool per_channel = shade.light < 0;
  for (const PointPair& point : points) {
    const double error = error_at(point, lights, then, now, *bound.surface, per_channel);
    if (!(error > result.color)) continue;
    result.color = error;
    result.where_px = place_on_display(now, point.now.position);
    result.color_light.index = light_that_changed(then, now, *bound.surface, point.then, point.now, dvec3(1));
  }
  return result;
}

}  // namespace talisman::fiducials
