// SPDX-License-Identifier: Apache-2.0
// Frames out of shared buffers with depth, against one pass over all parts.
#include "sequences/pipeline/predictive/plan_buffers.h"

#include <map>
#include <memory>
#include <random>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include "sequences/content/swarm/swarm.h"
#include "sequences/pipeline/step.h"
#include "tests/support/scenes.h"

namespace talisman::sequences {
namespace {

using regulator::Joining;
using regulator::PlanShape;

constexpr int kFrames = 13;  // no multiple of any slice
constexpr double kFps = 30;

/// A swarm of which a part moves, before the camera of a small scene.
layers::Scene swarm_scene(SwarmContent::Shape shape, double moving, int count = 40) {
  layers::Scene scene = tests::cube_scene();
  scene.parts.clear();
  SwarmContent swarm;
  swarm.shape = shape;
  swarm.count = count;
  swarm.cube_m = 6;
  swarm.moving_percent = moving;
  swarm.seed = 5;
  add_swarm(scene, swarm, kFps, kFrames / kFps);
  return scene;
}

/// Squares in one plane that faces the eye, of which every second moves in it: where they overlap depths are equal.
layers::Scene coplanar_scene() {
  layers::Scene scene = swarm_scene(SwarmContent::Shape::Quad, 50);
  for (layers::Node& node : scene.nodes) {
    node.local.translation.z = 0;
    node.local.rotation = glm::dquat(1, 0, 0, 0);
  }
  std::erase_if(scene.tracks, [](const layers::Track& track) {
    return std::holds_alternative<layers::SpinTrack>(track.motion);
  });
  for (layers::Track& track : scene.tracks)
    for (layers::dvec3& at : std::get<layers::TransformTrack>(track.motion).translation.values) at.z = 0;
  layers::Camera& camera = scene.cameras[static_cast<std::size_t>(scene.active_camera)];
  scene.nodes.push_back({"camera", -1, {{0, 0, 9}, {1, 0, 0, 0}, {1, 1, 1}}});
  camera.node = static_cast<int>(scene.nodes.size()) - 1;
  return scene;
}

struct ShownPlan {
  explicit ShownPlan(layers::Scene in) : scene(std::move(in)) {
    layers::LayerSpec spec;
    spec.name = "all";
    spec.part_globs = {"*"};
    layers = layers::factor(scene, {&spec, 1});
    settings.view.display_px = {70, 52};
    settings.render.samples = 1;
    settings.regulator.policy = regulator::Policy::Predictive;
    settings.regulator.thresholds.geometric_px = 0;
    settings.fps = kFps;
    settings.frames = kFrames;
  }
  Pipeline pipeline(const PlanShape& shape, Joining joining) const {
    Settings own = settings;
    own.regulator.lookahead.frames = shape.frames;
    own.regulator.predictive = {shape.children, joining, regulator::MotionNorm::Euclid};
    return make_pipeline(scene, layers, own);
  }
  std::vector<chunker::Frame> direct() const {
    Settings own = settings;
    own.regulator.policy = regulator::Policy::Direct;
    const Pipeline truth = make_pipeline(scene, layers, own);
    const chunker::PreparedScene prepared(scene, own.render);
    std::vector<chunker::Frame> frames;
    for (int f = 0; f < kFrames; ++f) frames.push_back(draw_direct(truth, f, prepared));
    return frames;
  }
  layers::Scene scene;
  layers::LayerSet layers;
  Settings settings;
};

bool same(const chunker::Frame& a, const chunker::Frame& b) { return a.pixels == b.pixels; }

const std::vector<PlanShape> kShapes = {{1, 2}, {2, 2}, {8, 2}, {16, 4}, {9, 3}, {5, 5}, {32, 2}};

void expect_equal_to_direct(const ShownPlan& show, const std::string& what) {
  const std::vector<chunker::Frame> truth = show.direct();
  const chunker::PreparedScene prepared(show.scene, show.settings.render);
  for (const PlanShape& shape : kShapes)
    for (const Joining joining : regulator::kAllJoinings) {
      const Pipeline pipeline = show.pipeline(shape, joining);
      PipelineState state(pipeline);
      for (int f = 0; f < kFrames; ++f)
        ASSERT_TRUE(same(step(pipeline, state, f, &prepared).picture, truth[f]))
            << what << ": frame " << f << ", N " << shape.frames << ", k " << shape.children << ", "
            << regulator::name(joining);
    }
}

TEST(Predictive, WithDeltaZeroAndOneSampleEveryFrameIsThatOfOnePass) {
  expect_equal_to_direct(ShownPlan(swarm_scene(SwarmContent::Shape::Block, 30)), "blocks");
  expect_equal_to_direct(ShownPlan(swarm_scene(SwarmContent::Shape::Quad, 50)), "quads");
}

TEST(Predictive, WhereDepthsAreEqualTheOrderOfPartsDecidesAsInOnePass) {
  expect_equal_to_direct(ShownPlan(coplanar_scene()), "coplanar");
}

TEST(Predictive, NothingMovesAllMovesAndACameraThatFlies) {
  expect_equal_to_direct(ShownPlan(swarm_scene(SwarmContent::Shape::Molecule, 0, 12)), "rest");
  expect_equal_to_direct(ShownPlan(swarm_scene(SwarmContent::Shape::Sphere, 100, 12)), "all");
  expect_equal_to_direct(ShownPlan(tests::moving_scene()), "camera");
  expect_equal_to_direct(ShownPlan(tests::skinned_bar_scene()), "deforms");
}

TEST(Predictive, FramesMayComeInAnyOrder) {
  const ShownPlan show(swarm_scene(SwarmContent::Shape::Block, 30));
  const std::vector<chunker::Frame> truth = show.direct();
  const chunker::PreparedScene prepared(show.scene, show.settings.render);
  const std::vector<int> order = {7, 7, 6, 0, 12, 3, 4, 4, 5, 11, 10, 9, 8, 2, 1, 0, 12};
  for (const Joining joining : regulator::kAllJoinings) {
    const Pipeline pipeline = show.pipeline({8, 2}, joining);
    PipelineState state(pipeline);
    for (const int f : order)
      ASSERT_TRUE(same(step(pipeline, state, f, &prepared).picture, truth[f]))
          << f << " " << regulator::name(joining);
    // Planned, and not drawn: what a later frame needs is drawn then.
    PipelineState skipping(pipeline);
    for (int f = 0; f < kFrames; ++f) {
      const FrameReport report = step(pipeline, skipping, f, f % 3 == 2 ? &prepared : nullptr);
      if (f % 3 == 2) {
        ASSERT_TRUE(same(report.picture, truth[f])) << f << " " << regulator::name(joining);
      }
    }
  }
}

TEST(Predictive, ThreadsChangeNothing) {
  ShownPlan show(swarm_scene(SwarmContent::Shape::Sphere, 25));
  show.settings.regulator.thresholds.geometric_px = 0.7;
  show.settings.render.samples = 16;
  const Pipeline pipeline = show.pipeline({8, 2}, Joining::InPlace);
  const chunker::PreparedScene prepared(show.scene, show.settings.render);
  std::vector<chunker::Frame> first;
  for (const int threads : {1, 2, 3}) {
    tbb::task_arena arena(threads);
    PipelineState state(pipeline);
    for (int f = 0; f < kFrames; ++f) {
      const chunker::Frame frame = arena.execute([&] { return step(pipeline, state, f, &prepared).picture; });
      if (threads == 1)
        first.push_back(frame);
      else
        ASSERT_TRUE(same(frame, first[f])) << f;
    }
  }
}

TEST(Predictive, AllWaysOfJoiningShowTheSameWhateverDeltaAndSamples) {
  ShownPlan show(swarm_scene(SwarmContent::Shape::Block, 40));
  show.settings.regulator.thresholds.geometric_px = 1.5;
  const chunker::PreparedScene prepared(show.scene, show.settings.render);
  std::vector<chunker::Frame> first;
  for (const Joining joining : regulator::kAllJoinings) {
    const Pipeline pipeline = show.pipeline({8, 2}, joining);
    PipelineState state(pipeline);
    for (int f = 0; f < kFrames; ++f) {
      const FrameReport report = step(pipeline, state, f, &prepared);
      for (const regulator::LayerDecision& decision : report.plan.decisions)
        ASSERT_LE(decision.shown_geometric_px, 1.5);
      if (joining == Joining::EachFrame)
        first.push_back(report.picture);
      else
        ASSERT_TRUE(same(report.picture, first[f])) << f << " " << regulator::name(joining);
    }
  }
}

TEST(Predictive, PlanAndDrawingAgree) {
  const ShownPlan show(swarm_scene(SwarmContent::Shape::Block, 30));
  const chunker::PreparedScene prepared(show.scene, show.settings.render);
  const Pipeline pipeline = show.pipeline({8, 2}, Joining::Copy);
  PipelineState planned(pipeline), drawn(pipeline);
  for (int f = 0; f < kFrames; ++f) {
    const FrameReport plan = step(pipeline, planned, f, nullptr),
                      picture = step(pipeline, drawn, f, &prepared);
    ASSERT_EQ(plan.plan.decisions.size(), picture.plan.decisions.size());
    for (std::size_t i = 0; i < plan.plan.decisions.size(); ++i) {
      const regulator::LayerDecision &a = plan.plan.decisions[i], &b = picture.plan.decisions[i];
      EXPECT_EQ(a.reason, b.reason);
      EXPECT_EQ(a.cost, b.cost);
      EXPECT_EQ(a.action, b.action);
      EXPECT_EQ(a.cost.polygons, picture.render.polygons_in) << "all that is planned is sent to the renderer";
    }
    EXPECT_EQ(plan.predictive->joins_planned, picture.predictive->joins_planned);
    EXPECT_EQ(plan.predictive->parts_drawn, picture.predictive->parts_drawn);
  }
}

TEST(Predictive, JoinsOfASliceAreThoseOfTheFormulas) {
  ShownPlan show(swarm_scene(SwarmContent::Shape::Block, 30, 6));
  show.settings.frames = 64;
  for (const PlanShape& shape : {PlanShape{8, 2}, {16, 4}, {9, 3}, {32, 2}, {5, 5}})
    for (const Joining joining : regulator::kAllJoinings) {
      const Pipeline pipeline = show.pipeline(shape, joining);
      PipelineState state(pipeline);
      std::int64_t joins = 0;
      for (int f = 0; f < shape.frames; ++f)
        joins += step(pipeline, state, f, nullptr).predictive->joins_planned;
      EXPECT_EQ(joins, regulator::joins_of_slice(shape, joining)) << shape.frames << " " << shape.children;
    }
}

TEST(Predictive, BuffersThatNoPartBelongsToTakeNoMemory) {
  // Nothing moves: one buffer of the six holds anything.
  const ShownPlan show(swarm_scene(SwarmContent::Shape::Block, 0));
  const Pipeline pipeline = show.pipeline({32, 2}, Joining::InPlace);
  const chunker::PreparedScene prepared(show.scene, show.settings.render);
  PipelineState state(pipeline);
  const FrameReport first = step(pipeline, state, 0, &prepared), second = step(pipeline, state, 1, &prepared);
  const std::int64_t chunks = 3 * 2;
  EXPECT_LE(first.predictive->buffer_bytes, chunks * 1024 * 12 + 6 * 4 * chunks);
  EXPECT_EQ(second.predictive->joined, chunker::JoinCounters{}) << "no join, no copy, no clearing";
  EXPECT_EQ(second.predictive->parts_drawn, 0);
  EXPECT_EQ(second.render.polygons_in, 0);
}

TEST(Predictive, AnotherPolicyHasNeitherWordsNorBuffers) {
  const ShownPlan show(swarm_scene(SwarmContent::Shape::Block, 30));
  Settings settings = show.settings;
  settings.regulator.policy = regulator::Policy::Threshold;
  const Pipeline pipeline = make_pipeline(show.scene, show.layers, settings);
  PipelineState state(pipeline);
  EXPECT_FALSE(step(pipeline, state, 0, nullptr).predictive.has_value());
  EXPECT_EQ(state.predictive, nullptr);
}

TEST(Predictive, TenThousandFramesWithoutGrowth) {
  ShownPlan show(swarm_scene(SwarmContent::Shape::Quad, 50, 3));
  show.settings.view.display_px = {33, 20};
  show.settings.frames = 10'000;
  const Pipeline pipeline = show.pipeline({8, 2}, Joining::InPlace);
  const chunker::PreparedScene prepared(show.scene, show.settings.render);
  PipelineState state(pipeline);
  std::int64_t early = 0, late = 0;
  for (int f = 0; f < 10'000; ++f) {
    const FrameReport report = step(pipeline, state, f, f % 8 == 7 || f < 100 ? &prepared : nullptr);
    if (f < 100) early = std::max(early, state.predictive->bytes());
    late = std::max(late, state.predictive->bytes());
    (void)report;
  }
  EXPECT_EQ(early, late);
}

TEST(Unpredictable, WhatNeedsAnOrderIsRefusedByName) {
  layers::Scene scene = tests::cube_scene();
  layers::LayerSpec spec;
  spec.name = "all";
  spec.part_globs = {"*"};
  EXPECT_EQ(unpredictable(scene, layers::factor(scene, {&spec, 1})), "");
  spec.fade = {{0, 1}, {1, 0}};
  EXPECT_EQ(unpredictable(scene, layers::factor(scene, {&spec, 1})).find("layer 'all' is faded"), 0u);
  spec.fade = {};
  scene.materials.front().opacity = 0.5f;
  scene.materials.front().name = "glass";
  EXPECT_EQ(unpredictable(scene, layers::factor(scene, {&spec, 1})).find("material 'glass' has opacity < 1"),
            0u);
}

}  // namespace
}  // namespace talisman::sequences
