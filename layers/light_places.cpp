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

/// One face of the body: a plane, and the triangles on it.
struct HullFace {
  dvec3 a, ab, ac, normal;
  bool is_flat = false;  ///< it has no area
  double radius = 0;     ///< of the face about `a`
  double least_side = 0;
  std::span<const std::array<int, 3>> triangles;

  /// Of the triangle `first` and those that follow it in its plane.
  HullFace(const BodySurface& body, std::size_t first) : HullFace(body, body.triangles[first]) {
    std::size_t end = first + 1;
    while (end < body.triangles.size() && (is_flat || is_in_plane(body, body.triangles[end]))) ++end;
    triangles = body.triangles.subspan(first, is_flat ? 1 : end - first);
    measure(body);
  }
  double height(const dvec3& p) const { return dot(normal, p - a); }

 private:
  HullFace(const BodySurface& body, const std::array<int, 3>& t)
      : a(body.points[t[0]]), ab(body.points[t[1]] - a), ac(body.points[t[2]] - a), normal(cross(ab, ac)) {
    const double area = glm::length(normal);
    is_flat = !(area > kEdgeOnShare * glm::length(ab) * glm::length(ac)) || !std::isfinite(area);
    if (!is_flat) normal /= area;
  }
  void measure(const BodySurface& body) {
    double radius2 = 0, side2 = HUGE_VAL;
    for (const auto& t : triangles) {
      const dvec3 &p = body.points[t[0]], &q = body.points[t[1]], &r = body.points[t[2]];
      for (const dvec3& corner : {p, q, r}) radius2 = std::max(radius2, dot(corner - a, corner - a));
      side2 = std::min({side2, dot(q - p, q - p), dot(r - p, r - p)});
    }
    radius = std::sqrt(radius2), least_side = std::sqrt(side2);
  }
  /// Opposite faces may follow each other, too.
  bool is_in_plane(const BodySurface& body, const std::array<int, 3>& t) const {
    const double size = glm::length(ab) + glm::length(ac);
    return std::all_of(t.begin(), t.end(), [&](int corner) {
      return std::fabs(height(body.points[corner])) <= kSamePlane * size;
    });
  }
};

/// The first crossing of the body by the ray, by Möller & Trumbore 1997. Its distance, or infinity.
double first_crossing(const BodySurface& body, const dvec3& from, const dvec3& way, SurfacePlace& place) {
  double nearest = HUGE_VAL;
  for (const auto& t : body.triangles) {
    const dvec3 a = body.points[t[0]], ab = body.points[t[1]] - a, ac = body.points[t[2]] - a;
    const dvec3 p = cross(way, ac);
    const double determinant = dot(ab, p);
    if (!(std::fabs(determinant) > kEdgeOnShare * glm::length(ab) * glm::length(ac))) continue;
    const dvec3 to_start = from - a, q = cross(to_start, ab);
    const double u = dot(to_start, p) / determinant, v = dot(way, q) / determinant;
    const double distance = dot(ac, q) / determinant;
    if (!(u >= -kEdgeSlack && v >= -kEdgeSlack && u + v <= 1 + kEdgeSlack && distance > 0 &&
          distance < nearest))
      continue;
    nearest = distance;
    const dvec3 normal = normalize(cross(ab, ac));
    place = {from + distance * way, dot(normal, way) > 0 ? -normal : normal};
  }
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
  return std::any_of(face.triangles.begin(), face.triangles.end(), [&](const std::array<int, 3>& t) {
    const dvec3 a = body.points[t[0]], ab = body.points[t[1]] - a, ac = body.points[t[2]] - a, ap = place - a;
    const double bb = dot(ab, ab), bc = dot(ab, ac), cc = dot(ac, ac), pb = dot(ap, ab), pc = dot(ap, ac);
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

void append_light_places(const LightState& light, const dvec3& eye, const MeanSurface& surface,
                         const BodySurface& body, std::vector<SurfacePlace>& places) {
  if (light.kind == Light::Kind::Ambient || !layers::is_finite(light.position) ||
      !layers::is_finite(light.direction))
    return;
  if (light.kind == Light::Kind::Spot) add_cone(light, body, places);
  const bool has_feet = light.kind == Light::Kind::Point;
  if (!has_feet && !surface.has_specular()) return;
  const double spread = surface.has_specular() ? spread_of_highlight(surface.shininess) : 0;
  for (std::size_t first = 0; first < body.triangles.size();) {
    const HullFace face(body, first);
    first += face.triangles.size();
    if (face.is_flat) continue;
    if (has_feet) add_foot(light, face, body, places);
    if (surface.has_specular()) add_highlight(light, eye, spread, face, body, places);
  }
}

}  // namespace talisman::layers
