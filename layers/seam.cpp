// SPDX-License-Identifier: Apache-2.0
#include "layers/seam.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "layers/animation.h"
#include "layers/state.h"

namespace talisman::layers {
namespace {

using WeldedPlace = std::array<std::int64_t, 3>;
using EdgeKey = std::pair<WeldedPlace, WeldedPlace>;
using TriangleKey = std::array<WeldedPlace, 3>;

constexpr int kMostHalvings = 8;
constexpr int kCutSteps = 12;

/// Positions that are one place have one key.
class WeldedPlaces {
 public:
  explicit WeldedPlaces(double size_m) : step_(std::max(size_m, 1e-9) * kSameplace) {}
  WeldedPlace of(const dvec3& p) const {
    // Not at whole numbers: there a rounding would tell apart what is one.
    const auto key = [this](double x) { return static_cast<std::int64_t>(std::floor(x / step_ + 0.37)); };
    return {key(p.x), key(p.y), key(p.z)};
  }

 private:
  double step_;
};

EdgeKey edge_key(const WeldedPlace& a, const WeldedPlace& b) { return a < b ? EdgeKey{a, b} : EdgeKey{b, a}; }

/// A part that may share edges, at time 0.
struct RigidPart {
  int index = -1, layer = -1, carrier = -1;
  std::vector<dvec3> positions;  ///< world
  std::vector<WeldedPlace> places;
};

bool is_opaque(const Scene& scene, const Part& part) {
  if (part.material < 0) return true;
  const Material& material = scene.materials[part.material];
  const bool see_through = material.texture >= 0 && scene.textures[material.texture].has_alpha;
  return material.opacity == 1 && !see_through && scene.meshes[part.mesh].alphas.empty();
}

std::vector<RigidPart> rigid_parts(const Scene& scene, const LayerSet& set) {
  const SceneFrame frame = scene.at(0);
  const std::vector<int> carriers = moving_carriers(scene);
  std::vector<RigidPart> parts;
  dvec3 lo(HUGE_VAL), hi(-HUGE_VAL);
  for (const Layer& layer : set.layers) {
    if (layer.base >= 0 || layer.is_aggregate()) continue;
    for (const int index : layer.parts) {
      const Part& part = scene.parts[index];
      if (part.is_seam || part.node < 0 || deforms(scene, part) || !is_opaque(scene, part)) continue;
      parts.push_back({index, layer.id, carriers[part.node], world_positions(frame, part), {}});
      for (const dvec3& p : parts.back().positions) lo = glm::min(lo, p), hi = glm::max(hi, p);
    }
  }
  if (parts.empty()) return parts;
  const WeldedPlaces places(glm::length(hi - lo));
  for (RigidPart& part : parts)
    for (const dvec3& p : part.positions) part.places.push_back(places.of(p));
  return parts;
}

std::array<std::uint32_t, 3> corners_of_triangle(const Mesh& mesh, std::size_t triangle) {
  return {mesh.indices[3 * triangle], mesh.indices[3 * triangle + 1], mesh.indices[3 * triangle + 2]};
}

/// A triangle of a part beside an edge.
struct EdgeUse {
  const RigidPart* part = nullptr;
  std::array<std::uint32_t, 2> ends{};
};

using EdgeMap = std::map<EdgeKey, std::vector<EdgeUse>>;

EdgeMap edges_with_uses(const Scene& scene, const std::vector<RigidPart>& parts) {
  EdgeMap edges;
  for (const RigidPart& part : parts) {
    const Mesh& mesh = scene.meshes[scene.parts[part.index].mesh];
    for (int t = 0; t < mesh.triangle_count(); ++t) {
      const auto corner = corners_of_triangle(mesh, t);
      for (int k = 0; k < 3; ++k) {
        const std::array<std::uint32_t, 2> ends = {corner[k], corner[(k + 1) % 3]};
        const WeldedPlace &a = part.places[ends[0]], &b = part.places[ends[1]];
        if (a != b) edges[edge_key(a, b)].push_back({&part, ends});
      }
    }
  }
  return edges;
}

int uses_by(const std::vector<EdgeUse>& uses, int layer) {
  return static_cast<int>(std::count_if(uses.begin(), uses.end(),
                                        [layer](const EdgeUse& use) { return use.part->layer == layer; }));
}

// --- Reach ---

/// The shared edges of one cut on the display in all frames that are looked at.
struct CutView {
  dmat4 clip_from_rest;  ///< of what the cut's carrier carries, from where it is at time 0
  double near_m = 0;
  ivec2 display_px{0, 0};
  std::vector<ScreenEdge> edges;
  RectD bounds_px;  ///< of the edges
};

double distance_px(const dvec2& p, const ScreenEdge& edge) {
  const dvec2 along = edge.b_px - edge.a_px;
  const double length2 = glm::dot(along, along);
  const double t = length2 > 0 ? std::clamp(glm::dot(p - edge.a_px, along) / length2, 0.0, 1.0) : 0;
  return glm::length(p - (edge.a_px + t * along));
}

/// The display is taken a tenth larger: a sprite that is carried into view was drawn before.
bool is_near_display(const dvec2& a, const dvec2& b, ivec2 display_px) {
  const dvec2 margin = 0.1 * dvec2(display_px);
  return std::max(a.x, b.x) > -margin.x && std::min(a.x, b.x) < display_px.x + margin.x &&
         std::max(a.y, b.y) > -margin.y && std::min(a.y, b.y) < display_px.y + margin.y;
}

ScreenEdge project(const dmat4& clip_from_rest, const SharedEdge& edge, double near_m, ivec2 display_px) {
  dvec4 a = clip_from_rest * dvec4(edge.a, 1), b = clip_from_rest * dvec4(edge.b, 1);
  if (a.w < b.w) std::swap(a, b);
  if (!(a.w > near_m)) return {};
  if (b.w < near_m) b = a + (a.w - near_m) / (a.w - b.w) * (b - a);
  const ScreenEdge on_screen{screen_from_clip(a, display_px), screen_from_clip(b, display_px), true};
  return {on_screen.a_px, on_screen.b_px, is_near_display(on_screen.a_px, on_screen.b_px, display_px)};
}

dmat4 rest_to_now(const SceneFrame& frame, const std::vector<dmat4>& world_at_0, int carrier) {
  return carrier < 0 ? dmat4(1) : frame.world_from_node[carrier] * glm::inverse(world_at_0[carrier]);
}

/// What decides whether a place is reached: the smallest distance on the display in any frame.
class Reach {
 public:
  Reach(std::vector<CutView> views, double reach_px) : views_(std::move(views)), reach_px_(reach_px) {}

