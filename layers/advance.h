// SPDX-License-Identifier: Apache-2.0
#pragma once

/// From one frame of a scene to another, at the cost of what moves.
///
/// `Scene::at(t)` evaluates every node. `SceneMotion` knows once and for all which nodes follow a track, and which
/// lie below one; `advance(frame, t)` evaluates those, the camera and the lights that they carry, and leaves
/// the rest as it is. The frame then equals Scene::at(t) to the bit, whatever time it showed before: later,
/// earlier, or far away.
///
/// It is no member of Scene, which is plain data that anybody may change: what is known of its motion would
/// become false in silence. Who changes nodes, tracks, lights or cameras makes a new SceneMotion.

#include <span>
#include <vector>

#include "layers/scene.h"

namespace talisman::layers {

class SceneMotion {
 public:
  /// Keeps a reference to the scene. Cost: O(nodes + tracks + lights).
  explicit SceneMotion(const Scene& scene);

  /// `frame` becomes the scene at `t_s` (finite). One that is of another scene, or of none, is made anew; else
  /// it must be as Scene::at or `advance` left it. Cost: O(moving nodes + their tracks · log keys + cameras).
  void advance(SceneFrame& frame, double t_s) const;

  /// Nodes whose matrices may change, ascending: all others are the same at all times.
  std::span<const int> moving_nodes() const { return moving_; }
  bool moves(int node) const { return node >= 0 && is_moving_[node] != 0; }

 private:
  const Scene& scene_;
  std::vector<int> moving_;                ///< with a track that may move them, or below one
  std::vector<char> is_moving_;            ///< by node
  std::vector<int> first_track_, tracks_;  ///< tracks_[first_track_[k] … first_track_[k + 1]) move moving_[k]
  std::vector<int> lights_;                ///< on moving nodes
};

}  // namespace talisman::layers
