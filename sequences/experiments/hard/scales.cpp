// SPDX-License-Identifier: Apache-2.0
// Units do not show: the same world in metres and in millionths of them, at the origin and far from it, early and late. Of
// a power of two not one bit may differ; places on the display are worked out in long double.
#include <algorithm>
#include <cmath>

#include <glm/gtc/quaternion.hpp>

#include "layers/polyhedron.h"
#include "layers/state.h"
#include "sequences/experiments/hard/hard_case.h"
#include "sequences/experiments/hard/scenes.h"
#include "sequences/pipeline/step.h"

namespace talisman::sequences {
namespace {

using Exact = long double;
using layers::dvec2;
using layers::dvec3;
using layers::Scene;

constexpr layers::ivec2 kScaleDisplay_px{128, 96};
constexpr double kScaleTime_s = 1.3;

// --- Pictures

HardOutcome picture_in_units(double scale, dvec3 origin, int allowed) {
  static const chunker::Sprite in_metres =
      draw_hard(hard_world(), kScaleDisplay_px, {}, false, kScaleTime_s).sprite;
  const HardPicture picture = draw_hard(hard_world(scale, origin), kScaleDisplay_px, {}, false, kScaleTime_s);
  return {share_that_differs(picture.sprite, in_metres, allowed), false};
}

void add_pictures(std::vector<HardCase>& cases) {
  const auto add = [&](const char* name, const char* special, double scale, double most, int allowed,
                       dvec3 origin = {0, 0, 0}, double extreme = 0) {
    cases.push_back(
        {HardStage::Scale,
         name,
         special,
         extreme > 0 ? extreme : scale,
         {most, allowed == 0 ? "of the texels" : "of the texels, > 2 codes", "the same in metres"},
         [=] { return picture_in_units(scale, origin, allowed); }});
  };
  add("picture, 2^-20", "powers of two change no bit", 0x1p-20, 0, 0);
  add("picture, 2^20", "powers of two change no bit", 0x1p20, 0, 0);
  add("picture, 2^-40", "a world of 10 picometres", 0x1p-40, 0, 0);
  add("picture, 2^40", "a world of 10^13 m", 0x1p40, 0, 0);
  add("picture, 1e-6", "a world of 10 micrometres", 1e-6, 0.01, 2);
  add("picture, 1e6", "a world of 10,000 km", 1e6, 0.01, 2);
  add("picture, 1e-15", "a world of 10 femtometres", 1e-15, 0.01, 2);
  add("picture, 5e17", "a world of 500 light years", 5e17, 0.01, 2);
  add("picture, 1e6 away", "a world far from its origin", 1, 0.01, 2, {1e6, -1e6, 1e6}, 1e6);
}

/// Beyond what the renderer's floats hold, a reader says so.
void add_refused_worlds(std::vector<HardCase>& cases) {
  for (const auto& [scale, text] : {std::pair{1e19, "world of 1e20 m"}, {1e-20, "world of 1e-19 m"}})
    cases.push_back({HardStage::Scale,
                     text,
                     "squares of distances are no floats",
                     scale,
                     {0, "wrong pictures", "refused with the rule", true},
                     [scale = scale] {
                       return HardOutcome{0, !layers::first_defect(hard_world(scale)).empty()};
                     }});
}

/// What is drawn is never refused: the largest and the smallest world of the table.
HardOutcome worlds_without_defect() {
  int refused = 0;
  for (const double scale : {1e-15, 5e17}) refused += !layers::first_defect(hard_world(scale)).empty();
  return {double(refused), false};
}

// --- Places on the display

/// The display position of a world point, from the camera's own numbers.
void project_in_exact(const layers::CameraState& camera, layers::ivec2 display, const dvec3& p, Exact& x,
                      Exact& y) {
  const layers::dmat4& m = camera.world_from_camera;
  Exact local[3];
  for (int k = 0; k < 3; ++k)
    local[k] = Exact(m[k].x) * (Exact(p.x) - m[3].x) + Exact(m[k].y) * (Exact(p.y) - m[3].y) +
               Exact(m[k].z) * (Exact(p.z) - m[3].z);
  const Exact per_depth = display.y / (2 * std::tan(Exact(camera.fov_y_rad) / 2));
  x = Exact(display.x) / 2 + per_depth * local[0] / -local[2];
  y = Exact(display.y) / 2 - per_depth * local[1] / -local[2];
}

/// Characteristic points as they are captured, of every layer: the largest error, px.
HardOutcome places_on_display(const Scene& scene, double t_s) {
  const layers::LayerSet set = layers_of_parts(scene);
  const layers::SceneFrame frame = scene.at(t_s);
  const layers::View view;
  Exact worst = 0;
  int points = 0;
  for (const layers::Layer& layer : set.layers) {
    const layers::LayerBound bound = layers::make_layer_bound(scene, layer, layers::BoundKind::Dop14);
    const layers::LayerState state = layers::capture(frame, layer, bound, view);
    for (std::size_t i = 0; i < state.world_points.size(); ++i) {
      if (!(state.clip_points[i].w > frame.camera.near_m)) continue;
      Exact x = 0, y = 0;
      project_in_exact(frame.camera, view.display_px, state.world_points[i], x, y);
      const dvec2 got = layers::screen_from_clip(state.clip_points[i], view.display_px);
      worst = worse(worst, std::hypot(got.x - x, got.y - y));
      ++points;
    }
  }
  return {points > 0 ? double(worst) : HUGE_VAL, false};
}

/// A box of 1 m at `distance`, seen under a field of view that it fills.
Scene through_a_telescope(double distance) {
  Scene scene = hard_view(2 / distance, distance / 100);
  add_hard_part(scene, level_square(1), hard_material({1, 1, 1}), {0.1, 0.2, -distance});
  scene.nodes[0].local.rotation = glm::angleAxis(1.0, dvec3(1, 0, 0));
  return scene;
}

void add_places(std::vector<HardCase>& cases) {
  const auto add = [&](const char* name, const char* special, double extreme, double most,
                       const Scene& scene) {
    cases.push_back({HardStage::Scale, name, special, extreme, {most, "px of 1024", "long double"}, [scene] {
                       return places_on_display(scene, kScaleTime_s);
                     }});
  };
  add("places, 1e-12", "a world of a picometre", 1e-12, 1e-9, hard_world(1e-12));
  add("places, 1e12", "a world of a planetary system", 1e12, 1e-9, hard_world(1e12));
  add("places, 1e6 away", "a world far from its origin", 1e6, 1e-5, hard_world(1, {1e6, -1e6, 1e6}));
  add("places, 1e9 away", "7 digits are left", 1e9, 1e-2, hard_world(1, {1e9, -1e9, 1e9}));
  add("telescope of 1e-6 rad", "1 m at 2e6 m fills the view", 1e6, 1e-5, through_a_telescope(2e6));
  add("telescope of 1e-9 rad", "1 m at 2e9 m fills the view", 1e9, 1e-2, through_a_telescope(2e9));
}

// --- Times

/// A spinning node after a long time: the largest error of its axes.
HardOutcome spun_for(double t_s) {
  Scene scene = hard_view();
  add_hard_part(scene, level_square(1), hard_material({1, 1, 1}));
  scene.tracks.push_back({0, layers::SpinTrack{{0, 0, 1}, 0.7}});
  const layers::dmat4 got = scene.at(t_s).world_from_node[0];
  const Exact angle = Exact(0.7) * t_s;
  return {double(worse(std::fabs(got[0].x - std::cos(angle)), std::fabs(got[0].y - std::sin(angle)))), false};
}

/// Keys 1e-9 s apart, late: the value half between them.
HardOutcome between_close_keys(double late_s) {
  Scene scene = hard_view();
  add_hard_part(scene, level_square(1), hard_material({1, 1, 1}));
  layers::TransformTrack track;
  track.translation.times_s = {late_s, late_s * (1 + 1e-9)};
  track.translation.values = {{0, 0, 0}, {1, 0, 0}};
  scene.tracks.push_back({0, track});
  const double t = late_s * (1 + 0.5e-9);
  const Exact right = (Exact(t) - track.translation.times_s[0]) /
                      (Exact(track.translation.times_s[1]) - track.translation.times_s[0]);
  return {double(std::fabs(scene.at(t).world_from_node[0][3].x - right)), false};
}

void add_times(std::vector<HardCase>& cases) {
  cases.push_back(
      {HardStage::Scale, "spun for 1e6 s", "11 days at 0.7 rad/s", 1e6, {1e-8, "rad", "long double"}, [] {
         return spun_for(1e6);
       }});
  cases.push_back(
      {HardStage::Scale, "spun for 1e9 s", "31 years at 0.7 rad/s", 1e9, {1e-6, "rad", "long double"}, [] {
         return spun_for(1e9);
       }});
  cases.push_back({HardStage::Scale,
                   "keys 1e-9 apart",
                   "of 1000 s, a billionth apart",
                   1e9,
                   {1e-6, "of the step", "long double"},
                   [] { return between_close_keys(1000); }});
}

// --- The whole pipeline

constexpr int kPlayedFrames = 12;

struct PlayedWorld {
  std::vector<std::string> actions;  ///< of each layer in each frame, with its error where that is exact
  std::vector<chunker::Frame> frames;
};

PlayedWorld play_world(double scale, regulator::Policy policy, double threshold_px) {
  const Scene scene = hard_world(scale);
  Settings settings;
  settings.regulator.policy = policy;
  settings.regulator.thresholds.geometric_px = threshold_px;
  settings.view.display_px = kScaleDisplay_px;
  settings.frames = kPlayedFrames;
  const Pipeline pipeline = make_pipeline(scene, layers_of_parts(scene), settings);
  const chunker::PreparedScene prepared(scene, settings.render);
  PipelineState state(pipeline);
  PlayedWorld played;
  for (int frame = 0; frame < kPlayedFrames; ++frame) {
    FrameReport report = step(pipeline, state, frame, &prepared);
    for (const regulator::LayerDecision& d : report.plan.decisions)
      played.actions.emplace_back(name(d.action));
    played.frames.push_back(std::move(report.picture));
  }
  return played;
}

/// Decisions that differ from those of the same world in metres; with powers of two also frames.
HardOutcome decisions_in_units(double scale, bool frames_too) {
  static const PlayedWorld in_metres = play_world(1, regulator::Policy::Threshold, 1);
  const PlayedWorld played = play_world(scale, regulator::Policy::Threshold, 1);
  double different = played.actions.size() == in_metres.actions.size() ? 0 : HUGE_VAL;
  for (std::size_t i = 0; i < std::min(played.actions.size(), in_metres.actions.size()); ++i)
    different += played.actions[i] != in_metres.actions[i];
  if (frames_too)
    for (int f = 0; f < kPlayedFrames; ++f) different += !(played.frames[f] == in_metres.frames[f]);
  return {different, false};
}

/// A threshold of 0 px reuses only what is identical: frames that are not those of `reference`.
HardOutcome threshold_of_zero(double scale) {
  const PlayedWorld reference = play_world(scale, regulator::Policy::Reference, 0);
  const PlayedWorld played = play_world(scale, regulator::Policy::Threshold, 0);
  double different = 0;
  for (int f = 0; f < kPlayedFrames; ++f) different += !(played.frames[f] == reference.frames[f]);
  return {different, false};
}

void add_runs(std::vector<HardCase>& cases) {
  const auto add = [&](const char* name, const char* special, double scale, const char* unit,
                       const char* oracle, std::function<HardOutcome()> measure) {
    cases.push_back({HardStage::Scale, name, special, scale, {0, unit, oracle}, std::move(measure)});
  };
  for (const auto& [scale, text] : {std::pair{0x1p-30, "run, 2^-30"}, {0x1p30, "run, 2^30"}})
    add(text, "12 frames under a threshold of 1 px", scale, "decisions and frames", "the same in metres",
        [scale = scale] { return decisions_in_units(scale, true); });
  for (const auto& [scale, text] : {std::pair{1e-9, "run, 1e-9"}, {1e9, "run, 1e9"}})
    add(text, "12 frames under a threshold of 1 px", scale, "decisions", "the same in metres",
        [scale = scale] { return decisions_in_units(scale, false); });
  for (const auto& [scale, text] : {std::pair{1.0, "threshold of 0 px"}, {1e-9, "threshold of 0 px, 1e-9"}})
    add(text, "only what is identical is shown again", scale, "frames of 12", "policy reference",
        [scale = scale] { return threshold_of_zero(scale); });
}

}  // namespace

std::vector<HardCase> hard_scales() {
  std::vector<HardCase> cases;
  add_pictures(cases);
  add_refused_worlds(cases);
  cases.push_back({HardStage::Scale,
                   "worlds of 1e-14 and 5e18 m",
                   "the limits of what is read",
                   1e15,
                   {0, "worlds refused", "drawn above"},
                   worlds_without_defect});
  add_places(cases);
  add_times(cases);
  add_runs(cases);
  return cases;
}

}  // namespace talisman::sequences