  bool holds(const dvec3& p) const {
    return std::any_of(views_.begin(), views_.end(), [&](const CutView& view) {
      const dvec4 clip = view.clip_from_rest * dvec4(p, 1);
      if (!(clip.w > view.near_m)) return false;
      const dvec2 px = screen_from_clip(clip, view.display_px);
      const RectD& near_cut = view.bounds_px;
      if (px.x < near_cut.lo.x - reach_px_ || px.x > near_cut.hi.x + reach_px_ ||
          px.y < near_cut.lo.y - reach_px_ || px.y > near_cut.hi.y + reach_px_)
        return false;
      return std::any_of(view.edges.begin(), view.edges.end(),
                         [&](const ScreenEdge& edge) { return distance_px(px, edge) <= reach_px_; });
    });
  }
  bool is_ever_in_view() const { return !views_.empty(); }

 private:
  std::vector<CutView> views_;
  double reach_px_;
};

// --- Pieces ---

/// A mesh that grows by vertices of another and by those between them.
class PieceBuilder {
 public:
  PieceBuilder(const Mesh& from, const std::vector<dvec3>& world, const Reach& reach)
      : from_(from), world_(world), reach_(reach), from_held_(world.size(), kUnknown) {}

  /// Adds what of the triangle is in reach.
  void add(const std::array<std::uint32_t, 3>& triangle) {
    if (!std::any_of(triangle.begin(), triangle.end(), [&](std::uint32_t v) { return holds_given(v); }))
      return;
    std::array<std::uint32_t, 3> own;
    for (int k = 0; k < 3; ++k) own[k] = copied(triangle[k]);
    add_cut(own, kMostHalvings);
  }
  bool empty() const { return mesh_.indices.empty(); }
  Mesh take() { return std::move(mesh_); }

