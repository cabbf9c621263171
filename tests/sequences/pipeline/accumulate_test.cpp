// SPDX-License-Identifier: Apache-2.0
// A frame that lasts, against the mean of as many direct pictures.
#include "sequences/pipeline/accumulate.h"

#include <gtest/gtest.h>

#include "tests/sequences/pipeline/shown_plan.h"

namespace talisman::sequences {
namespace {

using namespace shown_plan;

/// By hand: scenes at the instants, drawn one by one.
chunker::Frame mean_of_direct(const ShownPlan& show, int frame, int pictures) {
  Settings settings = show.settings;
  settings.regulator.policy = regulator::Policy::Direct;
  settings.accumulate = 1;
  settings.fps = kPlanFps * pictures;
  settings.frames = kPlanFrames * pictures;
  const Pipeline pipeline = make_pipeline(show.scene, show.layers, settings);
  const chunker::PreparedScene prepared(show.scene, settings.render);
  chunker::Frame mean;
  std::vector<double> sums;
  for (int j = 0; j < pictures; ++j) {
    mean = draw_direct(pipeline, frame * pictures + j, prepared);
    sums.resize(4 * mean.pixels.size());
    for (std::size_t i = 0; i < mean.pixels.size(); ++i) {
      const chunker::Linear16& p = mean.pixels[i];
      const double values[] = {double(p.r), double(p.g), double(p.b), double(p.a)};
      for (int k = 0; k < 4; ++k) sums[4 * i + k] += values[k];
    }
  }
  const auto rounded = [&](std::size_t i) {
    return static_cast<std::uint16_t>(std::floor(sums[i] / pictures + 0.5));
  };
  for (std::size_t i = 0; i < mean.pixels.size(); ++i)
    mean.pixels[i] = {rounded(4 * i), rounded(4 * i + 1), rounded(4 * i + 2), rounded(4 * i + 3)};
  return mean;
}

TEST(Accumulate, IsTheMeanOfDirectPicturesByteForByte) {
  ShownPlan show(swarm_scene(SwarmContent::Shape::Block, 30));
  const chunker::PreparedScene prepared(show.scene, show.settings.render);
  for (const int pictures : {2, 5, 8}) {
    show.settings.accumulate = pictures;
    for (const regulator::Policy policy : {regulator::Policy::Direct, regulator::Policy::Predictive}) {
      Settings settings = show.settings;
      settings.regulator.policy = policy;
      settings.regulator.lookahead.frames = 16;
      const Pipeline pipeline = make_pipeline(show.scene, show.layers, settings);
      PipelineState state(pipeline);
      for (int f = 0; f < 4; ++f) {
        const FrameReport report = step(pipeline, state, f, &prepared);
        ASSERT_TRUE(same_picture(report.picture, mean_of_direct(show, f, pictures)))
            << pictures << " pictures, frame " << f << ", " << regulator::name(policy);
        EXPECT_EQ(report.frame, f);
        ASSERT_TRUE(same_picture(report.picture, draw_direct(pipeline, f, prepared)));
      }
    }
  }
}

TEST(Accumulate, WhatRestsIsDrawnOnceAndWhatMovesInEachPicture) {
  ShownPlan show(swarm_scene(SwarmContent::Shape::Block, 25));
  show.settings.accumulate = 8;
  show.settings.regulator.lookahead.frames = 8;
  const Pipeline pipeline = make_pipeline(show.scene, show.layers, show.settings);
  const chunker::PreparedScene prepared(show.scene, show.settings.render);
  PipelineState state(pipeline);
  const FrameReport report = step(pipeline, state, 0, &prepared);
  EXPECT_EQ(report.predictive->parts, 8 * 40);
  EXPECT_LE(report.predictive->parts_drawn, 8 * 10 + 30);
  EXPECT_GE(report.predictive->parts_drawn, 30);
  EXPECT_EQ(report.plan.decisions[0].cost.polygons, report.render.polygons_in);
}

TEST(Accumulate, OnePictureIsTheFrameItself) {
  ShownPlan show(swarm_scene(SwarmContent::Shape::Block, 30));
  const chunker::PreparedScene prepared(show.scene, show.settings.render);
  const std::vector<chunker::Frame> truth = show.direct();
  show.settings.accumulate = 1;
  const Pipeline pipeline = make_pipeline(show.scene, show.layers, show.settings);
  PipelineState state(pipeline);
  EXPECT_TRUE(same_picture(step(pipeline, state, 0, &prepared).picture, truth[0]));
}

// Nothing moves: the mean of equal pictures is that picture, for a number that does not divide.
TEST(Accumulate, OfWhatRestsItIsThePicture) {
  ShownPlan show(swarm_scene(SwarmContent::Shape::Block, 0));
  const chunker::PreparedScene prepared(show.scene, show.settings.render);
  const std::vector<chunker::Frame> truth = show.direct();
  show.settings.accumulate = 7;
  const Pipeline pipeline = make_pipeline(show.scene, show.layers, show.settings);
  PipelineState state(pipeline);
  EXPECT_TRUE(same_picture(step(pipeline, state, 2, &prepared).picture, truth[2]));
}

TEST(Accumulate, PlanAndDrawingAgreeAndFramesMayComeInAnyOrder) {
  ShownPlan show(swarm_scene(SwarmContent::Shape::Block, 30));
  show.settings.accumulate = 4;
  show.settings.regulator.lookahead.frames = 8;
  show.settings.regulator.thresholds.geometric_px = 0.4;
  const Pipeline pipeline = make_pipeline(show.scene, show.layers, show.settings);
  const chunker::PreparedScene prepared(show.scene, show.settings.render);
  PipelineState drawn(pipeline), planned(pipeline);
  std::vector<chunker::Frame> frames;
  for (int f = 0; f < 6; ++f) {
    const FrameReport a = step(pipeline, drawn, f, &prepared), b = step(pipeline, planned, f, nullptr);
    EXPECT_EQ(a.plan.decisions[0].cost, b.plan.decisions[0].cost);
    EXPECT_EQ(a.plan.decisions[0].reason, b.plan.decisions[0].reason);
    frames.push_back(a.picture);
  }
  PipelineState anyhow(pipeline);
  for (const int f : {5, 2, 2, 0, 4})
    EXPECT_TRUE(same_picture(step(pipeline, anyhow, f, &prepared).picture, frames[f])) << f;
}

}  // namespace
}  // namespace talisman::sequences
