// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/factoring/pieces.h"

#include <algorithm>
#include <map>
#include <set>

#include "layers/animation.h"
#include "layers/glob.h"
#include "sequences/content/default_view.h"
#include "sequences/content/starter/part_globs.h"

namespace talisman::sequences {

namespace {

using layers::Layer;
using layers::LayerSpec;
using layers::WorldBounds;

/// Parts of one body touch: their boxes, in the space of what carries them, are no farther apart than this share of
/// the larger one's diagonal.
constexpr double kTouch = 0.05;

/// `kept` takes its parts first; the pieces are those of `own` that are left any.
Pieces pieces_between(const layers::Scene& scene, std::span<const LayerSpec> kept,
                      const std::vector<LayerSpec>& own) {
  std::vector<LayerSpec> specs(kept.begin(), kept.end());
  for (LayerSpec& spec : specs) spec.shading = {};
  specs.insert(specs.end(), own.begin(), own.end());
  for (std::size_t i = kept.size(); i < specs.size(); ++i) specs[i].name = "piece " + std::to_string(i);
  layers::LayerSet set = layers::factor(scene, specs);
  Pieces pieces;
  for (std::size_t i = 0; i < own.size(); ++i) {
    Layer& layer = set.layers[kept.size() + i];
    if (layer.parts.empty()) continue;
    layer.name = own[i].name;
    pieces.layers.push_back(std::move(layer));
  }
  pieces.free = pieces.layers.size();
  for (std::size_t i = 0; i < kept.size(); ++i) pieces.layers.push_back(std::move(set.layers[i]));
  for (std::size_t i = 0; i < pieces.layers.size(); ++i) pieces.layers[i].id = static_cast<int>(i);
  return pieces;
}

double diagonal_of(const WorldBounds& box) { return glm::length(box.hi - box.lo); }

bool touch(const WorldBounds& a, const WorldBounds& b) {
  const double reach = kTouch * std::max(diagonal_of(a), diagonal_of(b));
  for (int axis = 0; axis < 3; ++axis)
    if (a.lo[axis] - reach > b.hi[axis] || b.lo[axis] - reach > a.hi[axis]) return false;
  return true;
}

/// Boxes that are reached from each other by touching, as lists of their indices.
std::vector<std::vector<std::size_t>> touching(const std::vector<WorldBounds>& boxes) {
  std::vector<std::vector<std::size_t>> clusters;
  std::vector<bool> reached(boxes.size());
  for (std::size_t first = 0; first < boxes.size(); ++first) {
    if (reached[first]) continue;
    std::vector<std::size_t> cluster{first};
    reached[first] = true;
    for (std::size_t k = 0; k < cluster.size(); ++k)
      for (std::size_t i = 0; i < boxes.size(); ++i)
        if (!reached[i] && touch(boxes[cluster[k]], boxes[i])) reached[i] = true, cluster.push_back(i);
    clusters.push_back(std::move(cluster));
  }
  return clusters;
}

/// The moving node that all parts follow rigidly; -1: there is none.
int carrier_of(const layers::Scene& scene, const std::vector<int>& carriers, const std::vector<int>& parts) {
  const int carrier = carriers[scene.parts[parts[0]].node];
  for (const int part : parts)
    if (layers::deforms(scene, scene.parts[part]) || carriers[scene.parts[part].node] != carrier) return -1;
  return carrier;
}

/// Do all parts follow one moving node, and lie together?
bool is_one_body(const layers::SceneFrame& frame, const std::vector<int>& carriers,
                 const std::vector<int>& parts) {
  if (carrier_of(*frame.scene, carriers, parts) < 0) return false;
  std::vector<WorldBounds> boxes;
  for (const int part : parts) boxes.push_back(bounds_of_part(frame, frame.scene->parts[part]));
  return touching(boxes).size() == 1;
}

/// "leader" of leader/hull and leader/wing: the shortest beginning up to a "/" that these parts alone have; empty: none.
std::string common_node(const layers::Scene& scene, const std::vector<int>& parts) {
  const std::string& first = scene.parts[parts.front()].name;
  const auto begins = [&](int part, const std::string& with) {
    return scene.parts[part].name.rfind(with, 0) == 0;
  };
  for (std::size_t slash = first.find('/', 1); slash != std::string::npos;
       slash = first.find('/', slash + 1)) {
    const std::string beginning = first.substr(0, slash + 1);
    if (!std::all_of(parts.begin(), parts.end(), [&](int part) { return begins(part, beginning); }))
      return "";
    bool is_theirs = true;
    for (int part = 0; part < static_cast<int>(scene.parts.size()); ++part)
      is_theirs =
          is_theirs && (!begins(part, beginning) || std::binary_search(parts.begin(), parts.end(), part));
    if (is_theirs) return beginning.substr(0, slash);
  }
  return "";
}

/// Of a node that has just these parts; what they begin with; "wing", "wing and 3 more".
std::string name_of(const layers::Scene& scene, const Pieces& pieces, const std::vector<int>& group,
                    const std::vector<int>& parts, const Pieces& nodes) {
  for (std::size_t i = 0; i < nodes.free; ++i)
    if (nodes.layers[i].parts == parts && !nodes.layers[i].name.empty()) return nodes.layers[i].name;
  std::string common = group.size() > 1 ? common_node(scene, parts) : "";
  if (!common.empty()) return common;
  const int largest = *std::max_element(group.begin(), group.end(), [&](int a, int b) {
    return pieces.layers[a].polygons < pieces.layers[b].polygons;
  });
  const std::string& name = scene.parts[pieces.layers[largest].parts.front()].name;
  return group.size() == 1 ? name : name + " and " + std::to_string(group.size() - 1) + " more";
}

}  // namespace

Pieces pieces_of(const layers::Scene& scene, std::span<const LayerSpec> kept) {
  std::vector<LayerSpec> own;
  std::set<std::string> seen;
  for (const layers::Part& part : scene.parts)
    if (seen.insert(part.name).second) own.emplace_back().part_globs = {layers::glob_of_name(part.name)};
  return pieces_between(scene, kept, own);
}

Pieces node_pieces_of(const layers::Scene& scene, std::span<const LayerSpec> kept,
                      const std::vector<LayerSpec>& nodes) {
  if (!nodes.empty()) return pieces_between(scene, kept, nodes);
  const Pieces pieces = pieces_of(scene, kept);
  layers::Scene own;  // what says how nodes belong together
  own.nodes = scene.nodes;
  own.tracks = scene.tracks;
  own.skins = scene.skins;
  own.meshes = scene.meshes;
  int last = -1;
  for (std::size_t i = 0; i < pieces.free; ++i)
    for (const int part : pieces.layers[i].parts) {
      own.parts.push_back(scene.parts[part]);
      last = std::max(last, scene.parts[part].node);
    }
  for (const layers::Skin& skin : own.skins)
    for (const int joint : skin.joints) last = std::max(last, joint);
  own.nodes.resize(static_cast<std::size_t>(last) + 1);
  std::erase_if(own.tracks, [&](const layers::Track& track) { return track.node > last; });
  return pieces_between(scene, kept, layers::default_layer_specs(own));
}

std::vector<std::vector<int>> bodies_of(const layers::Scene& scene, const Pieces& pieces) {
  const std::vector<int> carriers = layers::moving_carriers(scene);
  const layers::SceneFrame frame = scene.at(0);
  std::map<int, std::vector<int>> carried;
  std::vector<std::vector<int>> bodies;
  for (int piece = 0; piece < static_cast<int>(pieces.free); ++piece) {
    const int carrier = carrier_of(scene, carriers, pieces.layers[piece].parts);
    if (carrier < 0)
      bodies.push_back({piece});
    else
      carried[carrier].push_back(piece);
  }
  for (const auto& [carrier, of] : carried) {
    std::vector<WorldBounds> boxes;
    for (const int piece : of) {
      WorldBounds box;
      for (const int part : pieces.layers[piece].parts)
        include(box, bounds_of_part(frame, scene.parts[part]));
      boxes.push_back(box);
    }
    for (const std::vector<std::size_t>& cluster : touching(boxes)) {
      std::vector<int>& body = bodies.emplace_back();
      for (const std::size_t i : cluster) body.push_back(of[i]);
      std::sort(body.begin(), body.end());
    }
  }
  std::sort(bodies.begin(), bodies.end());
  return bodies;
}

std::vector<LayerSpec> specs_of_groups(const layers::Scene& scene, std::span<const LayerSpec> kept,
                                       const Pieces& pieces, const std::vector<std::vector<int>>& groups,
                                       const Pieces& nodes) {
  std::vector<Layer> taking(pieces.layers.begin() + static_cast<std::ptrdiff_t>(pieces.free),
                            pieces.layers.end());
  const std::size_t others = taking.size();
  for (const std::vector<int>& group : groups) {
    Layer layer;
    for (const int piece : group)
      layer.parts.insert(layer.parts.end(), pieces.layers[piece].parts.begin(),
                         pieces.layers[piece].parts.end());
    std::sort(layer.parts.begin(), layer.parts.end());
    taking.push_back(std::move(layer));
  }
  std::vector<std::string> names;
  for (const layers::Part& part : scene.parts) names.push_back(part.name);
  const std::vector<std::vector<std::string>> globs = part_globs(taking, names);

  const layers::SceneFrame frame = scene.at(0);
  const std::vector<int> carriers = layers::moving_carriers(scene);
  std::set<std::string> used;
  for (const LayerSpec& spec : kept) used.insert(spec.name);
  std::vector<LayerSpec> specs;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const std::vector<int>& parts = taking[others + i].parts;
    LayerSpec spec;
    spec.name = unused_name(used, name_of(scene, pieces, groups[i], parts, nodes));
    used.insert(spec.name);
    spec.part_globs = globs[others + i];
    if (parts.size() > 1 && !is_one_body(frame, carriers, parts)) spec.preferences.bound_each_part = true;
    specs.push_back(std::move(spec));
  }
  return specs;
}

}  // namespace talisman::sequences
