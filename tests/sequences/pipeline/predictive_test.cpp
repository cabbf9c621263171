// SPDX-License-Identifier: Apache-2.0
// Frames out of shared buffers with depth, against one pass over all parts.
#include "sequences/pipeline/predictive/plan_buffers.h"

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <random>
#include <set>
#include <thread>

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>
#include <tbb/task_scheduler_observer.h>

#include "tests/sequences/pipeline/shown_plan.h"

namespace talisman::sequences {
namespace {

using namespace shown_plan;

const std::vector<PlanShape> kShapes = {{1, 2}, {2, 2}, {8, 2}, {16, 4}, {9, 3}, {5, 5}, {32, 2}};

void expect_equal_to_direct(const ShownPlan& show, const std::string& what) {
  const std::vector<chunker::Frame> truth = show.direct();
  const chunker::PreparedScene prepared(show.scene, show.settings.render);
  for (const PlanShape& shape : kShapes)
    for (const Joining joining : regulator::kAllJoinings) {
      const Pipeline pipeline = show.pipeline(shape, joining);
      PipelineState state(pipeline);
      for (int f = 0; f < kPlanFrames; ++f)
        ASSERT_TRUE(same_picture(step(pipeline, state, f, &prepared).picture, truth[f]))
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
      ASSERT_TRUE(same_picture(step(pipeline, state, f, &prepared).picture, truth[f]))
          << f << " " << regulator::name(joining);
    // Planned, and not drawn: what a later frame needs is drawn then.
    PipelineState skipping(pipeline);
    for (int f = 0; f < kPlanFrames; ++f) {
      const FrameReport report = step(pipeline, skipping, f, f % 3 == 2 ? &prepared : nullptr);
      if (f % 3 == 2) {
        ASSERT_TRUE(same_picture(report.picture, truth[f])) << f << " " << regulator::name(joining);
      }
    }
  }
}

/// Threads that have worked in an arena.
class Workers : public tbb::task_scheduler_observer {
 public:
  explicit Workers(tbb::task_arena& arena) : tbb::task_scheduler_observer(arena) { observe(true); }
  ~Workers() override { observe(false); }
  void on_scheduler_entry(bool) override {
    const std::lock_guard lock(mutex_);
    threads_.insert(std::this_thread::get_id());
  }
  std::size_t count() {
    const std::lock_guard lock(mutex_);
    return threads_.size();
  }

 private:
  std::mutex mutex_;
  std::set<std::thread::id> threads_;
};

/// As many jobs at the same time as there are threads: none ends before all have begun.
void meet_all(int threads) {
  std::atomic<int> begun{0};
  tbb::task_group group;
  const auto wait = [&] {
    ++begun;
    while (begun < threads) std::this_thread::yield();
  };
  for (int i = 1; i < threads; ++i) group.run(wait);
  wait();
  group.wait();
}

TEST(Predictive, OneTwoAndThreeThreadsThatWorkTogetherChangeNothing) {
  ShownPlan show(swarm_scene(SwarmContent::Shape::Sphere, 25));
  show.settings.regulator.thresholds.geometric_px = 0.7;
  show.settings.render.samples = 16;
  show.settings.view.display_px = {170, 130};  // many chunks
  const chunker::PreparedScene prepared(show.scene, show.settings.render);
  for (const Joining joining : {Joining::EachFrame, Joining::InPlace}) {
    const Pipeline pipeline = show.pipeline({8, 2}, joining);
    std::vector<chunker::Frame> first;
    for (const int threads : {1, 2, 3}) {
      const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism,
                                        4);  // more than cores, perhaps
      tbb::task_arena arena(threads);
      Workers workers(arena);
      PipelineState state(pipeline);
      for (int f = 0; f < kPlanFrames; ++f) {
        const chunker::Frame frame = arena.execute([&] {
          meet_all(threads);
          return step(pipeline, state, f, &prepared).picture;
        });
        if (threads == 1)
          first.push_back(frame);
        else
          ASSERT_TRUE(same_picture(frame, first[f])) << f << " " << threads;
      }
      EXPECT_GE(workers.count(), static_cast<std::size_t>(threads));
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
    for (int f = 0; f < kPlanFrames; ++f) {
      const FrameReport report = step(pipeline, state, f, &prepared);
      for (const regulator::LayerDecision& decision : report.plan.decisions)
        ASSERT_LE(decision.shown_geometric_px, 1.5);
      if (joining == Joining::EachFrame)
        first.push_back(report.picture);
      else
        ASSERT_TRUE(same_picture(report.picture, first[f])) << f << " " << regulator::name(joining);
    }
  }
}

TEST(Predictive, PlanAndDrawingAgree) {
  const ShownPlan show(swarm_scene(SwarmContent::Shape::Block, 30));
  const chunker::PreparedScene prepared(show.scene, show.settings.render);
  const Pipeline pipeline = show.pipeline({8, 2}, Joining::Copy);
  PipelineState planned(pipeline), drawn(pipeline);
  for (int f = 0; f < kPlanFrames; ++f) {
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
