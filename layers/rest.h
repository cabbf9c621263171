// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Does anything move between two instants that a layer's picture depends on? From the tracks, without evaluating a
/// scene.
///
///   rests(a, b)  ⇒  the layer's states at all instants of a … b are equal to the bit (LayerState::same_pixels)
///
/// Never true where that is not certain. A track rests from a to b where all its keys from the last one at or before a to
/// the first one at or after b are equal, which gives their value bit by bit in between (layers/animation.h), and outside its
/// keys; one without any motion always does. Spins, tracks that repeat, splines with slopes of their own and paths
/// that a node looks along move, wherever they have keys. What a layer depends on: the nodes, joints and morph weights of its
/// parts, camera and lights; all tracks where it holds a term of shading that other layers have a part in; nothing is certain of open shutters and moving pictures.

#include <vector>

#include "layers/layer.h"

namespace talisman::layers {

class LayerRest {
 public:
  /// Keeps a reference to the scene. Cost: O(nodes + tracks).
  LayerRest(const Scene& scene, const Layer& layer);

  /// In either order; finite times. Cost: O(tracks of the layer · log keys + keys in between).
  bool rests(double a_s, double b_s) const;

 private:
  const Scene& scene_;
  bool is_known_ = true;
  std::vector<int> tracks_;  ///< that may move it
};

/// The same of one track alone.
bool rests(const Track& track, double from_s, double to_s);

}  // namespace talisman::layers
