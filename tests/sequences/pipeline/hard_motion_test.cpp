// SPDX-License-Identifier: Apache-2.0
// Motion that is hard on a regulator: jumps, vanishing and growing layers, time that repeats or runs back,
// options that change on the way, and very long sequences.
#include <cmath>

#include <gtest/gtest.h>

#include "sequences/results/frame_lines.h"
#include "tests/sequences/small_run.h"
#include "tests/support/fleet.h"

namespace talisman::sequences {
namespace {

using layers::dvec3;
using layers::Interpolation;
using regulator::Action;
using regulator::Policy;
using regulator::Prediction;
using regulator::RegulatorOptions;

constexpr double kBound_px = 2;

/// The policies that keep the error bound.
std::vector<RegulatorOptions> bounded_policies() {
  std::vector<RegulatorOptions> all(4);
  all[0].policy = Policy::Threshold;
  all[1].policy = all[2].policy = Policy::Lookahead;
  all[2].lookahead.predict = Prediction::Linear;
  all[3].policy = Policy::Oracle;
  for (RegulatorOptions& options : all) options.thresholds.geometric_px = kBound_px;
  return all;
}

/// The unit cube, 4 m in front of the camera, on a track of 2 s.
SmallRun cube_on(const layers::TransformTrack& track, const RegulatorOptions& options) {
  layers::Scene scene = tests::cube_scene();
  scene.tracks.push_back({scene.parts[0].node, track});
  SmallRun small(std::move(scene));
  small.settings.regulator = options;
  return small;
}

layers::TransformTrack moved_through(std::vector<dvec3> places, Interpolation interpolation) {
  layers::TransformTrack track;
  track.translation.interpolation = interpolation;
  for (std::size_t i = 0; i < places.size(); ++i)
    track.translation.times_s.push_back(2.0 * static_cast<double>(i) / static_cast<double>(places.size()));
  track.translation.values = std::move(places);
  return track;
}

layers::TransformTrack scaled_from_to(const dvec3& from, const dvec3& to) {
  layers::TransformTrack track;
  track.scale = {{0, 2}, {from, to}, Interpolation::Linear};
  return track;
}

/// Every bounded policy keeps its bound on the track, budgets are kept, and every number is a number.
void expect_sound(const layers::TransformTrack& track) {
  for (const RegulatorOptions& options : bounded_policies()) {
    for (const FrameReport& report : cube_on(track, options).run(48, false)) {
      const regulator::LayerDecision& d = report.plan.decisions[0];
      EXPECT_LE(d.shown_geometric_px, kBound_px) << report.frame << ": " << d.reason;
      EXPECT_TRUE(std::isfinite(d.shown_geometric_px + d.warp_geometric_px)) << report.frame;
      EXPECT_EQ(d.action == Action::Drop, !report.assessments[0].in_view);
    }
  }
  RegulatorOptions budget;
  budget.policy = Policy::Budget;
  budget.budget.pixels = 1500;
  for (const FrameReport& report : cube_on(track, budget).run(48, false)) {
    const regulator::LayerDecision& d = report.plan.decisions[0];
    if (report.assessments[0].has_sprite) {
      EXPECT_LE(d.cost.pixels, 1500) << report.frame;
    }
    EXPECT_GE(d.resolution, budget.budget.min_resolution);
    EXPECT_LE(d.resolution, 1);
  }
}

TEST(HardMotion, LayerThatTeleports) {
  expect_sound(moved_through({{-1, 0, 0}, {1, 0.5, -3}, {0, 0, 1}, {-1, -0.5, -20}}, Interpolation::Step));
}

TEST(HardMotion, LayerThatLeavesAndAppearsElsewhere) {
  // Behind the camera, beside it, and so near that it cuts the near plane.
  const auto track = moved_through({{0, 0, 0}, {0, 0, 40}, {0.5, 0, 0}, {90, 0, 0}, {0, 0, 4}, {0, 0, -1}},
                                   Interpolation::Step);
  expect_sound(track);
  for (const RegulatorOptions& options : bounded_policies()) {
    const auto reports = cube_on(track, options).run(48, false);
    EXPECT_EQ(reports[0].plan.decisions[0].reason.rfind("first_appearance", 0), 0u);
    EXPECT_EQ(reports[9].plan.decisions[0].action, Action::Drop);
    EXPECT_NE(reports[16].plan.decisions[0].action, Action::Drop);
    EXPECT_EQ(reports[25].plan.decisions[0].action, Action::Drop);
  }
}

TEST(HardMotion, LayerThatShrinksBelowAPixel) { expect_sound(scaled_from_to(dvec3(1), dvec3(1e-7))); }

TEST(HardMotion, LayerThatVanishesInAPoint) { expect_sound(scaled_from_to(dvec3(1), dvec3(0))); }

TEST(HardMotion, LayerThatGrowsBeyondTheDisplayAndAroundTheCamera) {
  expect_sound(scaled_from_to(dvec3(0.5), dvec3(60)));
}

TEST(HardMotion, FlatLayerThatTurnsEdgeOn) {
  layers::Scene scene = tests::textured_quad_scene();
  layers::TransformTrack turn;
  turn.rotation = {{0, 2}, {{1, 0, 0, 0}, glm::angleAxis(3.0, dvec3(0, 1, 0))}, Interpolation::Linear};
  scene.tracks.push_back({scene.parts[0].node, turn});
  for (const RegulatorOptions& options : bounded_policies()) {
    SmallRun small(scene);
    small.settings.regulator = options;
    for (const FrameReport& report : small.run(48, false))
      EXPECT_LE(report.plan.decisions[0].shown_geometric_px, kBound_px) << report.frame;
  }
}

SmallRun fleet(int layers, unsigned seed, const RegulatorOptions& options) {
  SmallRun small(tests::fleet_scene(layers, seed));
  small.settings.fps = 32;
  small.settings.regulator = options;
  return small;
}

TEST(HardMotion, FrameThatIsRepeatedIsReusedUnchanged) {
  for (const RegulatorOptions& options : bounded_policies()) {
    SmallRun small = fleet(5, 4, options);
    small.settings.frames = 40;
    const Pipeline pipeline = make_pipeline(small.scene, small.layers, small.settings);
    PipelineState state(pipeline);
    for (int frame = 0; frame < 40; ++frame) {
      const FrameReport once = step(pipeline, state, frame, nullptr),
                        again = step(pipeline, state, frame, nullptr);
      for (std::size_t i = 0; i < 5; ++i) {
        const regulator::LayerDecision &a = once.plan.decisions[i], &b = again.plan.decisions[i];
        if (a.action == Action::Drop) continue;
        EXPECT_EQ(b.action, Action::Reuse) << frame << ": " << b.reason;
        EXPECT_EQ(a.depicts_frame, b.depicts_frame);
        EXPECT_NEAR(b.shown_geometric_px, a.shown_geometric_px, 1e-9) << frame;
      }
    }
  }
}

TEST(HardMotion, StepsMayRunBackwardsWithoutLosingTheBoundOrGrowing) {
  RegulatorOptions options;
  options.thresholds.geometric_px = kBound_px;
  const SmallRun small = fleet(5, 4, options);
  const Pipeline pipeline = make_pipeline(small.scene, small.layers, small.settings);
  PipelineState state(pipeline);
  int reuses = 0;
  for (int frame = 100; frame >= 0; --frame) {
    const FrameReport report = step(pipeline, state, frame, nullptr);
    for (const regulator::LayerDecision& d : report.plan.decisions) {
      EXPECT_LE(d.shown_geometric_px, kBound_px) << frame;
      reuses += d.action == Action::Reuse;
    }
    for (const regulator::LayerAssessment& a : report.assessments) EXPECT_GE(a.frames_since_render, 0);
    EXPECT_LE(state.captured.size(), 2u);
  }
  EXPECT_GT(reuses, 100);
}

TEST(HardMotion, ReversedMotionNeedsAsManyRendersOfTheOracle) {
  // Runs cut at the same places serve in both directions; only extents, which grow against the motion,
  // differ.
  RegulatorOptions oracle;
  oracle.policy = Policy::Oracle;
  oracle.thresholds.geometric_px = 1;
  SmallRun forward = fleet(5, 4, oracle), backward = forward;
  backward.scene = tests::reversed_fleet_scene(5, 4);
  const int there = count(forward.run(129, false), Action::Rerender);
  const int back = count(backward.run(129, false), Action::Rerender);
  EXPECT_GT(there, 20);
  EXPECT_NEAR(there, back, 0.05 * there + 1);
}

TEST(HardMotion, OptionsMayChangeOnTheWay) {
  std::vector<RegulatorOptions> options = bounded_policies();
  RegulatorOptions budget;
  budget.policy = Policy::Budget;
  budget.budget.pixels = 150;
  options.insert(options.begin(), budget);
  SmallRun small = fleet(5, 4, budget);
  small.settings.frames = 60;
  PipelineState state(make_pipeline(small.scene, small.layers, small.settings));
  const chunker::PreparedScene prepared(small.scene);
  int coarse = 0;
  for (int frame = 0; frame < 60; ++frame) {
    small.settings.regulator = options[frame / 12];
    const Pipeline pipeline = make_pipeline(small.scene, small.layers, small.settings);
    const FrameReport report = step(pipeline, state, frame, frame % 6 == 5 ? &prepared : nullptr);
    for (const regulator::LayerDecision& d : report.plan.decisions) {
      coarse += frame < 12 && d.resolution < 0.7;
      if (frame < 12 || d.action == Action::Drop) continue;
      EXPECT_LE(d.shown_geometric_px, kBound_px) << frame << ": " << d.reason;
      EXPECT_GT(d.resolution, 0.66) << "what the budget left too coarse is drawn again";
    }
  }
  EXPECT_GT(coarse, 0);
}

TEST(HardMotion, OptionsThatChangeAndComeBackDoNotChangeTheFrame) {
  RegulatorOptions options;
  options.thresholds.geometric_px = 1;
  SmallRun small = fleet(5, 4, options);
  const auto plain = small.run(24, false);
  PipelineState state(make_pipeline(small.scene, small.layers, small.settings));
  for (int frame = 0; frame < 24; ++frame) {
    // Frames from afar are captured under other options in between.
    const Pipeline pipeline = make_pipeline(small.scene, small.layers, small.settings);
    const FrameReport report = step(pipeline, state, frame, nullptr);
    for (std::size_t i = 0; i < 5; ++i)
      EXPECT_EQ(json_of(report, report.plan.decisions[i]),
                json_of(plain[frame], plain[frame].plan.decisions[i]));
    state.planned_with = RegulatorOptions{};
    state.planned_with->policy = Policy::Oracle;
  }
}

TEST(HardMotion, TenThousandFramesOfALoopNeitherDriftNorGrow) {
  // A period of 32 frames of dyadic length: states repeat to the bit, so each layer's plan must become
  // periodic, in a multiple of the period in which its renders fit.
  constexpr int kPeriod = 32, kLong = 10'000, kMostPeriods = 24;
  SmallRun small(tests::fleet_scene(3, 6, 1.0));
  small.settings.fps = kPeriod;
  small.settings.regulator.thresholds.geometric_px = kBound_px;
  const Pipeline pipeline = make_pipeline(small.scene, small.layers, small.settings);
  PipelineState state(pipeline);
  struct Line {
    Action action;
    double error_px;
    int age;
    bool operator==(const Line&) const = default;
  };
  std::vector<std::vector<Line>> lines(3);
  std::size_t points = 0;
  for (int frame = 0; frame < kLong; ++frame) {
    const FrameReport report = step(pipeline, state, frame, nullptr);
    for (const regulator::LayerDecision& d : report.plan.decisions) {
      EXPECT_LE(d.shown_geometric_px, kBound_px);
      lines[d.layer].push_back(
          {d.action, d.shown_geometric_px, report.assessments[d.layer].frames_since_render});
    }
    ASSERT_LE(state.captured.size(), 2u) << frame;
    std::size_t now = 0;
    for (const LayerMemory& memory : state.memory) now += memory.then ? memory.then->world_points.size() : 0;
    if (frame == 100) points = now;
    if (frame > 100) {
      ASSERT_EQ(now, points) << frame;
    }
  }
  for (const std::vector<Line>& layer : lines) {
    const auto repeats_after = [&](int shift) {
      return std::equal(layer.begin() + 1000, layer.end() - shift, layer.begin() + 1000 + shift);
    };
    int periods = 1;
    while (periods <= kMostPeriods && !repeats_after(periods * kPeriod)) ++periods;
    EXPECT_LE(periods, kMostPeriods);
  }
}

}  // namespace
}  // namespace talisman::sequences
