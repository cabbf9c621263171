// SPDX-License-Identifier: Apache-2.0
#include "layers/rest.h"

#include <algorithm>

#include "layers/animation.h"

namespace talisman::layers {

namespace {

template <typename T>
bool keys_rest(const Keys<T>& keys, double from_s, double to_s) {
  const std::vector<double>& times = keys.times_s;
  if (times.size() < 2 || to_s <= times.front() || from_s >= times.back()) return true;
  if (keys.interpolation == Interpolation::CubicSpline) return false;
  const auto after = std::upper_bound(times.begin(), times.end(), from_s);
  const auto first = after == times.begin() ? 0 : after - times.begin() - 1;
  const auto last =
      std::min(std::lower_bound(times.begin(), times.end(), to_s), times.end() - 1) - times.begin();
  return std::all_of(keys.values.begin() + first, keys.values.begin() + last + 1,
                     [&](const T& value) { return value == keys.values[first]; });
}

bool motion_rests(const TransformTrack& track, double from_s, double to_s) {
  return !track.loop && keys_rest(track.translation, from_s, to_s) &&
         keys_rest(track.rotation, from_s, to_s) && keys_rest(track.scale, from_s, to_s);
}
/// A node that looks along its path looks where it went last, or will go: that may differ where it stands still.
bool motion_rests(const FlightTrack&, double, double) { return false; }
bool motion_rests(const SpinTrack&, double, double) { return false; }
bool motion_rests(const MorphTrack& track, double from_s, double to_s) {
  const auto rests = [&](const Keys<double>& keys) { return keys_rest(keys, from_s, to_s); };
  return !track.loop && std::all_of(track.weights.begin(), track.weights.end(), rests);
}

void mark_with_ancestors(const Scene& scene, int node, std::vector<bool>& marked) {
  for (; node >= 0 && !marked[node]; node = scene.nodes[node].parent) marked[node] = true;
}

/// Nodes that the layer's own parts, the camera and the lights follow.
std::vector<bool> followed_nodes(const Scene& scene, const Layer& layer) {
  std::vector<bool> marked(scene.nodes.size(), false);
  const auto mark = [&](int node) { mark_with_ancestors(scene, node, marked); };
  for (const int index : layer.parts) {
    mark(scene.parts[index].node);
    if (scene.parts[index].skin < 0) continue;
    for (const int joint : scene.skins[scene.parts[index].skin].joints) mark(joint);
  }
  if (!scene.cameras.empty()) mark(scene.cameras[scene.active_camera].node);
  for (const Light& light : scene.lights) mark(light.node);
  return marked;
}

/// Do only its own parts, the camera and the lights have a part in its picture?
bool is_by_itself(const Layer& layer) {
  return layer.kind == LayerKind::Geometry && !layer.is_aggregate() && !layer.holds.shadows &&
         !layer.holds.reflection;
}

}  // namespace

bool rests(const Track& track, double from_s, double to_s) {
  const bool is_morph = std::holds_alternative<MorphTrack>(track.motion);
  if (!is_morph && !moves(track)) return true;
  return std::visit([&](const auto& motion) { return motion_rests(motion, from_s, to_s); }, track.motion);
}

LayerRest::LayerRest(const Scene& scene, const Layer& layer) : scene_(scene) {
  is_known_ = scene.moving_pictures.empty() && !(layer.preferences.motion_blur > 0);
  if (!is_known_) return;
  const bool is_alone = is_by_itself(layer);
  const std::vector<bool> marked = is_alone ? followed_nodes(scene, layer) : std::vector<bool>{};
  for (std::size_t i = 0; i < scene.tracks.size(); ++i)
    if (!is_alone || marked[scene.tracks[i].node]) tracks_.push_back(static_cast<int>(i));
}

bool LayerRest::rests(double a_s, double b_s) const {
  if (!is_known_) return false;
  const double from_s = std::min(a_s, b_s), to_s = std::max(a_s, b_s);
  return std::all_of(tracks_.begin(), tracks_.end(),
                     [&](int i) { return layers::rests(scene_.tracks[i], from_s, to_s); });
}

}  // namespace talisman::layers
