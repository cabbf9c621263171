// SPDX-License-Identifier: Apache-2.0
#include "layers/polyhedron.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <glm/geometric.hpp>

#include "layers/animation.h"
#include "layers/check.h"
#include "layers/seam.h"
#include "layers/vectors.h"

namespace talisman::layers {
namespace {

/// Bit i of a corner's number: on the high side of axis i. An edge is named by its axis c and its corner with
/// bit c 0.
constexpr int kCorners = 8;

struct Cuts {
  std::array<double, kCorners> corner{};               ///< k(s)
  std::array<std::array<double, kCorners>, 3> edge{};  ///< e(s,c) at [c][s without bit c]

  double& edge_at(int s, int c) { return edge[c][s & ~(1 << c)]; }
  double edge_at(int s, int c) const { return edge[c][s & ~(1 << c)]; }
};

struct Box {
  dvec3 lo{HUGE_VAL}, hi{-HUGE_VAL};
  dvec3 size() const { return hi - lo; }
  dvec3 inside_depth(const dvec3& p, int s) const {
    return {s & 1 ? hi.x - p.x : p.x - lo.x, s & 2 ? hi.y - p.y : p.y - lo.y,
            s & 4 ? hi.z - p.z : p.z - lo.z};
  }
  dvec3 at_depth(const dvec3& u, int s) const {
    return {s & 1 ? hi.x - u.x : lo.x + u.x, s & 2 ? hi.y - u.y : lo.y + u.y,
            s & 4 ? hi.z - u.z : lo.z + u.z};
  }
};

/// Which vertices a kind has at each corner: the axes a, b, c of their face, edge and slide.
std::span<const std::array<int, 3>> vertices_per_corner(BoundKind kind) {
  static constexpr std::array<std::array<int, 3>, 6> kAxes{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {1, 0, 2}, {2, 1, 0}}};
  switch (kind) {
    case BoundKind::Box8:
      return std::span(kAxes).first(1);
    case BoundKind::Dop14:
      return std::span(kAxes).first(3);
    case BoundKind::Dop26:
      break;
  }
  return kAxes;
}

std::vector<dvec3> vertices(const Box& box, const Cuts& cuts, BoundKind kind) {
  std::vector<dvec3> result;
  result.reserve(kCorners * vertices_per_corner(kind).size());
  for (int s = 0; s < kCorners; ++s) {
    for (const auto& [a, b, c] : vertices_per_corner(kind)) {
      dvec3 u(0.0);
      u[b] = cuts.edge_at(s, c);
      u[c] = cuts.corner[s] - u[b];
      result.push_back(box.at_depth(u, s));
    }
  }
  return result;
}

// ---- topology: the faces of one well-shaped solid of each kind
// ------------------------------------------------

bool has_plane(BoundKind kind, int axes_in_normal) {
  return axes_in_normal == 1 || (axes_in_normal == 3 && kind != BoundKind::Box8) ||
         (axes_in_normal == 2 && kind == BoundKind::Dop26);
}

/// The vertices that lie on the supporting plane with normal `n`, counter-clockwise seen from outside.
std::vector<int> face_with_normal(const std::vector<dvec3>& points, const dvec3& n) {
  double support = -HUGE_VAL;
  for (const dvec3& p : points) support = std::max(support, dot(p, n));
  const dvec3 u = normalize(cross(n, std::abs(n.x) < std::abs(n.y) ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
  const dvec3 v = cross(n, u);
  std::vector<std::pair<double, int>> by_angle;
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    if (dot(points[i], n) > support - 1e-9) {
      by_angle.emplace_back(std::atan2(dot(points[i], v), dot(points[i], u)), i);
    }
  }
  std::sort(by_angle.begin(), by_angle.end());
  std::vector<int> face;
  face.reserve(by_angle.size());
  for (const auto& [angle, i] : by_angle) face.push_back(i);
  return face;
}

struct Topology {
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> face_ends;
};

Topology make_topology(BoundKind kind) {
  // The cuts of a sphere in its cube (rounded): no two of them meet.
  Cuts cuts;
  if (kind == BoundKind::Dop14) cuts.corner.fill(0.6);
  if (kind == BoundKind::Dop26) {
    cuts.corner.fill(1.268);
    for (auto& edges : cuts.edge) edges.fill(0.586);
  }
  const auto points = vertices({dvec3(-1.0), dvec3(1.0)}, cuts, kind);
  Topology topology;
  for (int code = 0; code < 27; ++code) {
    const dvec3 n(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1);
    if (!has_plane(kind, static_cast<int>(dot(n, n)))) continue;
    const auto face = face_with_normal(points, normalize(n));
    for (std::size_t i = 2; i < face.size(); ++i)
      topology.triangles.push_back({face[0], face[i - 1], face[i]});
    topology.face_ends.push_back(static_cast<int>(topology.triangles.size()));
  }
  return topology;
}

const Topology& topology_of(BoundKind kind) {
  static const std::array<Topology, 3> kTopologies{
      make_topology(BoundKind::Box8), make_topology(BoundKind::Dop14), make_topology(BoundKind::Dop26)};
  return kTopologies[static_cast<int>(kind)];
}

/// Appends one polyhedron of the kind whose points follow `first` others.
void append_topology(BoundKind kind, int first, Polyhedron& hull) {
  const int first_triangle = static_cast<int>(hull.triangles.size());
  for (const auto& [a, b, c] : topology_of(kind).triangles)
    hull.triangles.push_back({a + first, b + first, c + first});
  for (const int end : topology_of(kind).face_ends) hull.face_ends.push_back(first_triangle + end);
}

// ---- cuts: as deep as the points allow, then as shallow as the topology needs
// ----------------------------------

Cuts deepest_cuts(std::span<const dvec3> points, const Box& box) {
  Cuts cuts;
  cuts.corner.fill(HUGE_VAL);
  for (auto& edges : cuts.edge) edges.fill(HUGE_VAL);
  for (const dvec3& p : points) {
    for (int s = 0; s < kCorners; ++s) {
      const dvec3 u = box.inside_depth(p, s);
      cuts.corner[s] = std::min(cuts.corner[s], u.x + u.y + u.z);
      if (!(s & 1)) cuts.edge[0][s] = std::min(cuts.edge[0][s], u.y + u.z);
      if (!(s & 2)) cuts.edge[1][s] = std::min(cuts.edge[1][s], u.x + u.z);
      if (!(s & 4)) cuts.edge[2][s] = std::min(cuts.edge[2][s], u.x + u.y);
    }
  }
  return cuts;
}

/// The factor that brings `sum` down to `limit`; 1 where it already is.
double shrink(double sum, double limit) { return sum > limit ? limit / sum : 1.0; }

/// Dop14: the two corners of each box edge share its length in proportion to their cuts.
Cuts separate_corners(const Cuts& deepest, const dvec3& size) {
  Cuts cuts;
  for (int s = 0; s < kCorners; ++s) {
    double factor = 1;
    for (int c = 0; c < 3; ++c) {
      factor = std::min(factor, shrink(deepest.corner[s] + deepest.corner[s ^ (1 << c)], size[c]));
    }
    cuts.corner[s] = deepest.corner[s] * factor;
  }
  return cuts;
}

/// Dop26: first every two edges at a corner share its cut; that may leave corners too deep for the shallower
/// edges, which one common factor on all cuts repairs (the first rule does not change under it).
Cuts separate_corners_and_edges(const Cuts& deepest, const dvec3& size) {
  Cuts cuts = deepest;
  for (int s = 0; s < kCorners; ++s) {
    for (int c = 0; c < 3; ++c) {
      const double own = deepest.edge_at(s, c);
      for (const int other : {(c + 1) % 3, (c + 2) % 3}) {
        const double shared = own * shrink(own + deepest.edge_at(s, other), deepest.corner[s]);
        cuts.edge_at(s, c) = std::min(cuts.edge_at(s, c), shared);
      }
    }
  }
  double factor = 1;
  for (int c = 0; c < 3; ++c) {
    for (int s = 0; s < kCorners; ++s) {
      const double used = cuts.corner[s] + cuts.corner[s ^ (1 << c)] - 2 * cuts.edge_at(s, c);
      factor = std::min(factor, shrink(used, size[c]));
    }
  }
  for (double& k : cuts.corner) k *= factor;
  for (auto& edges : cuts.edge) {
    for (double& e : edges) e *= factor;
  }
  return cuts;
}

Cuts cuts_for(std::span<const dvec3> points, const Box& box, BoundKind kind) {
  switch (kind) {
    case BoundKind::Box8:
      break;
    case BoundKind::Dop14:
      return separate_corners(deepest_cuts(points, box), box.size());
    case BoundKind::Dop26:
      return separate_corners_and_edges(deepest_cuts(points, box), box.size());
  }
  return {};
}

// ---- layers
// ----------------------------------------------------------------------------------------------------

bool is_self_or_ancestor(const Scene& scene, int ancestor, int node) {
  while (node > ancestor) node = scene.nodes[node].parent;
  return node == ancestor;
}

/// Parents come before their children, so the higher index of two nodes is never above the other one.
int lowest_common_node(const Scene& scene, int a, int b) {
  while (a != b) {
    int& lower = a > b ? a : b;
    lower = scene.nodes[lower].parent;
  }
  return a;
}

bool is_at_rest(const Scene& scene, const Layer& layer) {
  return std::none_of(layer.parts.begin(), layer.parts.end(), [&](int part) {
    return deforms(scene, scene.parts[part]) || is_animated(scene, scene.parts[part].node);
  });
}

bool follows_rigid_node(const Scene& scene, const Layer& layer) {
  if (layer.rigid_node < 0) return false;
  return std::all_of(layer.parts.begin(), layer.parts.end(), [&](int part) {
    return !deforms(scene, scene.parts[part]) &&
           is_self_or_ancestor(scene, layer.rigid_node, scene.parts[part].node);
  });
}

/// The matrix of `node` in the space of `ancestor` (-1: the world), from the nodes' own transforms.
dmat4 ancestor_from_node(const Scene& scene, int ancestor, int node) {
  dmat4 result(1.0);
  for (; node != ancestor; node = scene.nodes[node].parent)
    result = scene.nodes[node].local.matrix() * result;
  return result;
}

/// The node whose axes a deforming layer follows best: the lowest one above all its parts, or above the
/// joints of those that are skinned.
int common_node(const Scene& scene, const Layer& layer) {
  int common = -2;  // none yet
  const auto join = [&](int node) { common = common == -2 ? node : lowest_common_node(scene, common, node); };
  for (const int index : layer.parts) {
    const Part& part = scene.parts[index];
    if (part.skin < 0) {
      join(part.node);
    } else {
      for (const int joint : scene.skins[part.skin].joints) join(joint);
    }
  }
  return std::max(common, -1);
}

std::vector<dvec3> resting_positions(const Scene& scene, const Layer& layer, int space) {
  std::vector<dvec3> positions;
  for (const int index : layer.parts) {
    const Part& part = scene.parts[index];
    const dmat4 space_from_part = ancestor_from_node(scene, space, part.node);
    for (const vec3& p : scene.meshes[part.mesh].positions) {
      positions.push_back(dvec3(space_from_part * dvec4(dvec3(p), 1)));
    }
  }
  return positions;
}

std::vector<dvec3> moved(const dmat4& target_from_source, std::vector<dvec3> points) {
  for (dvec3& p : points) p = dvec3(target_from_source * dvec4(p, 1));
  return points;
}

/// A node that was scaled to nothing has no axes of its own.
dmat4 axes_of(const SceneFrame& frame, int node) {
  if (node < 0) return dmat4(1.0);
  const dmat4& world_from_axes = frame.world_from_node[node];
  const double determinant = glm::determinant(world_from_axes);
  return std::isfinite(1 / determinant) ? world_from_axes : dmat4(1.0);
}

}  // namespace

std::span<const std::array<int, 3>> topology(BoundKind kind) { return topology_of(kind).triangles; }

std::span<const int> face_ends(BoundKind kind) { return topology_of(kind).face_ends; }

Polyhedron bounding_polyhedron(std::span<const dvec3> points, BoundKind kind) {
  if (points.empty() ||
      !std::all_of(points.begin(), points.end(), [](const dvec3& p) { return is_finite(p); }))
    return {};
  Box box;
  for (const dvec3& p : points) {
    box.lo = min(box.lo, p);
    box.hi = max(box.hi, p);
  }
  if (!is_finite(3.0 * box.size())) return {};  // the cuts would overflow
  Polyhedron result;
  result.points = vertices(box, cuts_for(points, box, kind), kind);
  append_topology(kind, 0, result);
  return result;
}

namespace {

/// A part as a layer of its own.
Layer alone(const Scene& scene, int part) {
  Layer layer;
  layer.parts = {part};
  layer.rigid_node = deforms(scene, scene.parts[part]) ? -1 : scene.parts[part].node;
  return layer;
}

int points_per_hull(BoundKind kind) { return kCorners * static_cast<int>(vertices_per_corner(kind).size()); }

/// Parts that move as one are one body; each that deforms by a skin or shape of its own is another.
std::vector<Layer> bodies_of(const Scene& scene, const Layer& layer) {
  const std::vector<int> carriers = moving_carriers(scene);
  std::map<std::array<int, 2>, std::size_t> body_of;  // by skin and carrier
  std::vector<Layer> bodies;
  for (const int index : layer.parts) {
    const Part& part = scene.parts[index];
    const bool is_rigid = !deforms(scene, part);
    const std::array key = is_rigid        ? std::array{-1, part.node < 0 ? -1 : carriers[part.node]}
                                  : part.skin < 0 ? std::array{-2, index}
                                           : std::array{part.skin, -1};
    const auto [it, is_new] = body_of.try_emplace(key, bodies.size());
    if (is_new) {
      bodies.push_back(alone(scene, index));
      continue;
    }
    Layer& body = bodies[it->second];
    body.parts.push_back(index);
    if (is_rigid) body.rigid_node = lowest_common_node(scene, body.rigid_node, part.node);
  }
  return bodies;
}

/// A layer of these of its parts.
Layer with_parts(const Scene& scene, const Layer& layer, bool seams) {
  Layer some = layer;
  std::erase_if(some.parts, [&](int part) { return scene.parts[part].is_seam != seams; });
  return some;
}

/// What is to have a polyhedron of its own; one: the whole layer.
std::vector<Layer> bounded_apart(const Scene& scene, const Layer& layer) {
  const std::optional<bool>& each_part = layer.preferences.bound_each_part;
  const bool moves_as_one = follows_rigid_node(scene, layer) || is_at_rest(scene, layer);
  if (layer.parts.size() < 2 || (each_part ? !*each_part : moves_as_one)) return {layer};
  if (!each_part) return bodies_of(scene, layer);
  std::vector<Layer> parts;
  for (const int part : layer.parts) parts.push_back(alone(scene, part));
  return parts;
}

/// One polyhedron around all parts.
LayerBound bound_of_whole(const Scene& scene, const Layer& layer, BoundKind kind, int material_points) {
  LayerBound bound;
  bound.kind = kind;
  bound.parts = layer.parts;
  bound.node = follows_rigid_node(scene, layer) ? layer.rigid_node : -1;
  bound.at_rest = bound.node < 0 && is_at_rest(scene, layer);
  if (bound.fixed()) {
    bound.hull = bounding_polyhedron(resting_positions(scene, layer, bound.node), kind);
  } else {
    bound.axes_node = common_node(scene, layer);
    bound.samples = spread_samples(scene, bound.parts, material_points, true);
  }
  if (bound.hull.triangles.empty()) append_topology(kind, 0, bound.hull);
  return bound;
}

bool has_vertices(const Scene& scene, const Layer& layer) {
  return std::any_of(layer.parts.begin(), layer.parts.end(),
                     [&](int part) { return !scene.meshes[scene.parts[part].mesh].positions.empty(); });
}

LayerBound bound_apart(const Scene& scene, const Layer& layer, BoundKind kind, int material_points,
                       const std::vector<Layer>& apart) {
  if (apart.size() == 1) return bound_of_whole(scene, layer, kind, material_points);
  LayerBound bound;
  bound.kind = kind;
  bound.parts = layer.parts;
  for (const Layer& body : apart) {
    if (!has_vertices(scene, body)) continue;
    append_topology(kind, static_cast<int>(bound.bodies.size()) * points_per_hull(kind), bound.hull);
    bound.bodies.push_back(bound_of_whole(scene, body, kind, material_points));
  }
  return bound;
}

}  // namespace

LayerBound make_layer_bound(const Scene& scene, const Layer& layer, BoundKind kind, int material_points) {
  if (!has_seams(scene, layer))
    return bound_apart(scene, layer, kind, material_points, bounded_apart(scene, layer));
  std::vector<Layer> apart = bounded_apart(scene, with_parts(scene, layer, false));
  apart.push_back(with_parts(scene, layer, true));
  return bound_apart(scene, layer, kind, material_points, apart);
}

void add_light_samples(const Scene& scene, int material_points, LayerBound& bound) {
  for (LayerBound& body : bound.bodies) add_light_samples(scene, material_points, body);
  if (bound.bodies.empty() && bound.samples.empty())
    bound.samples = spread_samples(scene, bound.parts, material_points, false);
}

int point_count(const LayerBound& bound) {
  if (bound.bodies.empty()) return points_per_hull(bound.kind);
  int count = 0;
  for (const LayerBound& body : bound.bodies) count += point_count(body);
  return count;
}

namespace {

/// Of a layer that deforms, or whose parts move against each other.
std::vector<dvec3> recomputed_points(const SceneFrame& frame, const LayerBound& bound) {
  std::vector<dvec3> positions;
  for (const int part : bound.parts) {
    const auto of_part = world_positions(frame, frame.scene->parts[part]);
    positions.insert(positions.end(), of_part.begin(), of_part.end());
  }
  const dmat4 world_from_axes = axes_of(frame, bound.axes_node);
  const auto in_axes = moved(inverse(world_from_axes), std::move(positions));
  return moved(world_from_axes, bounding_polyhedron(in_axes, bound.kind).points);
}

}  // namespace

void append_world_points(const SceneFrame& frame, const LayerBound& bound, std::vector<dvec3>& points) {
  const std::size_t before = points.size();
  for (const LayerBound& body : bound.bodies) {
    const std::size_t first = points.size();
    append_world_points(frame, body, points);
    if (points.size() > first) continue;
    points.resize(before);  // a part that is not finite: nothing can be said of the layer
    return;
  }
  if (!bound.bodies.empty()) return;
  if (!bound.fixed()) {
    const auto recomputed = recomputed_points(frame, bound);
    points.insert(points.end(), recomputed.begin(), recomputed.end());
    return;
  }
  points.insert(points.end(), bound.hull.points.begin(), bound.hull.points.end());
  if (bound.node < 0) return;
  TALISMAN_CHECK_LT(bound.node, static_cast<int>(frame.world_from_node.size()));
  const dmat4& world_from_node = frame.world_from_node[bound.node];
  for (std::size_t i = before; i < points.size(); ++i)
    points[i] = dvec3(world_from_node * dvec4(points[i], 1));
}

std::vector<dvec3> world_points(const SceneFrame& frame, const Layer&, const LayerBound& bound) {
  std::vector<dvec3> points;
  append_world_points(frame, bound, points);
  return points;
}

void append_world_from_bodies(const SceneFrame& frame, const LayerBound& bound, std::vector<dmat4>& frames) {
  if (bound.bodies.empty()) frames.push_back(axes_of(frame, bound.node >= 0 ? bound.node : bound.axes_node));
  for (const LayerBound& body : bound.bodies) append_world_from_bodies(frame, body, frames);
}

std::vector<dmat4> world_from_bodies(const SceneFrame& frame, const LayerBound& bound) {
  std::vector<dmat4> frames;
  append_world_from_bodies(frame, bound, frames);
  return frames;
}

}  // namespace talisman::layers
