// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/latency/displayed.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <glm/matrix.hpp>

#include "layers/placed.h"
#include "sequences/experiments/latency/judge.h"
#include "sequences/pipeline/blended_sprites.h"
#include "sequences/pipeline/latency/last_warp.h"
#include "sequences/pipeline/latency/late_camera.h"
#include "sequences/pipeline/layer_planning.h"
#include "sequences/pipeline/shade_passes.h"
#include "sequences/pipeline/step.h"

namespace talisman::sequences {

namespace {

using layers::CameraState;
using layers::dmat3;
using layers::dvec2;
using layers::dvec3;
using layers::dvec4;
using layers::Layer;
using layers::SceneFrame;
using regulator::Policy;
using regulator::Prediction;

constexpr double kNoPlace = std::numeric_limits<double>::quiet_NaN();

/// Where a camera has points, and how near.
struct SeenPoints {
  std::vector<dvec2> px;  ///< NaN: not before the near plane
  std::vector<double> inverse_depth;
};

SeenPoints seen_points(const std::vector<dvec3>& world, const CameraState& camera, layers::ivec2 size) {
  const layers::dmat4 clip_from_world = layers::clip_from_world(camera, size);
  SeenPoints seen;
  for (const dvec3& point : world) {
    const dvec4 clip = clip_from_world * dvec4(point, 1);
    const bool is_before = clip.w > camera.near_m;
    seen.px.push_back(is_before ? layers::screen_from_clip(clip, size) : dvec2(kNoPlace));
    seen.inverse_depth.push_back(is_before ? 1 / clip.w : 0);
  }
  return seen;
}

/// What all ways of one experiment share.
struct Stage {
  const Sequence& sequence;
  Settings settings;
  ExperimentFrames frames;
  std::vector<int> sampled;
  const chunker::PreparedScene& prepared;
  Pipeline now;  ///< in time, policy direct
  std::vector<int> parts, layer_of_number;
  std::vector<std::uint32_t> numbers;

  Stage(const Sequence& of, Settings with, const ExperimentFrames& range, const chunker::PreparedScene& scene)
      : sequence(of),
        settings(std::move(with)),
        frames(range),
        sampled(sampled_frames(range)),
        prepared(scene),
        now(make_pipeline(*of.scene, of.layers, in_time_and_direct(settings))) {
    for (const Layer& layer : now.authored)
      if (layer.base < 0)
        for (const int part : layer.parts) {
          numbers.push_back(static_cast<std::uint32_t>(parts.size()));
          parts.push_back(part);
          layer_of_number.push_back(layer.id);
        }
  }
  static Settings in_time_and_direct(Settings settings) {
    settings.regulator.policy = Policy::Direct;
    settings.regulator.latency = {};
    settings.compression.reset();
    return settings;
  }
  layers::ivec2 size() const { return settings.view.display_px; }
  bool is_drawn(int frame) const { return std::binary_search(sampled.begin(), sampled.end(), frame); }

