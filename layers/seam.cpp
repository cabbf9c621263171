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

constexpr int kMostHalvings = 14;

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
  /// No side of it is longer than kHalvedTo reaches where it can be seen.
  bool is_small(const std::array<dvec3, 3>& triangle) const {
    return std::all_of(views_.begin(), views_.end(), [&](const CutView& view) {
      std::array<dvec2, 3> px;
      for (int k = 0; k < 3; ++k) {
        const dvec4 clip = view.clip_from_rest * dvec4(triangle[k], 1);
        if (!(clip.w > view.near_m)) return true;
        px[k] = screen_from_clip(clip, view.display_px);
      }
      for (int k = 0; k < 3; ++k)
        if (glm::length(px[k] - px[(k + 1) % 3]) > kHalvedTo * reach_px_) return false;
      return true;
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
    add_halved(own, kMostHalvings);
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

  void add_halved(const std::array<std::uint32_t, 3>& t, int halvings) {
    const std::array<dvec3, 3> at = {places_[t[0]], places_[t[1]], places_[t[2]]};
    const int held = held_[t[0]] + held_[t[1]] + held_[t[2]];
    if (held == 0) return;
    if (held == 3 || halvings == 0 || reach_.is_small(at)) {
      mesh_.indices.insert(mesh_.indices.end(), t.begin(), t.end());
      return;
    }
    int longest = 0;
    for (int k = 1; k < 3; ++k)
      if (glm::distance(at[k], at[(k + 1) % 3]) > glm::distance(at[longest], at[(longest + 1) % 3]))
        longest = k;
    const std::uint32_t a = t[longest], b = t[(longest + 1) % 3], c = t[(longest + 2) % 3], m = between(a, b);
    add_halved({a, m, c}, halvings - 1);
    add_halved({m, b, c}, halvings - 1);
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

  template <typename V>
  static void push_middle(std::vector<V>& values, std::uint32_t a, std::uint32_t b) {
    if (!values.empty()) values.push_back(0.5f * (values[a] + values[b]));
  }
  template <typename V>
  static V unit_or(const V& v, const V& otherwise) {
    const float length = glm::length(v);
    return length > 0 ? v / length : otherwise;
  }
  std::uint32_t between(std::uint32_t a, std::uint32_t b) {
    const auto [it, is_new] =
        middle_of_.emplace(std::minmax(a, b), static_cast<std::uint32_t>(places_.size()));
    if (!is_new) return it->second;
    const dvec3 middle = 0.5 * (places_[a] + places_[b]);
    note_place(middle, reach_.holds(middle));
    push_middle(mesh_.positions, a, b);
    if (!mesh_.normals.empty())
      mesh_.normals.push_back(unit_or(mesh_.normals[a] + mesh_.normals[b], mesh_.normals[a]));
    push_middle(mesh_.uvs, a, b);
    push_middle(mesh_.emissive_uvs, a, b);
    push_middle(mesh_.normal_uvs, a, b);
    if (!mesh_.tangents.empty()) {
      const vec3 sum = vec3(mesh_.tangents[a]) + vec3(mesh_.tangents[b]);
      mesh_.tangents.push_back(vec4(unit_or(sum, vec3(mesh_.tangents[a])), mesh_.tangents[a].w));
    }
    push_middle(mesh_.colors, a, b);
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
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle_of_;
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
