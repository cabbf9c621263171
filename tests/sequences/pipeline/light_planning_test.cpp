// SPDX-License-Identifier: Apache-2.0
// The colour warp and the photometric fiducial through the whole pipeline.
#include "sequences/pipeline/light_planning.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sequences/commands/options.h"
#include "sequences/pipeline/step.h"
#include "sequences/results/frame_lines.h"
#include "tests/sequences/temporary_folder.h"
#include "tests/support/scenes.h"

namespace talisman::sequences {
namespace {

using layers::dvec3;
using regulator::Action;
using regulator::Policy;
using ::testing::HasSubstr;

constexpr int kLitFrames = 24;

/// A checkered square that faces the camera, lit by one sun that goes around it so that the light on it falls
/// (or grows) linearly from frame to frame; all its points always have one light.
struct Dimming {
  layers::Scene scene = tests::textured_quad_scene();
  layers::LayerSet layers;
  Settings settings;

  explicit Dimming(double from = 1, double to = 0.3) {
    scene.lights.clear();
    scene.nodes.emplace_back();
    scene.nodes.back().name = "sun";
    const int node = static_cast<int>(scene.nodes.size()) - 1;
    layers::TransformTrack track;
    for (int frame = 0; frame < kLitFrames; ++frame) {
      track.rotation.times_s.push_back(frame / settings.fps);
      const double level = from + (to - from) * frame / (kLitFrames - 1);
      track.rotation.values.push_back(glm::angleAxis(std::acos(level), dvec3(0, 1, 0)));
    }
    scene.tracks.push_back({node, track});
    layers::Light sun;
    sun.name = "sun";
    sun.node = node;
    sun.direction = {0, 0, -1};
    scene.lights.push_back(sun);
    layers = layers::factor(scene, tests::one_layer_per_part(scene));
    settings.view.display_px = {160, 120};
    settings.frames = kLitFrames;
  }

