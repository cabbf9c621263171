// SPDX-License-Identifier: Apache-2.0
#include "layers/layer.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <unordered_map>

#include "layers/animation.h"
#include "layers/glob.h"
#include "layers/shading.h"

namespace talisman::layers {

namespace {

/// Which parts a glob takes. Globs without wildcards are looked up, so that thousands of layers of one part
/// stay cheap.
class PartNames {
 public:
  explicit PartNames(const Scene& scene) : scene_(scene) {
    for (std::size_t i = 0; i < scene.parts.size(); ++i)
      if (!scene.parts[i].is_level) by_name_[scene.parts[i].name].push_back(static_cast<int>(i));
  }

  std::vector<int> matching(const std::string& glob) const {
    if (!has_wildcard(glob)) {
      const auto found = by_name_.find(name_of_glob(glob));
      return found == by_name_.end() ? std::vector<int>{} : found->second;
    }
    std::vector<int> parts;
    for (std::size_t i = 0; i < scene_.parts.size(); ++i)
      if (!scene_.parts[i].is_seam && !scene_.parts[i].is_level &&  // seams by their names alone
          glob_matches(glob, scene_.parts[i].name))
        parts.push_back(static_cast<int>(i));
    return parts;
  }

 private:
  const Scene& scene_;
  std::unordered_map<std::string, std::vector<int>> by_name_;
};

/// Deepest node at or above both; -1: none. A parent's index is below its children's.
int common_ancestor(const Scene& scene, int a, int b) {
  while (a != b) (a > b ? a : b) = scene.nodes.at(std::max(a, b)).parent;
  return a;
}

int rigid_node_of(const Scene& scene, const std::vector<int>& parts, const std::vector<int>& carriers) {
  if (parts.empty()) return -1;
  const int first = scene.parts[parts[0]].node;
  int common = first;
  for (const int part : parts) {
    const int node = scene.parts[part].node;
    if (deforms(scene, scene.parts[part]) || carriers.at(node) != carriers.at(first)) return -1;
    common = common_ancestor(scene, common, node);
  }
  return common >= 0 ? common : first;  // trees that all stand still: any of their nodes will do
}

std::string out_of_range(const char* what, double value, const char* rule) {
  std::ostringstream out;
  out << what << " is " << value << ", rule: " << rule;
  return out.str();
}

std::string preferences_defect(const LayerPreferences& p) {
  const FiducialWeights& w = p.importance;
  for (const double weight : {w.geometric, w.photometric, w.sampling, w.visibility})
    if (!(weight >= 0 && std::isfinite(weight)))
      return out_of_range("importance", weight, "finite, at least 0");
  if (!(p.resolution_scale > 0 && p.resolution_scale <= 4))
    return out_of_range("resolution_scale", p.resolution_scale, "above 0, at most 4");
  if (!(p.max_update_rate > 0 && p.max_update_rate <= 1))
    return out_of_range("max_update_rate", p.max_update_rate, "above 0, at most 1");
  if (!(p.min_update_rate >= 0 && p.min_update_rate <= p.max_update_rate))
    return out_of_range("min_update_rate", p.min_update_rate, "at least 0, at most max_update_rate");
  if (!(p.share_of_expected_motion >= 0 && std::isfinite(p.share_of_expected_motion)))
    return out_of_range("share_of_expected_motion", p.share_of_expected_motion, "finite, at least 0");
  if (!(p.motion_blur >= 0 && p.motion_blur <= 1))
    return out_of_range("motion_blur", p.motion_blur, "at least 0, at most 1");
  return {};
}

std::string multiplier_defect(const char* what, const Keys<double>& keys) {
  for (const double value : keys.values)
    if (!(value >= 0 && value <= 1)) return out_of_range(what, value, "0 to 1");
  return {};
}

/// First broken rule of what the author wrote, whatever the scene.
std::string spec_defect(const LayerSpec& spec) {
  const ShadingSpec& shading = spec.shading;
  std::string defect = preferences_defect(spec.preferences);
  for (const auto* term : {&shading.shadows, &shading.specular, &shading.reflection, &shading.textures})
    if (defect.empty() && *term) defect = preferences_defect(**term);
  if (defect.empty() && shading.textures && shading.shadows_as == ShadowsAs::Multiply)
    defect = "shadows as multiply hold for one blend of textures, rule: not together with textures";
  if (defect.empty()) defect = multiplier_defect("fade", spec.fade);
  if (defect.empty()) defect = multiplier_defect("blend", shading.first_blend);
  if (defect.empty()) defect = multiplier_defect("blend", shading.second_blend);
  return defect;
}

/// Takes the free parts that the spec's globs match. The defect is without the layer's name.
struct Taken {
  std::vector<int> parts;
  std::string defect;
};

Taken take_parts(const LayerSpec& spec, const PartNames& names, std::vector<bool>& taken) {
  Taken result;
  for (const std::string& glob : spec.part_globs) {
    const std::vector<int> matching = names.matching(glob);
    if (matching.empty() && result.defect.empty()) result.defect = "part glob '" + glob + "' matches no part";
    for (const int part : matching) {
      if (taken[part]) continue;
      taken[part] = true;
      result.parts.push_back(part);
    }
  }
  if (result.parts.empty() && result.defect.empty())
    result.defect =
        spec.part_globs.empty() ? "has no part globs" : "has no parts left, earlier layers took them all";
  std::sort(result.parts.begin(), result.parts.end());
  return result;
}

int polygons_of(const Scene& scene, const std::vector<int>& parts) {
  int polygons = 0;
  for (const int part : parts) polygons += scene.meshes.at(scene.parts[part].mesh).triangle_count();
  return polygons;
}

// --- Layers for bare models ---

/// The node below which `node` lies (or which it is) at the top level: the first level of the trees at which
/// there is more than one node, or a part. Files often have one root, or a chain of them, that only holds the
/// rest together.
class TopLevel {
 public:
  explicit TopLevel(const Scene& scene) : top_(scene.nodes.size(), -1) {
    const int hub = last_of_chain(scene);
    for (std::size_t i = 0; i < top_.size(); ++i) {
      const int parent = scene.nodes[i].parent;
      top_[i] = parent < 0 || parent == hub ? static_cast<int>(i) : top_.at(parent);
    }
  }
  int of(int node) const { return top_.at(node); }

