// SPDX-License-Identifier: Apache-2.0
#include "layers/casting.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "layers/convex.h"
#include "layers/vectors.h"

namespace talisman::layers {
namespace {

constexpr double kTouching = 1e-9;  ///< of the extent
constexpr std::size_t kFewTriangles = 8;
constexpr int kMostCuts = 5;           ///< at most 2⁵ tiles of one part
constexpr double kWorthCutting = 0.8;  ///< of the box's volume that two halves may keep

struct BoxBounds {
  dvec3 lo{HUGE_VAL}, hi{-HUGE_VAL};
  void include(const dvec3& p) { lo = min(lo, p), hi = max(hi, p); }
  dvec3 middle() const { return 0.5 * (lo + hi); }
  dvec3 size() const { return hi - lo; }
  /// Something like the volume that flat boxes have too.
  double bulk(double thickness) const {
    const dvec3 s = size() + dvec3(thickness);
    return s.x * s.y * s.z;
  }
};

BoxBounds bounds_of_points(std::span<const dvec3> points) {
  BoxBounds bounds;
  for (const dvec3& p : points) bounds.include(p);
  return bounds;
}

// ---- Tiles ----

struct TileTriangle {
  dvec3 corner_sum;
  std::size_t first;  ///< of its indices in the mesh
};

BoxBounds bounds_of_triangles(const Mesh& mesh, std::span<const TileTriangle> triangles) {
  BoxBounds bounds;
  for (const TileTriangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) bounds.include(dvec3(mesh.positions[mesh.indices[t.first + k]]));
  return bounds;
}

std::vector<TileTriangle> tile_triangles(const Mesh& mesh) {
  std::vector<TileTriangle> triangles;
  triangles.reserve(mesh.indices.size() / 3);
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
    triangles.push_back({dvec3(mesh.positions[mesh.indices[i]]) + dvec3(mesh.positions[mesh.indices[i + 1]]) +
                             dvec3(mesh.positions[mesh.indices[i + 2]]),
                         i});
  return triangles;
}

void add_tile(int node, const BoxBounds& b, std::vector<CastingTile>& tiles) {
  CastingTile tile{node, {}};
  for (int s = 0; s < 8; ++s)
    tile.corners[s] = {s & 1 ? b.hi.x : b.lo.x, s & 2 ? b.hi.y : b.lo.y, s & 4 ? b.hi.z : b.lo.z};
  tiles.push_back(tile);
}

/// Halves at the median of the longest side, as long as that takes air away.
void cut(int node, const Mesh& mesh, std::span<TileTriangle> triangles, int cuts_left, double thickness,
         std::vector<CastingTile>& tiles) {
  const BoxBounds whole = bounds_of_triangles(mesh, triangles);
  const dvec3 size = whole.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  if (cuts_left == 0 || triangles.size() <= kFewTriangles) return add_tile(node, whole, tiles);
  const auto middle = triangles.begin() + static_cast<std::ptrdiff_t>(triangles.size() / 2);
  std::nth_element(triangles.begin(), middle, triangles.end(),
                   [axis](const TileTriangle& a, const TileTriangle& b) {
                     return a.corner_sum[axis] < b.corner_sum[axis];
                   });
  const std::span<TileTriangle> low(triangles.begin(), middle), high(middle, triangles.end());
  std::vector<CastingTile> finer;
  cut(node, mesh, low, cuts_left - 1, thickness, finer);
  cut(node, mesh, high, cuts_left - 1, thickness, finer);
  double bulk = 0;
  for (const CastingTile& tile : finer) bulk += BoxBounds{tile.corners[0], tile.corners[7]}.bulk(thickness);
  if (!(bulk < kWorthCutting * whole.bulk(thickness))) return add_tile(node, whole, tiles);
  tiles.insert(tiles.end(), finer.begin(), finer.end());
}

// ---- Hulls ----

/// Do the convex bodies meet? Both are given relative to `origin`.
bool meet(const ConvexSet& a, const ConvexSet& c, double extent) {
  const DepthDecision decision = decide_depth(a, c, 0);
  return decision.deeper || !decision.decided || decision.upper >= -kTouching * extent;
}

std::vector<dvec3> relative_to(std::span<const dvec3> points, const dvec3& origin) {
  std::vector<dvec3> moved;
  moved.reserve(2 * points.size());
  for (const dvec3& p : points) moved.push_back(p - origin);
  return moved;
}

/// The pyramid around the outer cone, as long as it must be.
std::vector<dvec3> pyramid(const LightState& light, const dvec3& apex, double length) {
  const dvec3 axis = normalize(light.direction);
  const dvec3 u = normalize(cross(axis, std::fabs(axis.x) < 0.6 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
  const dvec3 v = cross(axis, u);
  const double across = length * std::tan(light.outer_cone_rad) / std::cos(std::numbers::pi / kConeSides);
  std::vector<dvec3> corners{apex};
  for (int k = 0; k < kConeSides; ++k) {
    const double turn = 2 * std::numbers::pi * k / kConeSides;
    corners.push_back(apex + length * axis + across * (std::cos(turn) * u + std::sin(turn) * v));
  }
  return corners;
}

bool lies_in_reach(const LightState& light, const BoxBounds& receiver) {
  if (light.range_m <= 0) return true;
  const dvec3 nearest = clamp(light.position, receiver.lo, receiver.hi);
  return glm::distance(nearest, light.position) <= light.range_m;
}

/// The bodies in one light, relative to a place between them.
struct Scales {
  dvec3 origin;
  double extent;
};

Scales scales_of(std::span<const dvec3> caster, std::span<const dvec3> receiver) {
  BoxBounds all = bounds_of_points(caster);
  for (const dvec3& p : receiver) all.include(p);
  return {all.middle(), glm::length(all.size())};
}

/// Of some points, along an axis or as a slope.
struct Range {
  double lo = HUGE_VAL, hi = -HUGE_VAL;
  void include(double value) { lo = std::min(lo, value), hi = std::max(hi, value); }
  bool lies_beyond(const Range& o, double gap) const { return lo > o.hi + gap; }
};

/// The points seen along an axis: across it and along it. From a place the ranges across are slopes, which exist where
/// all points lie ahead.
struct SeenAlong {
  Range u, v, along;
  bool is_ahead = true;
};

/// Three axes at right angles, the last one along `way`, and where they meet.
struct LightAxes {
  dvec3 origin, u, v, way;
  bool is_place;

  LightAxes(const dvec3& from, const dvec3& towards, bool place)
      : origin(from), way(towards), is_place(place) {
    u = normalize(cross(way, std::fabs(way.x) < 0.6 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
    v = cross(way, u);
  }

  SeenAlong of(std::span<const dvec3> points) const {
    SeenAlong seen;
    for (const dvec3& p : points) {
      const dvec3 offset = p - origin;
      const double depth = dot(offset, way);
      seen.along.include(depth);
      seen.is_ahead = seen.is_ahead && depth > 0;
      const double scale = is_place && seen.is_ahead ? 1 / depth : 1;
      seen.u.include(scale * dot(offset, u));
      seen.v.include(scale * dot(offset, v));
    }
    return seen;
  }
};

/// Does a plane along the light, or one across it, show at once that no shadow falls on the receiver? Of most pairs
/// one does, for a tenth of what a search costs.
bool are_clearly_apart(const LightState& light, std::span<const dvec3> caster,
                       std::span<const dvec3> receiver, const Scales& scales) {
  const bool is_place = light.kind != Light::Kind::Directional;
  const dvec3 way = is_place ? scales_of(receiver, {}).origin - light.position : light.direction;
  const double length = glm::length(way);
  if (!(length > kTouching * scales.extent)) return false;
  const LightAxes axes(is_place ? light.position : scales.origin, way / length, is_place);
  const SeenAlong from = axes.of(caster), onto = axes.of(receiver);
  if (from.along.lies_beyond(onto.along, kTouching * scales.extent)) return !is_place || onto.is_ahead;
  if (is_place && !(from.is_ahead && onto.is_ahead)) return false;
  const double gap = is_place ? kTouching : kTouching * scales.extent;
  return from.u.lies_beyond(onto.u, gap) || onto.u.lies_beyond(from.u, gap) ||
         from.v.lies_beyond(onto.v, gap) || onto.v.lies_beyond(from.v, gap);
}

bool may_cast_along(const dvec3& direction, const std::vector<dvec3>& caster, std::vector<dvec3> receiver,
                    double extent) {
  const std::size_t count = receiver.size();
  const dvec3 back = -2 * extent / glm::length(direction) * direction;
  for (std::size_t i = 0; i < count; ++i) receiver.push_back(receiver[i] + back);
  return meet({caster}, {receiver}, extent);
}

bool is_in_cone(const LightState& light, const dvec3& apex, const std::vector<dvec3>& caster,
                const std::vector<dvec3>& receiver, double extent) {
  const bool has_cone = light.kind == Light::Kind::Spot && light.outer_cone_rad <= kWidestCone_rad &&
                        glm::length(light.direction) > 0;
  if (!has_cone) return true;
  const std::vector<dvec3> cone = pyramid(light, apex, 2 * (extent + glm::length(apex)));
  return meet({receiver}, {cone}, extent) && meet({caster}, {cone}, extent);
}

std::vector<dvec3> in_world(const SceneFrame& frame, const CastingTile& tile) {
  std::vector<dvec3> corners;
  for (const dvec3& p : tile.corners)
    corners.push_back(tile.node < 0 ? p : dvec3(frame.world_from_node[tile.node] * dvec4(p, 1)));
  return corners;
}

/// The tiles of `body` that pass the test.
template <typename Test>
std::vector<std::vector<dvec3>> tiles_that(const SceneFrame& frame, const CastingBody& body,
                                           const Test& test) {
  std::vector<std::vector<dvec3>> passed;
  if (body.tiles.empty()) passed.emplace_back(body.points.begin(), body.points.end());
  for (const CastingTile& tile : body.tiles)
    if (std::vector<dvec3> corners = in_world(frame, tile); test(corners))
      passed.push_back(std::move(corners));
  return passed;
}

}  // namespace

std::vector<CastingTile> casting_tiles(const Scene& scene, std::span<const int> parts) {
  std::vector<CastingTile> tiles;
  for (const int index : parts) {
    const Part& part = scene.parts[index];
    if (deforms(scene, part)) return {};
    const Mesh& mesh = scene.meshes[part.mesh];
    std::vector<TileTriangle> triangles = tile_triangles(mesh);
    if (triangles.empty()) continue;
    const double thickness = 1e-3 * glm::length(bounds_of_triangles(mesh, triangles).size());
    cut(part.node, mesh, triangles, kMostCuts, thickness, tiles);
  }
  return tiles;
}

bool may_cast(const LightState& light, std::span<const dvec3> caster, std::span<const dvec3> receiver) {
  if (light.kind == Light::Kind::Ambient || caster.empty() || receiver.empty()) return false;
  const Scales scales = scales_of(caster, receiver);
  const auto [origin, extent] = scales;
  const bool has_place = light.kind != Light::Kind::Directional;
  if (!std::isfinite(extent) || !layers::is_finite(has_place ? light.position : light.direction)) return true;
  if (are_clearly_apart(light, caster, receiver, scales)) return false;
  const std::vector<dvec3> casting = relative_to(caster, origin), receiving = relative_to(receiver, origin);
  if (!has_place) {
    if (!(glm::length(light.direction) > 0)) return false;
    return may_cast_along(light.direction, casting, receiving, extent);
  }
  if (!lies_in_reach(light, bounds_of_points(receiver))) return false;
  const dvec3 apex = light.position - origin;
  return meet({casting}, {receiving, &apex}, extent) && is_in_cone(light, apex, casting, receiving, extent);
}

bool may_cast(const SceneFrame& frame, const LightState& light, const CastingBody& caster,
              const CastingBody& receiver) {
  if (!may_cast(light, caster.points, receiver.points)) return false;
  if (caster.tiles.size() <= 1 && receiver.tiles.size() <= 1) return true;
  const auto casting = tiles_that(
      frame, caster, [&](const std::vector<dvec3>& tile) { return may_cast(light, tile, receiver.points); });
  if (receiver.tiles.empty()) return !casting.empty();
  const auto receiving = tiles_that(
      frame, receiver, [&](const std::vector<dvec3>& tile) { return may_cast(light, caster.points, tile); });
  for (const std::vector<dvec3>& from : casting)
    for (const std::vector<dvec3>& onto : receiving)
      if (may_cast(light, from, onto)) return true;
  return false;
}

}  // namespace talisman::layers
