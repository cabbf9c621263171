// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/latency/last_warp.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "sequences/pipeline/latency/late_camera.h"
#include "sequences/pipeline/layer_planning.h"
#include "warp/quadrilateral.h"

namespace talisman::sequences {

namespace {

using layers::CameraState;
using layers::dmat3;
using layers::dvec2;
using layers::dvec3;
using layers::Layer;
using layers::LayerState;
using layers::SceneFrame;

/// The layers that exist as a camera sees them.
std::vector<LayerState> states_seen_from(const Pipeline& pipeline, const FrameReport& report,
                                         SceneFrame frame, const CameraState& camera) {
  look_from(frame, camera);
  const layers::FrameCapture capture(frame, pipeline.settings.view);
  std::vector<LayerState> states(report.layers.size());
  for (const Layer& layer : report.layers)
    if (report.order.has_own_sprite(layer.id, layer.is_aggregate()) || !layer.is_aggregate())
      capture_layer(report.layers, layer, capture, states);
  return states;
}

/// The state as of which what is shown of a layer was drawn. A frame without sprites is of now.
const LayerState* drawn_state(const Pipeline& pipeline, PipelineState& state, int layer, int frame) {
  if (!draws_sprites(pipeline)) return &captured_states(pipeline, state, frame)[layer];
  const std::optional<LayerState>& then = state.memory[layer].then;
  return then ? &*then : nullptr;
}

layers::Correspondences matched(const PipelineState& state, const FrameReport& report, const LayerState& then,
                                const LayerState& now) {
  const int age = std::abs(report.frame - state.memory[now.layer].frame_rendered);
  return layers::correspond(then, now, report.layers.bound(now.layer).hull, age);
}

/// The warp that carries what was drawn as of `then` to `now`; empty where nothing tells.
std::optional<dmat3> refitted(const Pipeline& pipeline, const PipelineState& state, const FrameReport& report,
                              const LayerState& then, const LayerState& now) {
  const layers::Correspondences points = matched(state, report, then, now);
  if (!points.overlap || points.then_px.empty()) return std::nullopt;
  const warp::FitResult fitted =
      warp::fit(then, now, points, curve_of(pipeline, report.layers[now.layer]), pipeline.settings.fit);
  const dmat3& map = fitted.warp.now_from_then;
  for (int column = 0; column < 3; ++column)
    if (!std::isfinite(map[column].x + map[column].y + map[column].z)) return std::nullopt;
  return map;
}

/// The largest distance of a point as it is shown from where it is; empty where none is in both views.
std::optional<double> off_px(const PipelineState& state, const FrameReport& report, const LayerState& then,
                             const LayerState& truth, const dmat3& map) {
  const layers::Correspondences points = matched(state, report, then, truth);
  if (!points.overlap || points.then_px.empty()) return std::nullopt;
  double largest = 0;
  for (std::size_t i = 0; i < points.then_px.size(); ++i) {
    const dvec3 shown = map * dvec3(points.then_px[i], 1);
    const dvec2 off = dvec2(shown) / shown.z - points.now_px[i];
    largest = std::max(largest, shown.z > 0 ? std::hypot(off.x, off.y) : warp::kHugePx);
  }
  return largest;
}

/// Where everything of a late frame is shown, and is.
class LateFrame {
 public:
  LateFrame(const Pipeline& pipeline, PipelineState& state, FrameReport& report)
      : pipeline_(pipeline),
        state_(state),
        report_(report),
        now_(pipeline.scene.at(time_of(pipeline, report.frame))) {}

  void show() {
    const CameraState drawn = camera_known(pipeline_, report_.frame, report_.frame);
    const CameraState shown = warps_last(pipeline_) ? camera_of_last_warp(pipeline_, report_.frame) : drawn;
    LateDisplay& late = report_.late.emplace();
    late.report.drawn_turn_deg = degrees_between(drawn, now_.camera);
    late.report.shown_turn_deg = degrees_between(shown, now_.camera);
    late.report.drawn_moved_m = moved_m(drawn);
    late.report.shown_moved_m = moved_m(shown);
    late.layer_px.assign(report_.plan.decisions.size(), -1);
    if (warps_last(pipeline_) && !draws_sprites(pipeline_))
      late.whole_picture = turned_picture(drawn, shown, report_.display_px);
    else if (warps_last(pipeline_))
      carry(states_seen_from(pipeline_, report_, now_, shown));
    judge(states_seen_from(pipeline_, report_, now_, now_.camera));
  }

