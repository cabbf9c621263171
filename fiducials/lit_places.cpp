// SPDX-License-Identifier: Apache-2.0
#include "fiducials/lit_places.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "layers/clip.h"
#include "layers/light_places.h"

namespace talisman::fiducials {
namespace {

using layers::BodySurface;
using layers::dmat3;
using layers::LayerBound;
using layers::LayerState;
using layers::LightState;
using layers::SurfacePlace;
using layers::SurfacePoint;

/// How places of one body move from one state to the other. A body that deforms moves with the middle of its
/// points.
class Carry {
 public:
  Carry(const LayerState& from, const LayerState& to, std::size_t body, std::size_t points_per_body)
      : from_middle_(middle(from, body, points_per_body)), to_middle_(middle(to, body, points_per_body)) {
    const dmat3 before(from.world_from_body[body]), after(to.world_from_body[body]);
    if (before == after || !std::isfinite(1 / glm::determinant(before))) return;
    map_ = after * glm::inverse(before);
    normal_map_ = glm::transpose(glm::inverse(map_));
    turned_ = true;
  }

  SurfacePlace operator()(const SurfacePlace& place) const {
    const dvec3 offset = place.position - from_middle_;
    if (!turned_) return {to_middle_ + offset, place.normal};
    const dvec3 normal = normal_map_ * place.normal;
    return {to_middle_ + map_ * offset, normal / glm::length(normal)};
  }
  bool is_still() const { return !turned_ && from_middle_ == to_middle_; }

 private:
  static dvec3 middle(const LayerState& state, std::size_t body, std::size_t count) {
    dvec3 sum(0.0);
    for (const dvec3& p : std::span(state.world_points).subspan(body * count, count)) sum += p;
    return sum / static_cast<double>(count);
  }

  dvec3 from_middle_, to_middle_;
  bool turned_ = false;
  dmat3 map_{1.0}, normal_map_{1.0};
};

/// Of the state now: what is on its display.
class Display {
 public:
  explicit Display(const LayerState& now)
      : clip_from_world_(layers::clip_from_world(now.camera, now.view.display_px)),
        sides_(layers::view_half_spaces(now.camera.near_m, 0, 0)) {}
  bool shows(const dvec3& p) const { return outcode(p) == 0; }
  /// False: all of the points lie beyond one side of the display, and with them what lies between them.
  bool may_show(std::span<const dvec3> points) const {
    unsigned beyond = ~0u;
    for (std::size_t i = 0; i < points.size() && beyond != 0; ++i) beyond &= outcode(points[i]);
    return beyond == 0 || points.empty();
  }

 private:
  unsigned outcode(const dvec3& p) const {
    return layers::outcode(sides_, clip_from_world_ * layers::dvec4(p, 1));
  }

  layers::dmat4 clip_from_world_;
  layers::ViewHalfSpaces sides_;
};

bool faces_eye(const SurfacePoint& p) { return dot(p.normal, p.eye - p.position) > 0; }

/// The pairs of one layer.
class Pairs {
 public:
  Pairs(const LayerState& then, const LayerState& now, const LayerBound& bound)
      : then_(then),
        now_(now),
        bound_(bound),
        display_(now),
        bodies_(now.world_from_body.size()),
        points_per_body_(now.world_points.size() / bodies_),
        triangles_per_body_(bound.hull.triangles.size() / bodies_) {}

  void add_material_points() {
    if (then_.lit_places.size() != now_.lit_places.size()) return;
    for (std::size_t i = 0; i < now_.lit_places.size(); ++i) {
      const layers::LitPlace &before = then_.lit_places[i], &after = now_.lit_places[i];
      add({point(before.at, then_), point(after.at, now_), before.color, after.color});
    }
  }