 private:
  static constexpr char kUnknown = 2;

  bool holds_given(std::uint32_t vertex) {
    char& held = from_held_[vertex];
    if (held == kUnknown) held = static_cast<char>(reach_.holds(world_[vertex]));
    return held != 0;
  }
  void note_place(const dvec3& place, bool is_held) {
    places_.push_back(place);
    held_.push_back(static_cast<char>(is_held));
  }

  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh_.indices.insert(mesh_.indices.end(), {a, b, c});
  }

  /// Adds what of the triangle is in reach: all, or up to a line between two of its sides.
  void add_cut(std::array<std::uint32_t, 3> t, int halvings) {
    const int held = held_[t[0]] + held_[t[1]] + held_[t[2]];
    if (held == 0) return;
    if (held == 3) return add_triangle(t[0], t[1], t[2]);
    // Turned so that the first corner is the one that differs from the other two.
    while ((held == 1) != (held_[t[0]] != 0)) std::rotate(t.begin(), t.begin() + 1, t.end());
    const auto [a, b, c] = t;
    const std::uint32_t on_b = held == 1 ? cut(a, b) : cut(b, a), on_c = held == 1 ? cut(a, c) : cut(c, a);
    if (halvings > 0 && reach_.holds(0.5 * (places_[on_b] + places_[on_c]))) return halve(t, halvings - 1);
    if (held == 1) return add_triangle(a, on_b, on_c);
    add_triangle(b, c, on_c);
    add_triangle(b, on_c, on_b);
  }

  void halve(const std::array<std::uint32_t, 3>& t, int halvings) {
    int longest = 0;
    const auto length = [&](int k) { return glm::distance(places_[t[k]], places_[t[(k + 1) % 3]]); };
    for (int k = 1; k < 3; ++k)
      if (length(k) > length(longest)) longest = k;
    const std::uint32_t a = t[longest], b = t[(longest + 1) % 3], c = t[(longest + 2) % 3];
    const std::uint32_t m = between(std::min(a, b), std::max(a, b), 0.5, middle_of_);
    add_cut({a, m, c}, halvings);
    add_cut({m, b, c}, halvings);
  }

  /// Where on the way from a corner in reach to one that is not the reach ends; just beyond.
  std::uint32_t cut(std::uint32_t inside, std::uint32_t outside) {
    double in = 0, out = 1;
    for (int k = 0; k < kCutSteps; ++k) {
      const double middle = 0.5 * (in + out);
      (reach_.holds(glm::mix(places_[inside], places_[outside], middle)) ? in : out) = middle;
    }
    return between(inside, outside, out, cut_of_);
  }

  template <typename Array>
  static void copy_one(const Array& from, std::uint32_t vertex, Array& to) {
    if (!from.empty()) to.push_back(from[vertex]);
  }
  std::uint32_t copied(std::uint32_t vertex) {
    const auto [it, is_new] = copy_of_.emplace(vertex, static_cast<std::uint32_t>(places_.size()));
    if (!is_new) return it->second;
    note_place(world_[vertex], holds_given(vertex));
    copy_one(from_.positions, vertex, mesh_.positions);
    copy_one(from_.normals, vertex, mesh_.normals);
    copy_one(from_.uvs, vertex, mesh_.uvs);
    copy_one(from_.emissive_uvs, vertex, mesh_.emissive_uvs);
    copy_one(from_.normal_uvs, vertex, mesh_.normal_uvs);
    copy_one(from_.tangents, vertex, mesh_.tangents);
    copy_one(from_.colors, vertex, mesh_.colors);
    return it->second;
  }