 private:
  /// The last node of the chain of only children that starts at an only root and carries no part; -1: none.
  static int last_of_chain(const Scene& scene) {
    std::vector<int> children(scene.nodes.size() + 1, 0), last_child(scene.nodes.size() + 1, -1);
    std::vector<bool> carries(scene.nodes.size(), false);
    for (const Part& part : scene.parts) carries.at(part.node) = true;
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
      ++children[scene.nodes[i].parent + 1];
      last_child[scene.nodes[i].parent + 1] = static_cast<int>(i);
    }
    int node = -1;
    while (children[node + 1] == 1 && !carries[last_child[node + 1]]) node = last_child[node + 1];
    return node;
  }

  std::vector<int> top_;
};

/// What moves a part, and the node that gives its layer a name. Skinned parts of one figure often have a skin
/// each, so they are put together by the top-level node of their joints.
struct Mover {
  enum class Kind { Rest, Rigid, Skinned } kind;
  int node;
  auto operator<=>(const Mover&) const = default;
};

Mover mover_of(const Scene& scene, const Part& part, const std::vector<int>& carriers, const TopLevel& top) {
  if (part.skin >= 0 && !scene.skins.at(part.skin).joints.empty())
    return {Mover::Kind::Skinned, top.of(scene.skins[part.skin].joints[0])};
  if (deforms(scene, part)) return {Mover::Kind::Rigid, part.node};
  const int carrier = carriers.at(part.node);
  return carrier >= 0 ? Mover{Mover::Kind::Rigid, carrier} : Mover{Mover::Kind::Rest, top.of(part.node)};
}

std::string unused_name(const Scene& scene, int node, std::set<std::string>& used) {
  const std::string& own = scene.nodes[node].name;
  const std::string base = own.empty() ? "node " + std::to_string(node) : own;
  std::string name = base;
  for (int k = 2; !used.insert(name).second; ++k) name = base + "#" + std::to_string(k);
  return name;
}

}  // namespace

LayerSet factor(const Scene& scene, std::span<const LayerSpec> specs) {
  const PartNames names(scene);
  const std::vector<int> carriers = moving_carriers(scene);
  std::vector<bool> taken(scene.parts.size(), false);
  std::set<std::string> used;
  LayerSet set;
  for (const LayerSpec& spec : specs) {
    Taken found = take_parts(spec, names, taken);
    std::string defect = found.defect.empty() ? spec_defect(spec) : found.defect;
    if (!used.insert(spec.name).second) defect = "name is used twice, rule: unique";
    if (!defect.empty() && set.defect.empty()) set.defect = "layer '" + spec.name + "': " + defect;
    Layer layer;
    layer.id = static_cast<int>(set.layers.size());
    layer.name = spec.name;
    layer.parts = std::move(found.parts);
    layer.group = spec.group;
    layer.preferences = spec.preferences;
    layer.fade = spec.fade;
    layer.polygons = polygons_of(scene, layer.parts);
    layer.rigid_node = rigid_node_of(scene, layer.parts, carriers);
    set.layers.push_back(std::move(layer));
  }
  add_shade_layers(scene, specs, set);
  set.unassigned_parts = static_cast<int>(std::count(taken.begin(), taken.end(), false));
  return set;
}

std::vector<LayerSpec> default_layer_specs(const Scene& scene) {
  const std::vector<int> carriers = moving_carriers(scene);
  const TopLevel top(scene);
  std::map<Mover, std::size_t> group_of;
  std::vector<std::pair<Mover, std::vector<int>>> groups;  // in the order of their first parts
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    const Mover mover = mover_of(scene, scene.parts[i], carriers, top);
    const auto [found, is_new] = group_of.emplace(mover, groups.size());
    if (is_new) groups.push_back({mover, {}});
    groups[found->second].second.push_back(static_cast<int>(i));
  }
  // Parts of equal names cannot be told apart by globs: they go to the first group that takes one of them.
  const PartNames names(scene);
  std::vector<bool> taken(scene.parts.size(), false);
  std::set<std::string> used;
  std::vector<LayerSpec> specs;
  for (const auto& [mover, parts] : groups) {
    LayerSpec spec;
    for (const int part : parts)
      if (!taken[part]) spec.part_globs.push_back(glob_of_name(scene.parts[part].name));
    if (take_parts(spec, names, taken).parts.empty()) continue;
    spec.name = unused_name(scene, mover.node, used);
    specs.push_back(std::move(spec));
  }
  return specs;
}

}  // namespace talisman::layers
