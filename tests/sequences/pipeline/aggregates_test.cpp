// SPDX-License-Identifier: Apache-2.0
// Merging and splitting through the whole pipeline: decisions, reasons, sprites and what is remembered.
#include "sequences/pipeline/aggregates.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/commands/inspect/inspect_order.h"
#include "sequences/commands/options.h"
#include "sequences/content/layer_pairs.h"
#include "sequences/results/summary.h"
#include "tests/sequences/playback.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using regulator::Action;
using regulator::Policy;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using tests::message_of;
using tests::Playback;
using tests::TemporaryFolder;

/// A wall at rest, a ball that flies through it from the right to the left and back, and a bystander that
/// touches neither; the camera rests. A frame is a second. Wall and ball meet while the ball's centre is
/// within 1.5 m of the wall's.
const std::string kCrossing =
    "frames: 80\n"
    "fps: 1\n"
    "display: [160, 120]\n"
    "shapes:\n"
    "  - {id: wall, box: [1, 4, 4], color: [0.6, 0.5, 0.4]}\n"
    "  - id: ball\n"
    "    sphere: 2\n"
    "    segments: 12\n"
    "    flight: [{t: 0, position: [5, 0, 0], target: [-100, 0, 0]}, {t: 10, position: [-5, 0, 0], target: "
    "[-100, 0, 0]},\n"
    "             {t: 20, position: [5, 0, 0], target: [-100, 0, 0]}]\n"
    "  - {id: bystander, box: [1, 1, 1], position: [0, 4, -3]}\n"
    "camera: {fov_deg: 60, near_m: 1, far_m: 100, position: [0, 0, 14], look_at: [0, 0, 0]}\n"
    "layers:\n"
    "  - {name: wall, parts: [wall]}\n"
    "  - {name: ball, parts: [ball]}\n"
    "  - {name: bystander, parts: [bystander]}\n";
constexpr int kWall = 0, kBall = 1, kBystander = 2, kBoth = 3;

Sequence crossing(const std::string& more = "") {
  const TemporaryFolder folder;
  return load_sequence(folder.write("crossing.yaml", kCrossing + more));
}

Settings settings_of(const Sequence& sequence, Policy policy = Policy::Threshold) {
  Settings settings = resolve({}, sequence, true).settings;
  settings.regulator.policy = policy;
  settings.regulator.budget.pixels = 20'000;
  settings.regulator.lookahead.frames = 3;
  return settings;
}

/// Do wall and ball meet? Their bounds are boxes, and the ball flies along x.
bool meet(const Sequence& s, int frame) {
  const layers::SceneFrame now = s.scene->at(frame);
  return std::abs(now.world_from_node[s.scene->parts[kBall].node][3].x) < 1.5;
}

int first_meeting(const Sequence& s) {
  int frame = 0;
  while (!meet(s, frame)) ++frame;
  return frame;
}

TEST(Aggregates, CrossingBodiesShareASpriteWhileTheyMeet) {
  const Sequence s = crossing();
  Playback run(s, settings_of(s));
  const int first = first_meeting(s);
  ASSERT_GT(first, 0);
  int frames_since_meeting = 100, splits = 0;
  for (const FrameReport& report : run.all(30)) {
    frames_since_meeting = meet(s, report.frame) ? 0 : frames_since_meeting + 1;
    const bool is_merged = report.order.merged_into[kWall] == kBoth;
    EXPECT_EQ(is_merged, frames_since_meeting <= layers::VisibilityOptions{}.release_frames) << report.frame;
    const auto& decisions = report.plan.decisions;
    EXPECT_EQ(report.order.merged_into[kBystander], -1);
    EXPECT_EQ(decisions[kWall].action == Action::Drop, is_merged);
    EXPECT_EQ(decisions[kBall].action == Action::Drop, is_merged);
    EXPECT_EQ(report.shown.size(), is_merged ? 2u : 3u);
    splits += decisions[kWall].reason.rfind("split from wall+ball: ", 0) == 0;
    if (!is_merged) continue;
    ASSERT_EQ(decisions.size(), 4u);
    EXPECT_THAT(decisions[kWall].reason, StartsWith("merged into wall+ball: "));
    EXPECT_NE(decisions[kBoth].action, Action::Drop);
    EXPECT_THAT(decisions[kBoth].reason, HasSubstr("; merged: "));
    if (report.frame == first) {
      EXPECT_THAT(decisions[kBoth].reason, StartsWith("first_appearance; merged: "));
      EXPECT_THAT(decisions[kBoth].reason, HasSubstr("occlude each other"));
    }
  }
  EXPECT_EQ(splits, 2);  // the ball passes twice
}

