// SPDX-License-Identifier: Apache-2.0
#include "layers/aggregate.h"

#include <algorithm>

#include "layers/check.h"

namespace talisman::layers {

namespace {

FiducialWeights strictest(const FiducialWeights& a, const FiducialWeights& b) {
  return {std::max(a.geometric, b.geometric), std::max(a.photometric, b.photometric),
          std::max(a.sampling, b.sampling), std::max(a.visibility, b.visibility)};
}

/// A member that must be sharp or fresh makes all of them so; one that may be drawn at any time is not held
/// back by one that may not.
LayerPreferences strictest(LayerPreferences a, const LayerPreferences& b) {
  a.importance = strictest(a.importance, b.importance);
  a.resolution_scale = std::max(a.resolution_scale, b.resolution_scale);
  a.min_update_rate = std::max(a.min_update_rate, b.min_update_rate);
  a.max_update_rate = std::max(a.max_update_rate, b.max_update_rate);
  a.share_of_expected_motion = std::max(a.share_of_expected_motion, b.share_of_expected_motion);
  a.motion_blur = std::min(a.motion_blur, b.motion_blur);
  a.whole_extents = a.whole_extents && b.whole_extents;
  if (a.warp != b.warp) a.warp.clear();
  return a;
}

/// An aggregate draws all terms of its members itself, also those that are in their shade layers.
void hold_terms_of(const Layer& member, Layer& aggregate) {
  const auto join = [](std::vector<int>& into, const std::vector<int>& more) {
    into.insert(into.end(), more.begin(), more.end());
    std::sort(into.begin(), into.end());
    into.erase(std::unique(into.begin(), into.end()), into.end());
  };
  HeldTerms& holds = aggregate.holds;
  holds.shadows = holds.shadows || member.holds.shadows;
  holds.specular = holds.specular || member.holds.specular || member.factored.specular;
  holds.second_texture =
      holds.second_texture || member.holds.second_texture || member.factored.second_texture;
  join(aggregate.casters, member.casters);
  if (!member.holds.reflection || holds.reflection)
    return;  // several mirrors are all shown, but what one state follows is one reflection: the first's
  holds.reflection = true;
  aggregate.plane = member.plane;
  aggregate.reflected = member.reflected;
}

bool same(const Keys<double>& a, const Keys<double>& b) {
  return a.times_s == b.times_s && a.values == b.values && a.interpolation == b.interpolation;
}

/// One sprite has one fade: that of its members, if they have one in common.
Keys<double> common_fade(std::span<const Layer> layers, std::span<const int> members) {
  const Keys<double>& fade = layers[members.front()].fade;
  const bool common = std::all_of(members.begin(), members.end(),
                                  [&](int member) { return same(layers[member].fade, fade); });
  return common ? fade : Keys<double>{};
}

std::string joined_names(std::span<const Layer> layers, std::span<const int> members) {
  constexpr std::size_t kAll = 4, kCut = 3;
  std::string name;
  const std::size_t shown = members.size() <= kAll ? members.size() : kCut;
  for (const int member : members.first(shown))
    name.append(name.empty() ? "" : "+").append(layers[member].name);
  if (shown < members.size()) name.append("+").append(std::to_string(members.size() - shown)).append(" more");
  return name;
}

}  // namespace

Layer aggregate_of(std::span<const Layer> layers, std::span<const int> members, int id) {
  TALISMAN_CHECK_GE(members.size(), std::size_t{2});
  Layer aggregate;
  aggregate.id = id;
  aggregate.name = joined_names(layers, members);
  aggregate.group = layers[members.front()].group;
  aggregate.preferences = layers[members.front()].preferences;
  aggregate.members.assign(members.begin(), members.end());
  for (const int member : members) {
    const Layer& layer = layers[member];
    TALISMAN_CHECK(layer.members.empty());
    aggregate.parts.insert(aggregate.parts.end(), layer.parts.begin(), layer.parts.end());
    aggregate.preferences = strictest(aggregate.preferences, layer.preferences);
    aggregate.polygons += layer.polygons;
    hold_terms_of(layer, aggregate);
    for (std::size_t k = member + 1; k < layers.size() && layers[k].base == member; ++k)
      hold_terms_of(layers[k], aggregate);
  }
  aggregate.fade = common_fade(layers, members);
  aggregate.preferences.bound_each_part = true;
  std::sort(aggregate.parts.begin(), aggregate.parts.end());
  return aggregate;
}

LayerBound aggregate_bound(std::span<const LayerBound* const> members) {
  LayerBound bound;
  bound.kind = members.front()->kind;
  int first = 0;
  for (const LayerBound* member : members) {
    const LayerBound& body = *member;
    const int triangles = static_cast<int>(bound.hull.triangles.size());
    for (const int end : body.hull.face_ends) bound.hull.face_ends.push_back(end + triangles);
    for (const auto& [a, b, c] : body.hull.triangles)
      bound.hull.triangles.push_back({a + first, b + first, c + first});
    first += point_count(body);
    bound.bodies.push_back(body);
  }
  return bound;
}

std::vector<std::span<const dvec3>> convex_bodies(const LayerBound& bound,
                                                  std::span<const dvec3> world_points) {
  if (world_points.empty()) return {};
  TALISMAN_CHECK_EQ(static_cast<int>(world_points.size()), point_count(bound));
  if (bound.bodies.empty()) return {world_points};
  std::vector<std::span<const dvec3>> bodies;
  for (const LayerBound& body : bound.bodies) {
    const auto own = world_points.first(static_cast<std::size_t>(point_count(body)));
    const auto of_body = convex_bodies(body, own);
    bodies.insert(bodies.end(), of_body.begin(), of_body.end());
    world_points = world_points.subspan(own.size());
  }
  return bodies;
}

}  // namespace talisman::layers
