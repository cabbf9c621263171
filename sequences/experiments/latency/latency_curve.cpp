// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/latency/latency_curve.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "layers/state.h"
#include "sequences/experiments/statistics.h"
#include "sequences/pipeline/layer_planning.h"
#include "sequences/pipeline/make_pipeline.h"
#include "warp/fit.h"

namespace talisman::sequences {

namespace {

using layers::CameraState;
using layers::dmat3;
using layers::dmat4;
using layers::dvec2;
using layers::dvec3;
using layers::dvec4;

CameraState camera_with(CameraState camera, const dmat4& pose) {
  camera.world_from_camera = pose;
  return camera;
}

/// The camera as it is expected for `t_s` out of what was known `late_s` earlier.
CameraState expected_camera(const layers::Scene& scene, double t_s, double late_s, PosePredictor predictor) {
  const CameraState now = scene.at(t_s).camera;
  if (predictor == PosePredictor::Known || late_s == 0) return now;
  std::vector<dmat4> poses;
  const int count = predictor == PosePredictor::Held     ? 1
                    : predictor == PosePredictor::Linear ? 2
                                                         : kFilterPoses;
  for (int k = count - 1; k >= 0; --k)
    poses.push_back(scene.at(t_s - late_s - k * kTrackerStep_s).camera.world_from_camera);
  return camera_with(now, predicted_pose(poses, kTrackerStep_s, late_s, predictor));
}

double degrees_between(const CameraState& a, const CameraState& b) {
  const dmat3 turn = glm::transpose(dmat3(a.world_from_camera)) * dmat3(b.world_from_camera);
  const glm::dquat q = glm::quat_cast(turn);
  return glm::degrees(2 * std::atan2(std::hypot(q.x, q.y, q.z), std::fabs(q.w)));
}

/// How a whole frame moves where all is infinitely far, in pixels.
dmat3 homography_of(const CameraState& drawn, const CameraState& warped, layers::ivec2 size) {
  const auto pixels_from_ray = [&](const CameraState& camera) {  // of a ray in the camera's space, w = −z
    const double focal = size.y / (2 * std::tan(camera.fov_y_rad / 2));
    return dmat3{{focal, 0, 0}, {0, -focal, 0}, {-size.x / 2.0, -size.y / 2.0, -1}};
  };
  const dmat3 turn = glm::transpose(dmat3(warped.world_from_camera)) * dmat3(drawn.world_from_camera);
  return pixels_from_ray(warped) * turn * glm::inverse(pixels_from_ray(drawn));
}

/// Where points are on the display of one camera; NaN behind its near plane.
class Projection {
 public:
  Projection(const CameraState& camera, layers::ivec2 size)
      : clip_(layers::clip_from_world(camera, size)), near_m_(camera.near_m), size_(size) {}
  dvec2 operator()(const dvec3& p) const {
    const dvec4 clip = clip_ * dvec4(p, 1);
    return clip.w > near_m_ ? layers::screen_from_clip(clip, size_) : dvec2(NAN);
  }

 private:
  dmat4 clip_;
  double near_m_;
  layers::ivec2 size_;
};

bool is_finite(const dvec2& p) { return std::isfinite(p.x) && std::isfinite(p.y); }

Spread spread_of(std::vector<double>& values) {
  if (values.empty()) return {};
  return {quantile(values, 0.5), quantile(values, 0.95), *std::max_element(values.begin(), values.end())};
}

/// All values of one row.
struct RowValues {
  std::vector<double> turn_deg;
  std::array<std::vector<double>, kAllLastWarps.size()> error_px;
};

/// The three cameras of one frame of a row.
struct Cameras {
  CameraState truth, drawn, warped;
};

void add_layer(const std::vector<dvec3>& points, const Cameras& cameras, layers::ivec2 size,
               RowValues& values) {
  const Projection truth(cameras.truth, size), drawn(cameras.drawn, size), warped(cameras.warped, size);
  std::vector<dvec2> at_truth, at_drawn, at_warped;
  for (const dvec3& point : points) {
    const dvec2 t = truth(point), d = drawn(point), w = warped(point);
    const bool is_shown = t.x >= 0 && t.y >= 0 && t.x <= size.x && t.y <= size.y;  // false for NaN
    if (!is_shown || !is_finite(d) || !is_finite(w)) continue;
    at_truth.push_back(t), at_drawn.push_back(d), at_warped.push_back(w);
  }
  if (at_truth.empty()) return;
  const dmat3 homography = homography_of(cameras.drawn, cameras.warped, size);
  const warp::FitResult fitted = warp::fit(at_drawn, at_warped, warp::Curve::aff);
  for (std::size_t i = 0; i < at_truth.size(); ++i) {
    const dvec3 turned = homography * dvec3(at_drawn[i], 1);
    const std::array<dvec2, kAllLastWarps.size()> shown = {
        at_drawn[i], dvec2(turned) / turned.z, dvec2(fitted.warp.now_from_then * dvec3(at_drawn[i], 1)),
        at_warped[i]};
    for (std::size_t k = 0; k < shown.size(); ++k) {
      const dvec2 off = shown[k] - at_truth[i];
      values.error_px[k].push_back(std::hypot(off.x, off.y));
    }
  }
}

}  // namespace

std::string_view name(LastWarp warp) {
  switch (warp) {
    case LastWarp::None:
      return "none";
    case LastWarp::Homography:
      return "homography";
    case LastWarp::Layers:
      return "layers";
    case LastWarp::Depth:
      return "depth";
  }
  return "";
}

LatencyCurve measure_latency(const Sequence& sequence, const Settings& settings, const FrameRange& frames,
                             double warp_ms) {
  const Pipeline pipeline = make_pipeline(*sequence.scene, sequence.layers, settings);
  LatencyCurve curve{sequence.name, settings.view.display_px, frames, warp_ms, 0, {}};
  std::vector<std::vector<std::vector<dvec3>>> points;  // by frame and layer
  for (int frame = frames.first; frame <= frames.last; ++frame) {
    const layers::SceneFrame now = pipeline.scene.at(time_of(pipeline, frame));
    points.emplace_back();
    for (const layers::Layer& layer : pipeline.authored)
      points.back().push_back(
          layers::world_points(now, layer, pipeline.authored.bound(static_cast<std::size_t>(layer.id))));
  }
  for (const double render_ms : kRenderLatencies_ms)
    for (const PosePredictor predictor : kAllPredictors) {
      RowValues values;
      for (int frame = frames.first; frame <= frames.last; ++frame) {
        const double t_s = time_of(pipeline, frame);
        const Cameras cameras = {
            pipeline.scene.at(t_s).camera, expected_camera(pipeline.scene, t_s, render_ms / 1000, predictor),
            expected_camera(pipeline.scene, t_s, std::min(warp_ms, render_ms) / 1000, predictor)};
        values.turn_deg.push_back(degrees_between(cameras.drawn, cameras.truth));
        for (const auto& of_layer : points[static_cast<std::size_t>(frame - frames.first)])
          add_layer(of_layer, cameras, curve.display_px, values);
      }
      LatencyResult result{render_ms, predictor, spread_of(values.turn_deg), {}};
      curve.points = static_cast<std::int64_t>(values.error_px[0].size());
      for (std::size_t k = 0; k < result.error_px.size(); ++k)
        result.error_px[k] = spread_of(values.error_px[k]);
      curve.results.push_back(result);
    }
  return curve;
}

}  // namespace talisman::sequences