TEST(Aggregates, OldSpritesOfMembersServeAgainAfterTheSplit) {
  // Wall and camera rest: whatever was merged meanwhile, the wall's own sprite of frame 0 stays right.
  const Sequence s = crossing();
  Playback run(s, settings_of(s), true);
  int wall_renders = 0;
  for (const FrameReport& report : run.all(40))
    wall_renders += report.plan.decisions[kWall].action == Action::Rerender;
  EXPECT_EQ(wall_renders, 1);
}

TEST(Aggregates, TheSameLayersHaveTheSameAggregateAgain) {
  const Sequence s = crossing();
  Playback run(s, settings_of(s));
  int mergers = 0;
  for (const FrameReport& report : run.all(40)) mergers += !report.order.mergers.empty();
  EXPECT_GT(mergers, 8);  // two passages
  EXPECT_EQ(run.state.layers.size(), 4u);
  EXPECT_EQ(run.state.layers[kBoth].name, "wall+ball");
}

// Aggregates belong to the state, not to the pipeline under which they were made.
TEST(Aggregates, StateThatIsCarriedOnFollowsTheSettingsOfItsNewPipeline) {
  const Sequence s = crossing();
  Playback run(s, settings_of(s));
  const int first = first_meeting(s);
  const LayerTable before = run.all(first + 1).back().layers;
  ASSERT_EQ(before.size(), 4u);
  ASSERT_FALSE(before.bound(kBoth).follows_faces);
  Settings changed = settings_of(s, Policy::Reference);
  changed.regulator.thresholds.turned_px = 1;
  const Pipeline pipeline = make_pipeline(*s.scene, s.layers, changed);
  const FrameReport report = step(pipeline, run.state, first + 1, nullptr);
  ASSERT_EQ(report.order.merged_into[kWall], kBoth);
  EXPECT_THAT(report.plan.decisions[kBoth].reason, StartsWith("policy: reference"));
  ASSERT_EQ(report.layers.size(), 4u);
  EXPECT_EQ(report.layers[kBoth].name, "wall+ball");
  for (const layers::Layer& layer : report.layers)
    EXPECT_TRUE(report.layers.bound(layer.id).follows_faces) << layer.name;
  EXPECT_FALSE(before.bound(kBoth).follows_faces) << "who holds a table keeps it as it was";
}

TEST(Aggregates, SpriteIsGivenUpWhenItsAggregateIsGoneForLong) {
  const Sequence s = crossing();
  Playback run(s, settings_of(s), true);
  int last_merged = -1;
  for (const FrameReport& report : run.all(40))
    if (!report.order.mergers.empty()) last_merged = report.frame;
  EXPECT_NE(run.state.sprites.find(kBoth), nullptr);
  run.all(last_merged + kKeepAggregate_frames);
  EXPECT_NE(run.state.sprites.find(kBoth), nullptr);
  run.next();
  EXPECT_EQ(run.state.sprites.find(kBoth), nullptr);
  EXPECT_FALSE(run.state.memory[kBoth].then.has_value());
}

TEST(Aggregates, EveryPolicyDecidesTheSameWithAndWithoutPixels) {
  const Sequence s = crossing();
  for (const Policy policy : {Policy::Reference, Policy::Hold, Policy::Interpolate, Policy::Threshold,
                              Policy::Budget, Policy::Lookahead, Policy::Oracle}) {
    SCOPED_TRACE(std::string(regulator::name(policy)));
    Playback planned(s, settings_of(s, policy)), drawn(s, settings_of(s, policy), true);
    int merged_frames = 0;
    for (int frame = 0; frame < 24; ++frame) {
      const FrameReport a = planned.next(), b = drawn.next();
      ASSERT_EQ(a.plan.decisions.size(), b.plan.decisions.size());
      for (const regulator::LayerDecision& d : a.plan.decisions)
        ASSERT_EQ(json_of(a, d), json_of(b, b.plan.decisions[d.layer]));
      merged_frames += !a.order.mergers.empty();
      EXPECT_EQ(b.shown.size(), a.order.mergers.empty() ? 3u : 2u);
    }
    EXPECT_GT(merged_frames, 5);
  }
}