  using BetweenTwo = std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>;

  template <typename V>
  static V unit_or(const V& v, const V& otherwise) {
    const float length = glm::length(v);
    return length > 0 ? v / length : otherwise;
  }
  /// The vertex at the share `t` of the way from a to b; made once for each of `known`.
  std::uint32_t between(std::uint32_t a, std::uint32_t b, double t, BetweenTwo& known) {
    const auto [it, is_new] = known.emplace(std::pair(a, b), static_cast<std::uint32_t>(places_.size()));
    if (!is_new) return it->second;
    const auto push = [a, b, share = static_cast<float>(t)](auto& values) {
      if (!values.empty()) values.push_back((1 - share) * values[a] + share * values[b]);
    };
    const dvec3 place = glm::mix(places_[a], places_[b], t);
    note_place(place, reach_.holds(place));
    for (auto* values : {&mesh_.positions, &mesh_.normals, &mesh_.colors}) push(*values);
    for (auto* values : {&mesh_.uvs, &mesh_.emissive_uvs, &mesh_.normal_uvs}) push(*values);
    push(mesh_.tangents);
    if (!mesh_.normals.empty()) mesh_.normals.back() = unit_or(mesh_.normals.back(), mesh_.normals[a]);
    if (!mesh_.tangents.empty()) {
      const vec3 along = unit_or(vec3(mesh_.tangents.back()), vec3(mesh_.tangents[a]));
      mesh_.tangents.back() = vec4(along, mesh_.tangents[a].w);
    }
    return it->second;
  }

  const Mesh& from_;
  const std::vector<dvec3>& world_;
  const Reach& reach_;
  std::vector<char> from_held_;  ///< is a vertex that is given in reach?
  Mesh mesh_;
  std::vector<dvec3> places_;  ///< world, of each vertex
  std::vector<char> held_;     ///< likewise: is it in reach?
  std::map<std::uint32_t, std::uint32_t> copy_of_;
  BetweenTwo middle_of_, cut_of_;
};

TriangleKey triangle_key(const RigidPart& part, const std::array<std::uint32_t, 3>& corner) {
  TriangleKey key = {part.places[corner[0]], part.places[corner[1]], part.places[corner[2]]};
  std::sort(key.begin(), key.end());
  return key;
}

/// Triangles that a layer has itself.
std::set<TriangleKey> triangles_of(const Scene& scene, const std::vector<RigidPart>& parts, int layer) {
  std::set<TriangleKey> keys;
  for (const RigidPart& part : parts) {
    if (part.layer != layer) continue;
    const Mesh& mesh = scene.meshes[scene.parts[part.index].mesh];
    for (int t = 0; t < mesh.triangle_count(); ++t)
      keys.insert(triangle_key(part, corners_of_triangle(mesh, t)));
  }
  return keys;
}

/// Frames that are looked at: all, or kMostViews of them from the first to the last.
std::vector<int> frames_looked_at(int frames) {
  std::vector<int> chosen;
  const int count = std::min(frames, kMostViews);
  for (int k = 0; k < count; ++k)
    chosen.push_back(count > 1 ? static_cast<int>(std::int64_t{k} * (frames - 1) / (count - 1)) : 0);
  return chosen;
}

std::vector<CutView> views_of_cut(const std::vector<SceneFrame>& frames, const std::vector<dmat4>& world_at_0,
                                  const std::vector<SharedEdge>& cut, ivec2 display_px) {
  std::vector<CutView> views;
  for (const SceneFrame& frame : frames) {
    CutView view{
        clip_from_world(frame.camera, display_px) * rest_to_now(frame, world_at_0, cut.front().carrier),
        frame.camera.near_m,
        display_px,
        {},
        {}};
    for (const SharedEdge& edge : cut)
      view.edges.push_back(project(view.clip_from_rest, edge, view.near_m, display_px));
    std::erase_if(view.edges, [](const ScreenEdge& edge) { return !edge.in_view; });
    for (const ScreenEdge& edge : view.edges) {
      view.bounds_px.include(edge.a_px);
      view.bounds_px.include(edge.b_px);
    }
    if (!view.edges.empty()) views.push_back(std::move(view));
  }
  return views;
}

}  // namespace