  std::vector<std::vector<dvec3>> world_points(const SceneFrame& frame) const {
    std::vector<std::vector<dvec3>> points;
    for (const Layer& layer : now.authored)
      points.push_back(
          layers::world_points(frame, layer, now.authored.bound(static_cast<std::size_t>(layer.id))));
    return points;
  }
  DepthPicture draw(const SceneFrame& frame, ShadowMapStore& maps) const {
    const chunker::DepthRenderResult drawn =
        draw_with_depth({now, now.authored, maps, prepared, frame}, parts, numbers);
    return depth_picture(drawn.buffer, sequence.scene->background);
  }
};

std::vector<TrueFrame> true_frames(const Stage& stage) {
  std::vector<TrueFrame> truth;
  ShadowMapStore maps;
  for (int frame = stage.frames.first; frame <= stage.frames.last; ++frame) {
    const SceneFrame now = scene_at(stage.now, frame);
    TrueFrame& one = truth.emplace_back();
    one.camera = now.camera;
    for (const std::vector<dvec3>& points : stage.world_points(now))
      one.points.push_back(seen_points(points, now.camera, stage.size()).px);
    if (!stage.is_drawn(frame)) continue;
    one.picture = to_image8(draw_direct(stage.now, frame, stage.prepared));
    for (const std::int32_t part : stage.draw(now, maps).part)
      one.layer.push_back(part < 0 ? -1 : stage.layer_of_number[static_cast<std::size_t>(part)]);
  }
  return truth;
}

// --- Layers

/// The pixels on which no sprite is.
std::vector<char> open_pixels(const PipelineState& state, const FrameReport& report) {
  const BlendedSprites blended = blended_sprites(state, report);
  std::vector<chunker::PlacedSprite> placed;
  for (const ShownSprite& sprite : report.shown)
    placed.push_back(placed_sprite(sprite, state.sprites, blended));
  chunker::Frame clear;
  clear.width = report.display_px.x, clear.height = report.display_px.y;
  clear.pixels.resize(static_cast<std::size_t>(clear.width) * static_cast<std::size_t>(clear.height));
  chunker::composite_onto(clear, placed);
  std::vector<char> open;
  for (const chunker::Linear16& pixel : clear.pixels)
    open.push_back(2 * std::uint32_t{pixel.a} < chunker::kOne);
  return open;
}

/// A run of layers on its way through the frames.
class LayerWay {
 public:
  LayerWay(const Stage& stage, Policy policy, const regulator::LatencyOptions& latency, const char* name)
      : stage_(stage),
        pipeline_(make_pipeline(*stage.sequence.scene, stage.sequence.layers,
                                with(stage.settings, policy, latency))),
        state_(pipeline_),
        judge_(name, false, stage.sequence.layers, stage.size()) {}

  ShownWay run(const std::vector<TrueFrame>& truth) {
    for (int frame = 0; frame <= stage_.frames.last; ++frame) {
      const bool is_drawn = frame >= stage_.frames.first && stage_.is_drawn(frame);
      const FrameReport report = step(pipeline_, state_, frame, is_drawn ? &stage_.prepared : nullptr);
      if (frame < stage_.frames.first) continue;
      ShownFrame shown;
      shown.points = points_shown(report);
      for (const ShownSprite& sprite : report.shown) shown.ages.push_back(sprite.age_frames);
      if (is_drawn) {
        shown.picture = to_image8(report.picture);
        shown.is_open = open_pixels(state_, report);
      }
      judge_.add(truth[static_cast<std::size_t>(frame - stage_.frames.first)], shown);
      for (const regulator::LayerDecision& decision : report.plan.decisions)
        polygons_ += decision.cost.polygons;
      reference_ += report.reference.polygons;
    }
    judge_.add_polygons(static_cast<double>(polygons_));
    return judge_.result();
  }
  double share_of_polygons() const {
    return reference_ > 0 ? static_cast<double>(polygons_) / static_cast<double>(reference_) : 1;
  }
  double reference_per_frame() const {
    return static_cast<double>(reference_) / (stage_.frames.last - stage_.frames.first + 1);
  }

 private:
  static Settings with(Settings settings, Policy policy, const regulator::LatencyOptions& latency) {
    settings.regulator.policy = policy;
    settings.regulator.latency = latency;
    return settings;
  }

  /// Each point as the sprite has it that draws its layer, carried as that sprite is.
  std::vector<std::vector<dvec2>> points_shown(const FrameReport& report) {
    std::map<int, SceneFrame> instants;
    std::vector<std::vector<dvec2>> points(pipeline_.authored.size());
    for (const ShownSprite& sprite : report.shown) {
      const LayerMemory& memory = state_.memory[sprite.layer];
      const dmat3 carried =
          sprite.screen_from_sprite * glm::inverse(layers::to_mat3(memory.placement.screen_from_sprite));
      const auto [at, is_new] = instants.try_emplace(memory.depicts_frame);
      if (is_new) at->second = scene_at(pipeline_, memory.depicts_frame);
      const Layer& drawn = report.layers[sprite.layer];
      for (const int layer : drawn.is_aggregate() ? drawn.members : std::vector<int>{sprite.layer})
        if (static_cast<std::size_t>(layer) < points.size())
          points[static_cast<std::size_t>(layer)] = carried_points(at->second, layer, carried);
    }
    return points;
  }
  std::vector<dvec2> carried_points(const SceneFrame& then, int layer, const dmat3& carried) const {
    const std::vector<dvec3> world = layers::world_points(
        then, pipeline_.authored[layer], pipeline_.authored.bound(static_cast<std::size_t>(layer)));
    std::vector<dvec2> points;
    for (const dvec2& px : seen_points(world, then.camera, stage_.size()).px) {
      const dvec3 q = carried * dvec3(px, 1);
      points.push_back(q.z > 0 ? dvec2(q) / q.z : dvec2(kNoPlace));
    }
    return points;
  }