  void add_light_places() {
    if (then_.lights.size() != now_.lights.size()) return;
    const bool eye_moved = bound_.surface->has_specular() && then_.eye() != now_.eye();
    for (std::size_t body = 0; body < bodies_; ++body) {
      const Carry forward(then_, now_, body, points_per_body_), back(now_, then_, body, points_per_body_);
      if (is_beyond(body, forward)) continue;
      std::optional<BodySurface> before, after;  // where a light asks for them
      for (std::size_t l = 0; l < now_.lights.size(); ++l) {
        if (forward.is_still() && !eye_moved && then_.lights[l] == now_.lights[l]) continue;
        if (!draws_outlines(then_.lights[l], *bound_.surface) &&
            !draws_outlines(now_.lights[l], *bound_.surface))
          continue;
        if (!before) before.emplace(surface_of(then_, body)), after.emplace(surface_of(now_, body));
        for (const SurfacePlace& place : places_of(then_, *before, l)) add_shaded(place, forward(place));
        for (const SurfacePlace& place : places_of(now_, *after, l)) add_shaded(back(place), place);
      }
    }
  }

  std::vector<LitPair> take() { return std::move(pairs_); }

 private:
  static SurfacePoint point(const SurfacePlace& place, const LayerState& state) {
    return {place.position, place.normal, state.eye()};
  }

  void add(LitPair pair) {
    if (display_.shows(pair.now.position) && (faces_eye(pair.then) || faces_eye(pair.now)))
      pairs_.push_back(pair);
  }

  void add_shaded(const SurfacePlace& then_at, const SurfacePlace& now_at) {
    LitPair pair{point(then_at, then_), point(now_at, now_)};
    pair.then_color = shaded_color(*bound_.surface, then_.lights, pair.then);
    pair.now_color = shaded_color(*bound_.surface, now_.lights, pair.now);
    add(pair);
  }

  /// Nothing of the body is on the display, nor of what it was then and is carried there.
  bool is_beyond(std::size_t body, const Carry& forward) const {
    const auto points_of = [&](const LayerState& state) {
      return std::span(state.world_points).subspan(body * points_per_body_, points_per_body_);
    };
    if (display_.may_show(points_of(now_))) return false;
    std::vector<dvec3> carried;
    for (const dvec3& p : points_of(then_)) carried.push_back(forward({p, dvec3(0.0)}).position);
    return !display_.may_show(carried);
  }

  BodySurface surface_of(const LayerState& state, std::size_t body) const {
    return {state.world_points,
            std::span(bound_.hull.triangles).subspan(body * triangles_per_body_, triangles_per_body_)};
  }

  std::vector<SurfacePlace> places_of(const LayerState& state, const BodySurface& surface,
                                      std::size_t light) const {
    std::vector<SurfacePlace> places;
    append_light_places(state.lights[light], state.eye(), *bound_.surface, surface, places);
    return places;
  }

  const LayerState &then_, &now_;
  const LayerBound& bound_;
  Display display_;
  std::size_t bodies_, points_per_body_, triangles_per_body_;
  std::vector<LitPair> pairs_;
};

}  // namespace

std::vector<LitPair> lit_pairs(const LayerState& then, const LayerState& now, const LayerBound& bound) {
  if (!bound.surface || now.world_from_body.empty() ||
      then.world_from_body.size() != now.world_from_body.size() ||
      then.world_points.size() != now.world_points.size())
    return {};
  Pairs pairs(then, now, bound);
  pairs.add_material_points();
  pairs.add_light_places();
  return pairs.take();
}

int light_that_changed(const LayerState& then, const LayerState& now, const layers::MeanSurface& surface,
                       const SurfacePoint& then_at, const SurfacePoint& now_at, const dvec3& multiplier) {
  int worst = LightRef::kNone;
  double most = 0;
  for (std::size_t l = 0; l < std::min(then.lights.size(), now.lights.size()); ++l) {
    const dvec3 before = share_of_light(surface, then.lights[l], then_at);
    const dvec3 after = share_of_light(surface, now.lights[l], now_at);
    const double change = glm::length(after - multiplier * before);
    if (change > most) most = change, worst = static_cast<int>(l);
  }
  return worst;
}

dvec2 place_on_display(const LayerState& state, const dvec3& position) {
  const layers::dvec4 clip =
      layers::clip_from_world(state.camera, state.view.display_px) * layers::dvec4(position, 1);
  if (clip.w > state.camera.near_m) return layers::screen_from_clip(clip, state.view.display_px);
  return (state.screen_bounds_px.lo + state.screen_bounds_px.hi) / 2.0;
}

}  // namespace talisman::fiducials
