// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/latency/latency_curve.h"

#include <algorithm>
#include <cmath>

#include "layers/state.h"
#include "sequences/experiments/latency/judge.h"
#include "sequences/pipeline/latency/last_warp.h"
#include "sequences/pipeline/latency/late_camera.h"
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
  const dmat3 homography = turned_picture(cameras.drawn, cameras.warped, size);
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
  const std::shared_ptr<const layers::Scene> rig = camera_alone(pipeline.scene);
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
    for (const regulator::Prediction predictor : kExpectations) {
      RowValues values;
      for (int frame = frames.first; frame <= frames.last; ++frame) {
        const double t_s = time_of(pipeline, frame);
        const auto expected = [&](double late_ms) {
          return expected_camera(*rig, t_s, t_s - late_ms / 1000, predictor, settings.regulator.kalman);
        };
        const Cameras cameras = {rig->at(t_s).camera, expected(render_ms),
                                 expected(std::min(warp_ms, render_ms))};
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