TEST(Aggregates, FrameDrawnAloneHasTheBytesOfTheWholeRun) {
  // What --frames and --resume rely on: frames before it are only planned.
  const Sequence s = crossing();
  Playback whole(s, settings_of(s), true);
  const auto reports = whole.all(13);
  for (const int wanted : {first_meeting(s), 12}) {
    Playback late(s, settings_of(s));
    late.all(wanted);
    late.prepared.emplace(*s.scene);
    EXPECT_EQ(hash_of(late.next().picture), hash_of(reports[wanted].picture)) << wanted;
  }
}

TEST(Aggregates, DirectNeitherSortsNorMerges) {
  const Sequence s = crossing();
  Playback run(s, settings_of(s, Policy::Direct));
  for (const FrameReport& report : run.all(10)) {
    EXPECT_FALSE(report.order.sorted);
    EXPECT_EQ(report.plan.decisions.size(), 3u);
  }
}

TEST(Aggregates, CyclesThatAreKeptAreNeverMerged) {
  const Sequence s = crossing("cycles: keep\n");
  EXPECT_EQ(s.cycles, Cycles::Keep);
  Playback run(s, settings_of(s));
  for (const FrameReport& report : run.all(12)) {
    EXPECT_TRUE(report.order.mergers.empty());
    EXPECT_EQ(report.shown.size(), 3u);
  }
}

TEST(Aggregates, AuthorsOrderReplacesGeometry) {
  const Sequence s = crossing("order: [{behind: ball, front: 'wal?'}]\n");
  Playback run(s, settings_of(s));
  for (const FrameReport& report : run.all(12)) {
    EXPECT_TRUE(report.order.mergers.empty());
    const auto& order = report.order.back_to_front;
    EXPECT_LT(std::find(order.begin(), order.end(), kBall), std::find(order.begin(), order.end(), kWall));
  }
}

TEST(Aggregates, LayersThatTheirGroupsOrderAreNotSorted) {
  const Sequence all = crossing();
  Sequence s = all;
  s.layers.layers[kWall].group = layers::OrderGroup::Foreground;
  s.layers.layers[kBystander].group = layers::OrderGroup::Background;
  Playback run(s, settings_of(s));
  for (const FrameReport& report : run.all(8)) {
    EXPECT_FALSE(report.order.sorted);
    EXPECT_EQ(report.order.counters.queries, 0);
    EXPECT_EQ(report.order.back_to_front, (std::vector{kBystander, kBall, kWall}));
    EXPECT_FALSE(line_of(report).visibility.has_value());
  }
}

TEST(Aggregates, LayersOutOfViewTakeNoPart) {
  Sequence s = crossing();
  layers::Scene scene = *s.scene;
  for (layers::Node& node : scene.nodes)
    if (node.name == "bystander") node.local.translation = {0, 0, 50};  // behind the camera
  s.scene = std::make_shared<const layers::Scene>(scene);
  Playback run(s, settings_of(s));
  const FrameReport report = run.next();
  EXPECT_EQ(report.order.back_to_front.size(), 2u);
  EXPECT_EQ(report.order.counters.layers, 2);
  EXPECT_EQ(report.plan.decisions[kBystander].reason, "out_of_view");
}