  const Stage& stage_;
  Pipeline pipeline_;
  PipelineState state_;
  ShownJudge judge_;
  std::int64_t polygons_ = 0, reference_ = 0;
};

// --- Whole frames

/// Whole frames drawn late and reprojected, each way from the same pictures.
class WholeWays {
 public:
  WholeWays(const Stage& stage, const regulator::LatencyOptions& latency)
      : stage_(stage),
        late_(make_pipeline(*stage.sequence.scene, stage.sequence.layers, late_settings(stage, latency))) {}

  /// Drawn for the share `rate` of the frames.
  void run(const std::vector<TrueFrame>& truth, double rate, double polygons_per_drawn,
           const std::string& suffix, std::vector<ShownWay>& ways) {
    std::vector<ShownJudge> judges;
    for (const Reprojection reprojection : kAllReprojections)
      judges.emplace_back(std::string(name(reprojection)) + suffix, true, stage_.sequence.layers,
                          stage_.size());
    int drawn = stage_.frames.first, drawings = 0;
    for (int frame = stage_.frames.first; frame <= stage_.frames.last; ++frame) {
      const int k = frame - stage_.frames.first;
      if (k == 0 || std::floor((k + 1) * rate) > std::floor(k * rate)) drawn = frame, ++drawings;
      for (std::size_t way = 0; way < judges.size(); ++way)
        judges[way].add(truth[static_cast<std::size_t>(k)], show(kAllReprojections[way], drawn, frame));
    }
    for (ShownJudge& judge : judges) {
      judge.add_polygons(polygons_per_drawn * drawings);
      ways.push_back(judge.result());
    }
  }

 private:
  /// A frame as it was drawn.
  struct Drawn {
    SceneFrame scene;
    std::vector<SeenPoints> points;
    std::optional<DepthPicture> picture;  ///< where it was asked for
  };

  static Settings late_settings(const Stage& stage, const regulator::LatencyOptions& latency) {
    Settings settings = Stage::in_time_and_direct(stage.settings);
    settings.regulator.latency = latency;
    return settings;
  }

  Drawn& drawn_at(int frame) {
    if (drawn_ && drawn_frame_ == frame) return *drawn_;
    drawn_frame_ = frame;
    drawn_.emplace();
    drawn_->scene = scene_at(late_, frame);
    for (const std::vector<dvec3>& points : stage_.world_points(drawn_->scene))
      drawn_->points.push_back(seen_points(points, drawn_->scene.camera, stage_.size()));
    return *drawn_;
  }

  ShownFrame show(Reprojection reprojection, int drawn_frame, int frame) {
    Drawn& drawn = drawn_at(drawn_frame);
    const bool is_drawn = stage_.is_drawn(frame);
    if (is_drawn && !drawn.picture) drawn.picture = stage_.draw(drawn.scene, maps_);
    const CameraState camera =
        is_late(late_) ? camera_of_last_warp(late_, frame) : scene_at(late_, frame).camera;
    const PixelMap map = pixel_map(drawn.scene.camera, camera, stage_.size());
    ShownFrame shown;
    shown.ages = {frame - drawn_frame};
    shown.points.resize(drawn.points.size());
    if (reprojection != Reprojection::Grid || is_drawn)
      for (std::size_t k = 0; k < drawn.points.size(); ++k)
        for (std::size_t i = 0; i < drawn.points[k].px.size(); ++i)
          shown.points[k].push_back(point_shown(reprojection, drawn.picture ? &*drawn.picture : nullptr,
                                                stage_.size(), map, drawn.points[k].px[i],
                                                drawn.points[k].inverse_depth[i]));
    if (!is_drawn) return shown;
    const SourceMap source = source_map(reprojection, *drawn.picture, drawn.scene.camera, camera);
    shown.picture = to_image8(reprojected(drawn.picture->color, source, stage_.sequence.scene->background));
    for (std::size_t pixel = 0; pixel < source.source.size(); ++pixel)
      shown.is_open.push_back(source.is_hole(pixel));
    return shown;
  }

