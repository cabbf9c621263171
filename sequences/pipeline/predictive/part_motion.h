// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which parts change in which of the coming frames? Motion words (regulator/motion_words.h) of the parts of a
/// scene, from the scene at each frame of a slice [F96 3.1.2].
///
/// A part has changed since it was drawn if its picture may be another one,
///
///   changed = (its matrices, the camera, a picture on it, the blend of its textures, or, where it is lit, a light or a
///             caster of shadows differ)
///             and not (it lies outside the view on one side then, and on one now)         [F96 3.1.3]
///             and (δ = 0, or it deforms, or light, picture or blend differ, or its motion is beyond δ)
///
/// with the motion of its prediction primitive (layers/prediction_primitive.h, regulator/projected_motion.h), which
/// bounds that of all its surface. Shading by the angle of view is not followed below δ. What deforms is at rest only
/// while nothing about it differs. Lights and casters are compared frame by frame: what goes and returns counts as
/// changed.

#include <cstdint>
#include <functional>
#include <vector>

#include "layers/layer.h"
#include "layers/prediction_primitive.h"
#include "regulator/motion_words.h"
#include "regulator/projected_motion.h"

namespace talisman::sequences {

struct MotionOptions {
  double delta_px = 0;  ///< δ ≥ 0, finite; larger: fewer changes, and pictures farther off; 0: none at all
  regulator::MotionNorm norm = regulator::MotionNorm::Euclid;
  regulator::MotionReference reference = regulator::MotionReference::LastDrawn;
  bool clip_rule = true;  ///< what cannot be seen, then or now, is at rest
  bool operator==(const MotionOptions&) const = default;
};

/// A part and what carries its motion.
struct FollowedPart {
  int part = -1;  ///< index into Scene::parts
  int node = -1;
  layers::PrimitiveKind kind = layers::PrimitiveKind::Polygon;
  std::size_t first_point = 0, points = 0;  ///< of FollowedParts::points
  bool deforms = false;                     ///< `points` say nothing of it
  bool lit = false;
  int picture = -1;  ///< index into Scene::moving_pictures
  int layer = -1;    ///< id of the layer that draws it
  int blend = -1;    ///< index into FollowedParts::blends
};

/// Factors of the two textures of a layer over time, where they are factored (layers/shading.h).
struct FollowedBlend {
  layers::Keys<double> first, second;
};

/// The parts that a layer set draws, in the order in which one pass draws them (which decides at equal depth), without
/// the copies behind shared edges.
struct FollowedParts {
  std::vector<FollowedPart> parts;
  std::vector<layers::dvec3> points;  ///< of their primitives, in the spaces of their meshes
  std::vector<int> casters;           ///< parts whose matrices decide on the light of all lit ones
  std::vector<FollowedBlend> blends;
  int layers = 0;  ///< in the layer set
};
FollowedParts followed_parts(const layers::Scene& scene, const layers::LayerSet& set);

/// The words of a slice.
struct MotionSlice {
  int first = 0;                             ///< its first frame
  int frames = 0;                            ///< its length, N
  std::vector<regulator::MotionWord> words;  ///< by index of FollowedParts::parts
  std::int64_t vertices = 0;                 ///< of primitives that were projected
  int surprise = -1;  ///< the first frame of the slice that came otherwise than expected; -1: none did
  int surprised = 0;  ///< parts that it showed too far off
  int layers = 0;
  std::vector<double> moved_px;  ///< by frame of the slice and layer
  /// How far the parts of a layer are off at most that are displayed in a frame of the slice: ≤ δ, but for what is
  /// not compared by its motion.
  double displayed_px(int index, int layer) const {
    return moved_px[static_cast<std::size_t>(index) * layers + layer];
  }
};

/// The scene at a frame, as known or predicted at the beginning of the slice.
using FrameAt = std::function<layers::SceneFrame(int)>;

/// Follows the parts over frames first … first + frames - 1; those behind `last` are not asked for, and at rest.
/// With `truth_at`, the scene as it comes, what is displayed is compared with that, too, up to the first surprise: the words
/// are those of what was expected. Cost: O(parts + points that move) a frame.
MotionSlice follow_parts(const FollowedParts& followed, layers::ivec2 display_px, int first, int frames,
                         int last, const FrameAt& frame_at, const MotionOptions& options,
                         const FrameAt& truth_at = nullptr);

}  // namespace talisman::sequences
