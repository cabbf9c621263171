// SPDX-License-Identifier: Apache-2.0
#include "layers/light_places.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "layers/spot_cone.h"
#include "layers/vectors.h"

namespace talisman::layers {
namespace {

constexpr double kEdgeOnShare = 1e-12;  ///< of the edges' product: a triangle without area, or seen edge-on
constexpr double kEdgeSlack = 1e-9;     ///< a ray through an edge hits both triangles
constexpr double kSamePlane = 1e-9;     ///< of a triangle's sides
constexpr double kNearFace = 1e-8;      ///< of the triangle's sides, and of the way from the eye

/// Two unit vectors across `axis`, which has unit length.
std::array<dvec3, 2> across(const dvec3& axis) {
  const dvec3 u = normalize(cross(axis, std::fabs(axis.x) < 0.6 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
  return {u, cross(axis, u)};
}

/// Cosines and sines around the ring.
const std::array<dvec2, kRing>& ring() {
  static const std::array<dvec2, kRing> kTurns = [] {
    std::array<dvec2, kRing> turns;
    for (int k = 0; k < kRing; ++k) {
      const double turn = 2 * std::numbers::pi * k / kRing;
      turns[k] = {std::cos(turn), std::sin(turn)};
    }
    return turns;
  }();
  return kTurns;
}

/// Calls visit(unit vector) for the ring at an angle about the axis.
template <typename Visit>
void for_each_on_cone(const dvec3& axis, double cosine, const Visit& visit) {
  const auto [u, v] = across(axis);
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  for (const dvec2& turn : ring()) visit(cosine * axis + sine * (turn.x * u + turn.y * v));
}

using Triangle = BodySurface::Triangle;

dvec3 second(const Triangle& t) { return t.a + t.ab; }
dvec3 third(const Triangle& t) { return t.a + t.ac; }

/// The first crossing of the body by the ray, by Möller & Trumbore 1997. Its distance, or infinity.
double first_crossing(const BodySurface& body, const dvec3& from, const dvec3& way, SurfacePlace& place) {
  double nearest = HUGE_VAL;
  if (body.is_missed_by(from, way)) return nearest;
  const Triangle* met = nullptr;
  for (const Triangle& t : body.triangles()) {
    const dvec3 p = cross(way, t.ac);
    const double determinant = dot(t.ab, p);
    if (!(std::fabs(determinant) > t.edge_on)) continue;
    const dvec3 to_start = from - t.a;
    const double u = dot(to_start, p) / determinant;
    if (!(u >= -kEdgeSlack && u <= 1 + 2 * kEdgeSlack)) continue;
    const dvec3 q = cross(to_start, t.ab);
    const double v = dot(way, q) / determinant, distance = dot(t.ac, q) / determinant;
    if (!(v >= -kEdgeSlack && u + v <= 1 + kEdgeSlack && distance > 0 && distance < nearest)) continue;
    nearest = distance;
    met = &t;
  }
  if (!met) return nearest;
  const dvec3 normal = normalize(cross(met->ab, met->ac));
  place = {from + nearest * way, dot(normal, way) > 0 ? -normal : normal};
  return nearest;
}

void add_ray(const BodySurface& body, const dvec3& from, const dvec3& way,
             std::vector<SurfacePlace>& places) {
  SurfacePlace place;
  if (std::isfinite(first_crossing(body, from, way, place))) places.push_back(place);
}

void add_cone(const LightState& light, const BodySurface& body, std::vector<SurfacePlace>& places) {
  const double length = glm::length(light.direction);
  if (!(length > 0)) return;
  const dvec3 axis = light.direction / length;
  add_ray(body, light.position, axis, places);
  const double inner = std::cos(light.inner_cone_rad), outer = std::cos(light.outer_cone_rad);
  const double half = outer + cone_ramp(light).half() * (inner - outer);
  for_each_on_cone(axis, half, [&](const dvec3& way) { add_ray(body, light.position, way, places); });
}

/// The foot of the light on the face, if the body is there, and the ring about it.
void add_foot(const LightState& light, const HullFace& face, const BodySurface& body,
              std::vector<SurfacePlace>& places) {
  const double height = face.height(light.position);
  if (height == 0) return;
  const dvec3 down = height > 0 ? -face.normal : face.normal;
  SurfacePlace foot;
  const double depth = first_crossing(body, light.position, down, foot);
  if (!(std::fabs(depth - std::fabs(height)) <= kEdgeSlack * (depth + glm::length(face.ab)))) return;
  places.push_back(foot);
  for_each_on_cone(down, std::numbers::sqrt2 / 2,
                   [&](const dvec3& way) { add_ray(body, light.position, way, places); });
}

/// Is a place on the plane of the face in one of its triangles, or as near as rounding can bring it there? `far` is
/// the distance from which it was found.
bool is_in_face(const BodySurface& body, const HullFace& face, const dvec3& place, double far) {
  const auto first = body.triangles().begin() + static_cast<std::ptrdiff_t>(face.first);
  return std::any_of(first, first + static_cast<std::ptrdiff_t>(face.count), [&](const Triangle& t) {
    const dvec3 ap = place - t.a;
    const double bb = dot(t.ab, t.ab), bc = dot(t.ab, t.ac), cc = dot(t.ac, t.ac), pb = dot(ap, t.ab),
                 pc = dot(ap, t.ac);
    const double area2 = bb * cc - bc * bc, slack = kNearFace * (1 + far / std::sqrt(std::min(bb, cc)));
    const double u = cc * pb - bc * pc, v = bb * pc - bc * pb;
    return u >= -slack * area2 && v >= -slack * area2 && u + v <= (1 + 2 * slack) * area2;
  });
}

/// What the eye sees in this direction, if it is on the face.
void add_seen(const dvec3& eye, const dvec3& target, const HullFace& face, const BodySurface& body,
              std::vector<SurfacePlace>& places) {
  const double distance = glm::distance(eye, target);
  if (!(distance > 0) || !is_in_face(body, face, target, distance)) return;
  SurfacePlace place;
  const double depth = first_crossing(body, eye, (target - eye) / distance, place);
  if (std::fabs(depth - distance) <= 1e-6 * distance && std::fabs(dot(place.normal, face.normal)) > 0.999)
    places.push_back(place);
}

/// False: of a ring of this radius about a place on the plane of the face nothing is in the face (is_in_face), however
/// it rounds: a triangle is that much larger for it.
bool may_meet(const HullFace& face, const dvec3& eye, const dvec3& place, double ring) {
  const double apart = glm::distance(place, face.a), far = glm::distance(eye, place) + ring;
  const double slack = 8 * kNearFace * (face.radius + far * face.radius / face.least_side);
  const double around = (face.radius + slack) * (1 + 1e-9) + 1e-9 * (apart + ring);
  return !(std::fabs(apart - ring) > around);
}

/// Twice the tangent of the angle of H to N at which (N·H)ⁿ is a half.
double spread_of_highlight(double shininess) {
  return 2 * std::tan(std::acos(std::pow(0.5, 1 / std::max(shininess, 1.0))));
}

/// The highlight on one face. With V and L of lengths v and l a step δ across the place turns H by about
/// δ (1/v + 1/l) / 2.
void add_highlight(const LightState& light, const dvec3& eye, double spread, const HullFace& face,
                   const BodySurface& body, std::vector<SurfacePlace>& places) {
  const bool is_directional = light.kind == Light::Kind::Directional;
  const dvec3 image = eye - 2 * face.height(eye) * face.normal;
  const dvec3 way = is_directional ? -light.direction : light.position - image;
  const double slope = dot(face.normal, way), height = -face.height(image);
  const bool same_side =
      is_directional ? slope * face.height(eye) > 0 : face.height(light.position) * face.height(eye) > 0;
  if (!same_side || slope == 0) return;
  const dvec3 place = image + height / slope * way;
  if (!layers::is_finite(place)) return;
  if (may_meet(face, eye, place, 0)) add_seen(eye, place, face, body, places);
  const double from_light = is_directional ? HUGE_VAL : glm::distance(light.position, place);
  const double step = spread / (1 / glm::distance(eye, place) + 1 / from_light);
  if (!(step > 0 && std::isfinite(step)) || !may_meet(face, eye, place, step)) return;
  for_each_on_cone(face.normal, 0,
                   [&](const dvec3& aside) { add_seen(eye, place + step * aside, face, body, places); });
}

}  // namespace

double HullFace::height(const dvec3& p) const { return dot(normal, p - a); }

BodySurface::BodySurface(std::span<const dvec3> points, std::span<const std::array<int, 3>> triangles) {
  dvec3 lo(HUGE_VAL), hi(-HUGE_VAL);
  triangles_.reserve(triangles.size());
  for (const auto& corners : triangles) {
    const dvec3 a = points[corners[0]], ab = points[corners[1]] - a, ac = points[corners[2]] - a;
    triangles_.push_back({a, ab, ac, kEdgeOnShare * glm::length(ab) * glm::length(ac)});
    for (const int corner : corners) lo = glm::min(lo, points[corner]), hi = glm::max(hi, points[corner]);
  }
  center_ = 0.5 * (lo + hi), radius_ = 0.5 * glm::length(hi - lo);
  for (std::size_t first = 0; first < triangles_.size(); first += faces_.back().count)
    faces_.push_back(face_from(first));
}

/// Of the triangle `first` and those that follow it in its plane: opposite faces may follow each other, too.
HullFace BodySurface::face_from(std::size_t first) const {
  const Triangle& own = triangles_[first];
  HullFace face{own.a, own.ab, own.ac, cross(own.ab, own.ac), false, 0, 0, first, 1};
  const double area = glm::length(face.normal);
  face.is_flat = !(area > own.edge_on) || !std::isfinite(area);
  if (face.is_flat) return face;
  face.normal /= area;
  const double same_plane = kSamePlane * (glm::length(own.ab) + glm::length(own.ac));
  const auto is_on = [&](const dvec3& corner) { return std::fabs(face.height(corner)) <= same_plane; };
  const auto is_in_plane = [&](const Triangle& t) {
    return is_on(t.a) && is_on(second(t)) && is_on(third(t));
  };
  while (first + face.count < triangles_.size() && is_in_plane(triangles_[first + face.count])) ++face.count;
  double radius2 = 0, side2 = HUGE_VAL;
  for (std::size_t i = first; i < first + face.count; ++i) {
    const Triangle& t = triangles_[i];
    for (const dvec3& corner : {t.a, second(t), third(t)})
      radius2 = std::max(radius2, dot(corner - face.a, corner - face.a));
    side2 = std::min({side2, dot(t.ab, t.ab), dot(t.ac, t.ac)});
  }
  face.radius = std::sqrt(radius2), face.least_side = std::sqrt(side2);
  return face;
}

bool BodySurface::is_missed_by(const dvec3& from, const dvec3& way) const {
  constexpr double kWider = 1.01, kRounding = 1e-13;  // of the radius, of the distance
  const dvec3 to = center_ - from;
  const double along = dot(to, way), reach = kWider * radius_ + kRounding * glm::length(to);
  const dvec3 aside = to - along * way;
  return dot(aside, aside) > reach * reach || along < -reach;
}

bool draws_outlines(const LightState& light, const MeanSurface& surface) {
  if (light.kind == Light::Kind::Ambient || !is_finite(light.position) || !is_finite(light.direction))
    return false;
  return light.kind != Light::Kind::Directional || surface.has_specular();
}

void append_light_places(const LightState& light, const dvec3& eye, const MeanSurface& surface,
                         const BodySurface& body, std::vector<SurfacePlace>& places) {
  if (!draws_outlines(light, surface)) return;
  if (light.kind == Light::Kind::Spot) add_cone(light, body, places);
  const bool has_feet = light.kind == Light::Kind::Point;
  if (!has_feet && !surface.has_specular()) return;
  const double spread = surface.has_specular() ? spread_of_highlight(surface.shininess) : 0;
  for (const HullFace& face : body.faces()) {
    if (face.is_flat) continue;
    if (has_feet) add_foot(light, face, body, places);
    if (surface.has_specular()) add_highlight(light, eye, spread, face, body, places);
  }
}

}  // namespace talisman::layers