bool has_seams(const Scene& scene, const Layer& layer) {
  return std::any_of(layer.parts.begin(), layer.parts.end(),
                     [&](int part) { return scene.parts[part].is_seam; });
}

std::vector<SharedEdge> shared_edges(const Scene& scene, const LayerSet& set) {
  const std::vector<RigidPart> parts = rigid_parts(scene, set);
  std::vector<SharedEdge> shared;
  for (const auto& [key, uses] : edges_with_uses(scene, parts)) {
    std::set<std::pair<int, int>> seen;  // layer, part beyond
    for (const EdgeUse& own : uses) {
      if (uses_by(uses, own.part->layer) != 1) continue;  // not at its rim
      for (const EdgeUse& other : uses) {
        if (other.part->layer == own.part->layer || other.part->carrier != own.part->carrier) continue;
        if (!seen.emplace(own.part->layer, other.part->index).second) continue;
        shared.push_back({own.part->layer, other.part->layer, other.part->index,
                          own.part->positions[own.ends[0]], own.part->positions[own.ends[1]],
                          own.part->carrier});
      }
    }
  }
  return shared;
}

ScreenEdge screen_edge(const SceneFrame& frame, const SharedEdge& edge, const std::vector<dmat4>& world_at_0,
                       ivec2 display_px) {
  return project(clip_from_world(frame.camera, display_px) * rest_to_now(frame, world_at_0, edge.carrier),
                 edge, frame.camera.near_m, display_px);
}

double seam_reach_px(const Layer& layer, const SeamOptions& options) {
  const double importance = std::max(layer.preferences.importance.geometric, kLeastImportance);
  return options.geometric_px / importance + kFilter_px / std::min(layer.preferences.resolution_scale, 1.0);
}

std::vector<SeamPiece> seam_pieces(const Scene& scene, const LayerSet& set, const SeamOptions& options) {
  std::map<std::pair<int, int>, std::vector<SharedEdge>> cuts;  // by layer and part beyond
  for (const SharedEdge& edge : shared_edges(scene, set)) cuts[{edge.layer, edge.part}].push_back(edge);
  if (cuts.empty()) return {};
  const std::vector<RigidPart> parts = rigid_parts(scene, set);
  const std::vector<dmat4> world_at_0 = scene.at(0).world_from_node;
  std::vector<SceneFrame> frames;
  for (const int frame : frames_looked_at(options.frames)) frames.push_back(scene.at(frame / options.fps));
  std::vector<SeamPiece> pieces;
  for (const auto& [ends, cut] : cuts) {
    const auto [layer, index] = ends;
    const Reach reach(views_of_cut(frames, world_at_0, cut, options.display_px),
                      seam_reach_px(set.layers[layer], options));
    if (!reach.is_ever_in_view()) continue;
    const RigidPart& beyond = *std::find_if(parts.begin(), parts.end(),
                                            [i = index](const RigidPart& part) { return part.index == i; });
    const std::set<TriangleKey> own = triangles_of(scene, parts, layer);
    const Mesh& mesh = scene.meshes[scene.parts[index].mesh];
    PieceBuilder builder(mesh, beyond.positions, reach);
    for (int t = 0; t < mesh.triangle_count(); ++t)
      if (const auto corner = corners_of_triangle(mesh, t); own.count(triangle_key(beyond, corner)) == 0)
        builder.add(corner);
    if (builder.empty()) continue;
    SeamPiece piece{layer, builder.take(), scene.parts[index]};
    piece.part.name = "seam of " + set.layers[layer].name + " over " + scene.parts[index].name;
    for (char& c : piece.part.name)
      if (c == '*' || c == '?') c = '_';  // it is taken by its name, no glob
    piece.part.is_seam = true;
    piece.mesh.name = piece.part.name;
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

}  // namespace talisman::layers
