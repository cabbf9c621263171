// SPDX-License-Identifier: Apache-2.0
#include "layers/advance.h"

#include <algorithm>
#include <cmath>

#include "layers/animation.h"
#include "layers/built_effects.h"
#include "layers/check.h"
#include "layers/moving_picture.h"
#include "layers/scene_at.h"

namespace talisman::layers {
namespace {

/// A track of which nothing but one and the same value can come. Equal keys do not count: 0 equals -0, and is
/// not the same bits.
bool is_constant(const Track& track) {
  if (std::holds_alternative<MorphTrack>(track.motion)) return true;
  const auto* motion = std::get_if<TransformTrack>(&track.motion);
  return motion != nullptr && motion->translation.values.size() <= 1 && motion->rotation.values.size() <= 1 &&
         motion->scale.values.size() <= 1;
}

}  // namespace

SceneMotion::SceneMotion(const Scene& scene) : scene_(scene), is_moving_(scene.nodes.size(), 0) {
  std::vector<std::vector<int>> tracks_of(scene.nodes.size());
  for (std::size_t k = 0; k < scene.tracks.size(); ++k) {
    const Track& track = scene.tracks[k];
    if (!std::holds_alternative<MorphTrack>(track.motion))
      tracks_of.at(track.node).push_back(static_cast<int>(k));
    if (!is_constant(track)) is_moving_.at(track.node) = 1;
  }
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    const int parent = scene.nodes[i].parent;
    if (parent >= 0 && is_moving_[parent]) is_moving_[i] = 1;
    if (!is_moving_[i]) continue;
    moving_.push_back(static_cast<int>(i));
    first_track_.push_back(static_cast<int>(tracks_.size()));
    tracks_.insert(tracks_.end(), tracks_of[i].begin(), tracks_of[i].end());
  }
  first_track_.push_back(static_cast<int>(tracks_.size()));
  for (std::size_t k = 0; k < scene.lights.size(); ++k)
    if (moves(scene.lights[k].node)) lights_.push_back(static_cast<int>(k));
}

void SceneMotion::advance(SceneFrame& frame, double t_s) const {
  TALISMAN_CHECK(std::isfinite(t_s));
  if (frame.scene != &scene_ || frame.world_from_node.size() != scene_.nodes.size() ||
      frame.lights.size() != scene_.lights.size()) {
    frame = scene_.at(t_s);
    return;
  }
  frame.time_s = t_s;
  std::vector<dmat4>& worlds = frame.world_from_node;
  for (std::size_t k = 0; k < moving_.size(); ++k) {
    const Node& node = scene_.nodes[moving_[k]];
    Transform local = node.local;
    for (int i = first_track_[k]; i < first_track_[k + 1]; ++i)
      local = transform_at(scene_.tracks[tracks_[i]], local, t_s);
    worlds[moving_[k]] = world_of_node(node.parent < 0 ? dmat4(1) : worlds[node.parent], local);
  }
  frame.camera = camera_at(scene_, worlds);
  for (const int light : lights_) frame.lights[light] = light_at(scene_.lights[light], worlds);
  if (is_built(Effect::Morphing) && !frame.morph_weights.empty())
    frame.morph_weights = morph_weights_at(scene_, t_s);
  if (is_built(Effect::MovingPicture)) frame.picture_frames = picture_frames_at(scene_, t_s);
}

}  // namespace talisman::layers
