// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which camera does a frame know, and what moves with it?
///
/// Poses are those of a tracker, every kTrackerStep_s. At time t the poses up to t − LATE are known; from there the camera is
/// expected as regulator::Prediction says: held, linear (layers/predict.h), or kalman over the last kTrackedPoses
/// (layers/predict_kalman.h). Before the scene begins its tracks hold, as everywhere.
///
/// What is late is the pose of the active camera alone: its field of view and all other things are as of t. What is tracked is
/// the nearest node, from the camera's own upwards, that a track moves; what hangs on it, as a head-up display and a headlamp
/// on a head, is where the expected camera has it.

#include "regulator/latency_options.h"
#include "sequences/pipeline/pipeline.h"

namespace talisman::sequences {

inline constexpr double kTrackerStep_s = 0.004;
inline constexpr int kTrackedPoses = 32;

/// The active camera and the nodes above it, of the same poses as in the scene, and nothing else: cheap to ask.
std::shared_ptr<const layers::Scene> camera_alone(const layers::Scene& scene);

/// The camera at `t_s` as it is expected out of the poses up to `known_s` ≤ t_s. `rig`: camera_alone. Pure. Cost: that of
/// some poses, at most kTrackedPoses.
layers::CameraState expected_camera(const layers::Scene& rig, double t_s, double known_s,
                                    regulator::Prediction prediction, const layers::KalmanNoise& noise);

/// The node whose poses those of the active camera are; -1: it stands in the world.
int tracked_node(const layers::Scene& scene);

/// The frame with another camera, and what hangs on what is tracked.
void look_from(layers::SceneFrame& frame, const layers::CameraState& camera);

/// Does the run know old poses only?
inline bool is_late(const Pipeline& pipeline) {
  return regulator::is_late(pipeline.settings.regulator.latency);
}
inline bool warps_last(const Pipeline& pipeline) {
  return regulator::warps_last(pipeline.settings.regulator.latency);
}

/// Of a late run: the camera that is known to decisions and sprites of `frame` in frame `known` ≤ frame.
layers::CameraState camera_known(const Pipeline& pipeline, int known, int frame);
/// … and to the last warp; the same where there is none.
layers::CameraState camera_of_last_warp(const Pipeline& pipeline, int frame);

/// The same run, with all poses known in time.
Pipeline in_time(const Pipeline& pipeline);

}  // namespace talisman::sequences