 private:
  double moved_m(const CameraState& camera) const {
    return glm::distance(dvec3(camera.world_from_camera[3]), dvec3(now_.camera.world_from_camera[3]));
  }

  void carry(const std::vector<LayerState>& seen) {
    carried_.resize(report_.plan.decisions.size());
    for (ShownSprite& sprite : report_.shown) {
      const regulator::LayerDecision& decision = report_.plan.decisions[sprite.layer];
      const LayerState* then = drawn_state(pipeline_, state_, sprite.layer, report_.frame);
      if (then == nullptr || !seen[sprite.layer].in_view()) continue;
      carried_[sprite.layer] = refitted(pipeline_, state_, report_, *then, seen[sprite.layer]);
      if (!carried_[sprite.layer]) continue;
      const dmat3 further = *carried_[sprite.layer] * glm::inverse(decision.shown_warp.now_from_then);
      sprite.screen_from_sprite =
          *carried_[sprite.layer] * layers::to_mat3(state_.memory[sprite.layer].placement.screen_from_sprite);
      if (sprite.old) sprite.old->screen_from_sprite = further * sprite.old->screen_from_sprite;
    }
  }

  dmat3 map_of(int layer) const {
    if (!draws_sprites(pipeline_)) return report_.late->whole_picture;
    if (!carried_.empty() && carried_[layer]) return *carried_[layer];
    return report_.plan.decisions[layer].shown_warp.now_from_then;
  }

  void judge(const std::vector<LayerState>& truth) {
    LatencyReport& late = report_.late->report;
    int judged = 0;
    for (const regulator::LayerDecision& decision : report_.plan.decisions) {
      const int layer = decision.layer;
      const bool belongs = report_.order.has_own_sprite(layer, report_.layers[layer].is_aggregate()) &&
                           truth[layer].touches_display;
      const LayerState* then = drawn_state(pipeline_, state_, layer, report_.frame);
      if (decision.action == regulator::Action::Drop || then == nullptr) {
        late.layers_missing += belongs && decision.action == regulator::Action::Drop;
        continue;
      }
      if (!belongs) continue;
      const std::optional<double> off = off_px(state_, report_, *then, truth[layer], map_of(layer));
      if (!off) continue;
      report_.late->layer_px[layer] = *off;
      late.true_px = std::max(late.true_px, *off);
      late.true_mean_px += *off;
      ++judged;
    }
    if (judged > 0) late.true_mean_px /= judged;
  }

  const Pipeline& pipeline_;
  PipelineState& state_;
  FrameReport& report_;
  SceneFrame now_;                             ///< with the true camera
  std::vector<std::optional<dmat3>> carried_;  ///< by layer id, by the last warp; empty: there is none
};

}  // namespace

double degrees_between(const CameraState& a, const CameraState& b) {
  const dmat3 turn = glm::transpose(dmat3(a.world_from_camera)) * dmat3(b.world_from_camera);
  const glm::dquat q = glm::quat_cast(turn);
  return glm::degrees(2 * std::atan2(std::hypot(q.x, q.y, q.z), std::fabs(q.w)));
}

dmat3 turned_picture(const CameraState& drawn, const CameraState& shown, layers::ivec2 display_px) {
  const auto pixels_from_ray = [&](const CameraState& camera) {  // of a ray in the camera's space, w = −z
    const double focal = display_px.y / (2 * std::tan(camera.fov_y_rad / 2));
    return dmat3{{focal, 0, 0}, {0, -focal, 0}, {-display_px.x / 2.0, -display_px.y / 2.0, -1}};
  };
  const dmat3 turn = glm::transpose(dmat3(shown.world_from_camera)) * dmat3(drawn.world_from_camera);
  return pixels_from_ray(shown) * turn * glm::inverse(pixels_from_ray(drawn));
}

void show_late(const Pipeline& pipeline, PipelineState& state, FrameReport& report) {
  if (is_late(pipeline)) LateFrame(pipeline, state, report).show();
}

}  // namespace talisman::sequences
