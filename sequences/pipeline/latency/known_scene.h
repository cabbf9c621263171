// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What does a run know of the scene, in which frame?
///
///   scene_at          at a frame: as authored, or, in a late run, seen by the camera that is known to it (late_camera.h)
///   scene_as_known    the same as far as it is known in the frame that is planned: frames ahead may be expected
///   scene_expected    the same as it was known in frame `known` ≤ `frame`

#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

double time_of(const Pipeline& pipeline, int frame);

/// Are the frames ahead predicted rather than known?
bool predicts(const Pipeline& pipeline);

layers::SceneFrame scene_at(const Pipeline& pipeline, int frame);
/// The same, at the cost of what moved since the last call; the reference holds until the next one.
const layers::SceneFrame& scene_now(const Pipeline& pipeline, PipelineState& state, int frame);
layers::SceneFrame scene_as_known(const Pipeline& pipeline, const PipelineState& state, int frame);
layers::SceneFrame scene_expected(const Pipeline& pipeline, int known, int frame);

/// What predictions of the frames after `frame` are made from.
MotionKnown motion_known(const Pipeline& pipeline, int frame);

}  // namespace talisman::sequences