  const Stage& stage_;
  Pipeline late_;
  ShadowMapStore maps_;
  int drawn_frame_ = -1;
  std::optional<Drawn> drawn_;
};

// --- The pose

/// Axis times angle from one camera to another, in the space of the first.
dvec3 turn_between(const CameraState& from, const CameraState& to) {
  return layers::rotation_vector(glm::transpose(dmat3(from.world_from_camera)) * dmat3(to.world_from_camera));
}

ExpectedPose expected_pose(const Stage& stage, const regulator::LatencyOptions& latency,
                           const std::vector<TrueFrame>& truth) {
  const auto rig = camera_alone(*stage.sequence.scene);
  std::vector<double> turn, px, ahead;
  for (int frame = stage.frames.first; frame <= stage.frames.last; ++frame) {
    const double t_s = time_of(stage.now, frame), known_s = t_s - latency.render_ms / 1000;
    const CameraState& now = truth[static_cast<std::size_t>(frame - stage.frames.first)].camera;
    const CameraState expected =
        expected_camera(*rig, t_s, known_s, latency.predict, stage.settings.regulator.kalman);
    turn.push_back(degrees_between(expected, now));
    px.push_back(turn.back() * stage.size().y / glm::degrees(now.fov_y_rad));
    const dvec3 since = turn_between(now, rig->at(known_s).camera);  // backwards
    const double length = glm::length(since);
    const double along = length > 1e-9 ? -glm::dot(turn_between(now, expected), since) / length : 0;
    ahead.push_back(glm::degrees(std::max(0.0, along)));
  }
  return {spread_of(turn), spread_of(px), spread_of(ahead)};
}

/// Latencies and what is expected of them; of one that is 0 there is nothing to expect.
std::vector<regulator::LatencyOptions> latencies(double warp_ms) {
  std::vector<regulator::LatencyOptions> all;
  for (const double render_ms : kShownLatencies_ms)
    for (const Prediction predict : {Prediction::Held, Prediction::Linear, Prediction::Kalman}) {
      if (render_ms == 0 && predict != Prediction::Held) continue;
      all.push_back({render_ms, warp_ms < render_ms ? warp_ms : regulator::kNoLastWarp_ms, predict});
    }
  return all;
}

}  // namespace

DisplayedExperiment measure_displayed(const Sequence& sequence, const Settings& settings,
                                      const ExperimentFrames& frames, double warp_ms, ProgressKind progress) {
  const chunker::PreparedScene prepared(*sequence.scene, settings.render);
  const Stage stage(sequence, settings, frames, prepared);
  DisplayedExperiment experiment{
      sequence.name, stage.size(), frames, static_cast<int>(stage.sampled.size()), {}};
  const std::vector<TrueFrame> truth = true_frames(stage);
  const std::vector<regulator::LatencyOptions> all = latencies(warp_ms);
  Progress bar(progress, "latencies", static_cast<int>(all.size()));
  for (const regulator::LatencyOptions& latency : all) {
    ShownLatency row{latency.render_ms,
                     std::min(latency.warp_ms, latency.render_ms),
                     latency.predict,
                     0,
                     expected_pose(stage, latency, truth),
                     {}};
    LayerWay layers(stage, Policy::Threshold, latency, "layers");
    row.ways.push_back(layers.run(truth));
    row.ways.push_back(LayerWay(stage, Policy::Reference, latency, "layers, every frame").run(truth));
    WholeWays whole(stage, latency);
    row.layer_share = std::min(1.0, layers.share_of_polygons());
    whole.run(truth, 1, layers.reference_per_frame(), "", row.ways);
    whole.run(truth, row.layer_share, layers.reference_per_frame(), ", same polygons", row.ways);
    experiment.rows.push_back(std::move(row));
    bar.advance();
  }
  return experiment;
}

}  // namespace talisman::sequences