TEST(Aggregates, ResultsNameThem) {
  const Sequence s = crossing();
  Playback run(s, settings_of(s), true);
  Summary summary = start_summary(run.pipeline, "crossing");
  int lines = 0, merged_frames = 0;
  for (int frame = 0; frame < 20; ++frame) {
    const FrameReport report = run.next();
    add_decisions(summary, report, run.state);
    lines += static_cast<int>(layers_with_lines(run.state, report).size());
    merged_frames += !report.order.mergers.empty();
    summary.frames.push_back(line_of(report));
    const auto again = frame_line_from_json(json_of(summary.frames.back()));
    ASSERT_TRUE(again.has_value());
    EXPECT_EQ(json_of(*again), json_of(summary.frames.back()));
  }
  EXPECT_EQ(lines, 20 * 3 + merged_frames);
  ASSERT_EQ(summary.layers.size(), 4u);
  EXPECT_EQ(summary.layers[kBoth].name, "wall+ball");
  EXPECT_GT(summary.layers[kBoth].renders, 0);
  EXPECT_EQ(summary.layers[kBall].merged_renders, summary.layers[kBoth].renders);
  EXPECT_EQ(summary.layers[kBoth].frames_shown, merged_frames);
  EXPECT_EQ(summary.layers[kBall].frames_shown, 20 - merged_frames);
  for (std::size_t e = 0; e < summary.effects.size(); ++e)
    if (summary.effects[e].effect == layers::Effect::VisibilitySort) {
      EXPECT_TRUE(summary.effects[e].called);
      EXPECT_EQ(summary.effect_passes[e], 20);
    } else if (summary.effects[e].effect == layers::Effect::Lighting) {
      int renders = 0;  // every layer is lit, aggregates by their members
      for (const LayerSummary& layer : summary.layers) renders += layer.renders;
      EXPECT_EQ(summary.effect_passes[e], renders);
    }
  EXPECT_THAT(json_of(summary), HasSubstr("\"merged_layers\": " + std::to_string(2 * merged_frames)));
}

TEST(OrderOverTime, RunsCoverEveryFrameOnceAndCyclesHaveFirstAndLastFrame) {
  const Sequence s = crossing();
  const OrderOverTime order = order_over_time(s, settings_of(s));
  ASSERT_FALSE(order.runs.empty());
  EXPECT_EQ(order.runs.front().first, 0);
  EXPECT_EQ(order.runs.back().last, 79);
  for (std::size_t i = 1; i < order.runs.size(); ++i) {
    EXPECT_EQ(order.runs[i].first, order.runs[i - 1].last + 1);
    EXPECT_NE(order.runs[i].back_to_front, order.runs[i - 1].back_to_front);
  }
  ASSERT_EQ(order.merged.size(), 2u);
  EXPECT_EQ(order.merged[0].first, first_meeting(s));
  EXPECT_EQ(order.merged[0].members, (std::vector<std::string>{"wall", "ball"}));
  EXPECT_THAT(order_text(s, order), HasSubstr("wall, ball: "));
  EXPECT_THAT(order_json(s, order), HasSubstr("talisman.order/1"));
}

// --- The list `order` of a sequence file ---

TEST(LayerPairs, WhatIsWrongIsRefusedWithItsLine) {
  const auto error_of = [](const std::string& order) { return message_of([&] { crossing(order); }); };
  EXPECT_EQ(error_of("order: []\n"), "");
  EXPECT_THAT(error_of("order:\n  - {behind: wall}\n"), HasSubstr("front"));
  EXPECT_THAT(error_of("order:\n  - {behind: wall, front: hall}\n"), HasSubstr("crossing.yaml:18: order"));
  EXPECT_THAT(error_of("order:\n  - {behind: wall, front: hall}\n"), HasSubstr("'hall' matches no layer"));
  EXPECT_THAT(error_of("order:\n  - {behind: wall, front: wall}\n"), HasSubstr("names one layer twice"));
  EXPECT_THAT(error_of("order:\n  - {behind: wall, front: b*}\n  - {behind: ball, front: wall}\n"),
              HasSubstr("crossing.yaml:19"));
  EXPECT_THAT(error_of("order: [{behind: wall, front: ball}, {behind: ball, front: bystander},"
                       " {behind: bystander, front: wall}]\n"),
              HasSubstr("pairs do not go round"));
  EXPECT_THAT(error_of("cycles: split\n"), HasSubstr("merge"));
}

TEST(LayerPairs, PairsThatContradictTheGroupsAreRefused) {
  Sequence s = crossing();
  s.layers.layers[kWall].group = layers::OrderGroup::Foreground;
  const std::vector<LayerPairEntry> entries{{"wall", "ball", "x.yaml", 3}};
  EXPECT_THAT(message_of([&] { resolve_layer_pairs(entries, s.layers.layers); }),
              HasSubstr("groups come first"));
}

TEST(LayerPairs, GlobsGiveEveryPairOfDifferentLayers) {
  const Sequence s = crossing("order: [{behind: 'ba*', front: '*'}]\n");
  EXPECT_EQ(s.explicit_order, (std::vector<layers::ExplicitPair>{{kBall, kWall}, {kBall, kBystander}}));
}

}  // namespace
}  // namespace talisman::sequences