  std::vector<FrameReport> run(Policy policy, bool draw = true) const {
    Settings of_run = settings;
    of_run.regulator.policy = policy;
    const Pipeline pipeline = make_pipeline(scene, layers, of_run);
    const chunker::PreparedScene prepared(scene);
    PipelineState state(pipeline);
    std::vector<FrameReport> reports;
    for (int frame = 0; frame < kLitFrames; ++frame)
      reports.push_back(step(pipeline, state, frame, draw ? &prepared : nullptr));
    return reports;
  }
};

int renders(const std::vector<FrameReport>& reports) {
  int n = 0;
  for (const FrameReport& report : reports)
    for (const auto& decision : report.plan.decisions) n += decision.action == Action::Rerender;
  return n;
}

/// The largest difference of the displayed bytes, over all frames.
int largest_difference(const std::vector<FrameReport>& a, const std::vector<FrameReport>& b) {
  int largest = 0;
  for (std::size_t frame = 0; frame < a.size(); ++frame) {
    const auto x = chunker::srgb_bytes(a[frame].picture), y = chunker::srgb_bytes(b[frame].picture);
    EXPECT_EQ(x.size(), y.size());
    for (std::size_t i = 0; i < x.size(); ++i) largest = std::max(largest, std::abs(x[i] - y[i]));
  }
  return largest;
}

TEST(ColorWarp, ALightThatDimsIsFollowedWithoutRenders) {
  Dimming stage;
  const auto truth = stage.run(Policy::Reference);
  const auto warped = stage.run(Policy::Threshold);
  EXPECT_EQ(renders(warped), 1);
  for (const FrameReport& report : warped) {
    const double level = 1 - 0.7 * report.frame / (kLitFrames - 1);
    EXPECT_NEAR(report.plan.decisions[0].shown_color.x, level, 1e-6) << report.frame;
  }
  // A sprite's texel is an 8-bit square root: half a step, here and in the truth.
  EXPECT_LE(largest_difference(warped, truth), 2);
}

// The two ways to be without it: hardware that cannot, and no photometry at all (which shows stale light).
TEST(ColorWarp, WithoutItTheSameAccuracyCostsRenders) {
  Dimming stage;
  const auto truth = stage.run(Policy::Reference);
  stage.settings.regulator.color_warp = false;
  const auto without = stage.run(Policy::Threshold);
  EXPECT_GT(renders(without), 4);
  EXPECT_LT(renders(without), kLitFrames);
  for (const FrameReport& report : without)
    EXPECT_EQ(report.plan.decisions[0].shown_color, dvec3(1, 1, 1)) << report.frame;
  stage.settings.regulator.thresholds.photometric = 0;
  const auto blind = stage.run(Policy::Threshold);
  EXPECT_EQ(renders(blind), 1);
  EXPECT_GT(largest_difference(blind, truth), 80);
  EXPECT_LT(largest_difference(without, truth), 30);
}

// A multiplier cannot brighten, so growing light is drawn again; who looks ahead draws as of the brightest
// instant of the run and darkens from there.
TEST(ColorWarp, LightThatGrowsIsFollowedByWhoLooksAhead) {
  const Dimming stage(0.3, 1);
  const auto warped = stage.run(Policy::Threshold);
  EXPECT_GT(renders(warped), 4);
  const auto ahead = stage.run(Policy::Oracle);
  EXPECT_LE(renders(ahead), 2);
  EXPECT_LE(largest_difference(ahead, stage.run(Policy::Reference)), 30);
  EXPECT_LT(ahead[0].plan.decisions[0].shown_color.x, 0.5);
}

TEST(ColorWarp, ReasonNamesTheLight) {
  Dimming stage;
  stage.settings.regulator.color_warp = false;
  bool named = false;
  for (const FrameReport& report : stage.run(Policy::Threshold, false))
    named = named || report.plan.decisions[0].reason.find("(light 'sun')") != std::string::npos;
  EXPECT_TRUE(named);
}

// What is not called for costs nothing: no surface, no normals, no colours, and the bytes of the sprites.
TEST(ColorWarp, NotCalledForNothingIsComputed) {
  const layers::Scene scene = tests::textured_quad_scene();
  const layers::LayerSet layers = layers::factor(scene, tests::one_layer_per_part(scene));
  const Pipeline pipeline = make_pipeline(scene, layers, Settings{});
  EXPECT_FALSE(pipeline.authored.bound(0).surface);
  PipelineState state(pipeline);
  step(pipeline, state, 0, nullptr);
  const FrameReport report = step(pipeline, state, 1, nullptr);
  const layers::LayerState& captured = state.captured.at(1).states[0];
  EXPECT_TRUE(captured.world_normals.empty());
  EXPECT_TRUE(captured.point_colors.empty());
  EXPECT_TRUE(captured.world_from_body.empty());
  EXPECT_FALSE(report.assessments[0].fiducials.photometric.computed);
  EXPECT_THAT(std::string(report.assessments[0].fiducials.photometric.why_not), HasSubstr("no light moves"));
  EXPECT_FALSE(report.assessments[0].fiducials.turned.computed);
}

TEST(ColorWarp, PoliciesThatDoNotWarpDoNotFollowTheLight) {
  for (const Policy policy : {Policy::Reference, Policy::Hold, Policy::Direct}) {
    Dimming stage;
    stage.settings.regulator.policy = policy;
    EXPECT_FALSE(make_pipeline(stage.scene, stage.layers, stage.settings).authored.bound(0).surface);
    for (const FrameReport& report : stage.run(policy, false))
      EXPECT_EQ(report.plan.decisions[0].shown_color, dvec3(1, 1, 1));
  }
}

TEST(ColorWarp, DecisionsSayTheColourAndTheFiducial) {
  Dimming stage;
  const Pipeline pipeline = make_pipeline(stage.scene, stage.layers, stage.settings);
  const auto reports = stage.run(Policy::Threshold, false);
  const auto json = nlohmann::json::parse(json_of(reports.back(), reports.back().plan.decisions[0]));
  EXPECT_NEAR(json["color"][0], 0.3, 1e-6);
  const auto& photometric = json["fiducials"]["photometric"];
  EXPECT_LT(photometric["color"], 0.01);
  EXPECT_NEAR(photometric["light_angle_rad"], std::acos(0.3), 1e-6);
  EXPECT_EQ(photometric["angle_light"], "sun");
  EXPECT_TRUE(json["fiducials"]["turned_px"].is_null());
}

// The light alone moves: nothing but the photometric fiducial can tell.
TEST(ColorWarp, DisplayedColourErrorNeverExceedsTheThreshold) {
  Dimming stage(0.2, 0.9);
  for (const double threshold : {0.01, 0.05, 0.2}) {
    stage.settings.regulator.thresholds.photometric = threshold;
    for (const Policy policy : {Policy::Threshold, Policy::Lookahead, Policy::Oracle})
      for (const FrameReport& report : stage.run(policy, false))
        if (report.plan.decisions[0].action == Action::Reuse) {
          EXPECT_LE(report.assessments[0].fiducials.photometric.color, threshold);
        }
  }
}

TEST(Resolve, OptionsOfLightAndFacesOverrideTheSequence) {
  Sequence sequence;
  sequence.frames = 1;
  sequence.regulator.thresholds.photometric = 0.3;
  CommandLine line;
  EXPECT_EQ(resolve(line, sequence, true).settings.regulator.thresholds.photometric, 0.3);
  line.photometric = 0.1;
  line.light_angle_deg = 180;
  line.turned_px = 8;
  line.color_warp = "off";
  const regulator::RegulatorOptions options = resolve(line, sequence, true).settings.regulator;
  EXPECT_EQ(options.thresholds.photometric, 0.1);
  EXPECT_DOUBLE_EQ(options.thresholds.light_angle_rad, 2 * std::acos(0.0));
  EXPECT_EQ(options.thresholds.turned_px, 8);
  EXPECT_FALSE(options.color_warp);
  line.color_warp = "maybe";
  EXPECT_THAT(tests::message_of([&] { resolve(line, sequence, true); }),
              HasSubstr("--color-warp is 'maybe'"));
  line.color_warp = "on";
  line.light_angle_deg = 181;
  EXPECT_THAT(tests::message_of([&] { resolve(line, sequence, true); }),
              HasSubstr("light_angle_rad is 3.15"));
}

TEST(TurnedFaces, AreRegulatedOnRequest) {
  layers::Scene scene = tests::moving_scene();
  const layers::LayerSet layers = layers::factor(scene, tests::one_layer_per_part(scene));
  Settings settings;
  settings.view.display_px = {200, 150};
  regulator::Thresholds& thresholds = settings.regulator.thresholds;
  thresholds.geometric_px = 1e3;
  thresholds.photometric = thresholds.magnification = thresholds.minification = thresholds.anisotropy = 0;
  thresholds.uncovered_px = -1;
  const auto renders_at = [&](double turned_px) {
    settings.regulator.thresholds.turned_px = turned_px;
    const Pipeline pipeline = make_pipeline(scene, layers, settings);
    PipelineState state(pipeline);
    int n = 0;
    for (int frame = 0; frame < 60; ++frame)
      for (const auto& decision : step(pipeline, state, frame, nullptr).plan.decisions)
        n += decision.action == Action::Rerender;
    return n;
  };
  EXPECT_EQ(renders_at(0), 3) << "first appearances only";
  EXPECT_GT(renders_at(2), renders_at(10));
  EXPECT_GT(renders_at(10), 3);
}

}  // namespace
}  // namespace talisman::sequences
