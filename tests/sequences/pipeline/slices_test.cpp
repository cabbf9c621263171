// SPDX-License-Identifier: Apache-2.0
// Slices that adapt, and plans that a surprise ends.
#include "sequences/pipeline/predictive/slices.h"

#include <cmath>

#include <gmock/gmock.h>

#include "layers/jumps.h"
#include "sequences/pipeline/predictive/plan_buffers.h"
#include "tests/sequences/pipeline/shown_plan.h"

namespace talisman::sequences {
namespace {

using namespace shown_plan;
using ::testing::HasSubstr;

constexpr int kLongPlan = 64;

/// Cubes of which one flies straight on, and jumps in the frames of `jumps`.
layers::Scene jumping_scene(const std::vector<int>& jumps) {
  layers::Scene scene = swarm_scene(SwarmContent::Shape::Block, 0, 12);
  layers::TransformTrack track;
  const int node = scene.parts.front().node;
  layers::dvec3 at = scene.nodes[node].local.translation;
  track.translation = {{0}, {at}};
  for (const int frame : jumps) {
    const double t = (frame - 0.5) / kPlanFps;
    track.translation.times_s.insert(track.translation.times_s.end(), {t, std::nextafter(t, HUGE_VAL)});
    at += layers::dvec3(0.05, 0, 0);
    track.translation.values.push_back(at);
    at -= layers::dvec3(1.5, 0.5, 0);
    track.translation.values.push_back(at);
  }
  track.translation.times_s.push_back(kLongPlan / kPlanFps);
  track.translation.values.push_back(at + layers::dvec3(0.05, 0, 0));
  scene.tracks = {{node, track}};
  return scene;
}

/// The slices of all frames, in order.
std::vector<Slice> slices_of(const Pipeline& pipeline) {
  Slices slices(pipeline);
  std::vector<Slice> all;
  for (int f = 0; f < pipeline.settings.frames; ++f)
    if (const Slice& slice = slices.of(pipeline, f).slice; all.empty() || !(all.back() == slice))
      all.push_back(slice);
  return all;
}

std::vector<int> lengths(const std::vector<Slice>& slices) {
  std::vector<int> frames;
  for (const Slice& slice : slices) frames.push_back(slice.frames);
  return frames;
}

ShownPlan adapting(layers::Scene scene) {
  ShownPlan show(std::move(scene));
  show.settings.frames = kLongPlan;
  show.settings.regulator.predictive.adaptive = true;
  show.settings.regulator.predictive.joining = Joining::InPlace;
  show.settings.regulator.lookahead.frames = 16;
  return show;
}

Pipeline pipeline_of(const ShownPlan& show) { return make_pipeline(show.scene, show.layers, show.settings); }

TEST(Slices, OfKnownMotionFollowFromTheNumberOfTheFrame) {
  ShownPlan show = adapting(jumping_scene({20}));
  show.settings.regulator.predictive.adaptive = false;
  const Pipeline pipeline = pipeline_of(show);
  const std::vector<Slice> slices = slices_of(pipeline);
  EXPECT_THAT(lengths(slices), ::testing::ElementsAre(16, 16, 16, 16));
  for (const Slice& slice : slices) EXPECT_EQ(slice.surprised, 0) << "the words know of the jump";
  Slices far(pipeline);
  EXPECT_EQ(far.of(pipeline, 1'000'003).slice.first, 1'000'000);
}

TEST(Slices, HalveAtAJumpAndDoubleAfterTwoQuietOnes) {
  const std::vector<Slice> slices = slices_of(pipeline_of(adapting(jumping_scene({20}))));
  // 0-15, 16-19 of 16, then 8 + 8 quiet, then 16 again.
  EXPECT_THAT(lengths(slices), ::testing::ElementsAre(16, 16, 8, 8, 16, 16));
  EXPECT_EQ(slices[1].end, 20);
  EXPECT_EQ(slices[2].first, 20);
  EXPECT_EQ(slices[2].surprised, 1);
  EXPECT_EQ(slices[4].first, 36);
}

TEST(Slices, JumpsInEveryFrameLeaveOneFrameEach) {
  std::vector<int> all;
  for (int f = 1; f < 30; ++f) all.push_back(f);
  const std::vector<Slice> slices = slices_of(pipeline_of(adapting(jumping_scene(all))));
  EXPECT_EQ(slices.front(), (Slice{0, 16, 1, 0, 0}));
  for (const Slice& slice : slices) {
    EXPECT_TRUE(slice.first < 4 || slice.first >= 30 || slice.frames == 1) << slice.first;
    EXPECT_EQ(slice.surprised, slice.first > 0 && slice.first < 30) << slice.first;
  }
}

TEST(Slices, AreTheSameInAnyOrder) {
  const ShownPlan show = adapting(jumping_scene({9, 20, 21, 40}));
  const Pipeline pipeline = pipeline_of(show);
  Slices forwards(pipeline), anyhow(pipeline);
  std::vector<Slice> slices;
  std::vector<std::vector<regulator::MotionWord>> words;
  for (int f = 0; f < kLongPlan; ++f) {
    const PlannedSlice& planned = forwards.of(pipeline, f);
    slices.push_back(planned.slice);
    words.push_back(planned.motion.words);
  }
  for (const int f : {63, 0, 21, 20, 20, 19, 50, 3, 40, 39, 62}) {
    const PlannedSlice& planned = anyhow.of(pipeline, f);
    EXPECT_EQ(planned.slice, slices[f]) << f;
    EXPECT_EQ(planned.motion.words, words[f]) << f;
  }
}

/// Every frame beside the direct one, and what was said of it.
int surprises_beside_direct(const ShownPlan& show) {
  Settings truth_settings = show.settings;
  truth_settings.regulator = {};
  truth_settings.regulator.policy = regulator::Policy::Direct;
  const Pipeline truth = make_pipeline(show.scene, show.layers, truth_settings), pipeline = pipeline_of(show);
  const chunker::PreparedScene prepared(show.scene, show.settings.render);
  PipelineState state(pipeline);
  int surprises = 0;
  for (int f = 0; f < show.settings.frames; ++f) {
    const FrameReport report = step(pipeline, state, f, &prepared);
    EXPECT_TRUE(same_picture(report.picture, draw_direct(truth, f, prepared))) << f;
    surprises += report.predictive->surprises;
    if (report.predictive->surprises == 0) continue;
    EXPECT_EQ(report.predictive->parts_drawn, report.predictive->parts) << "drawn whole";
    EXPECT_THAT(report.plan.decisions[0].reason, HasSubstr("surprise, the plan is dropped"));
  }
  return surprises;
}

TEST(Slices, WithDeltaZeroAPlanThatAdaptsShowsEveryFrameAsItIs) {
  EXPECT_EQ(surprises_beside_direct(adapting(jumping_scene({9, 20, 21, 40}))), 4);
  ShownPlan wrapping = adapting(swarm_scene(SwarmContent::Shape::Block, 60));
  wrapping.settings.frames = kPlanFrames;
  surprises_beside_direct(wrapping);
}

TEST(Slices, DataDrivenIntervalsShowEveryFrameAsItIs) {
  for (const Joining joining : regulator::kAllJoinings) {
    ShownPlan show = adapting(swarm_scene(SwarmContent::Shape::Block, 40));
    show.settings.frames = kPlanFrames;
    show.settings.regulator.predictive.adaptive = false;
    show.settings.regulator.predictive.joining = joining;
    show.settings.regulator.predictive.intervals = regulator::Intervals::Data;
    EXPECT_EQ(surprises_beside_direct(show), 0);
  }
}

// What goes straight on is where it is expected; what turns off is not, and is drawn whole in that frame.
TEST(Slices, WhatIsExpectedAndComesOtherwiseIsASurprise) {
  layers::Scene scene = jumping_scene({});
  auto& keys = std::get<layers::TransformTrack>(scene.tracks[0].motion).translation;
  keys.times_s = {0, 30 / kPlanFps, 60 / kPlanFps, 70 / kPlanFps};
  keys.values = {keys.values.front(), keys.values.front() + layers::dvec3(1, 0, 0),
                 keys.values.front() + layers::dvec3(1, 1, 0), keys.values.front() + layers::dvec3(1, 1, 0)};
  ShownPlan show = adapting(std::move(scene));
  show.settings.regulator.predictive.adaptive = false;
  show.settings.regulator.lookahead.predict = regulator::Prediction::Linear;
  show.settings.regulator.thresholds.geometric_px = 0.5;
  show.settings.regulator.lookahead.frames = 8;
  const std::vector<Slice> slices = slices_of(pipeline_of(show));
  int surprises = 0;
  for (const Slice& slice : slices) {
    if (slice.surprised == 0) continue;
    ++surprises;
    // Slices of 8 from 0 on: in frame 0 nothing is known of its motion; it turns in frame 30 and stands from 60 on.
    const bool is_near_a_turn =
        slice.first <= 3 || (slice.first > 30 && slice.first < 36) || slice.first > 60;
    EXPECT_TRUE(is_near_a_turn) << slice.first;
  }
  EXPECT_GE(surprises, 2);
}

// The promise: what is displayed is within the threshold of the scene as it has come, whatever was expected.
TEST(Slices, WhateverIsExpectedNothingDisplayedIsBeyondDelta) {
  ShownPlan show = adapting(swarm_scene(SwarmContent::Shape::Block, 70));
  show.settings.frames = kPlanFrames;
  show.settings.regulator.lookahead.predict = regulator::Prediction::Linear;
  for (const double delta : {0.3, 1.0, 4.0}) {
    show.settings.regulator.thresholds.geometric_px = delta;
    const Pipeline pipeline = pipeline_of(show);
    Slices slices(pipeline);
    int displayed = 0;
    for (int f = 0; f < kPlanFrames; ++f) {
      const PlannedSlice& planned = slices.of(pipeline, f);
      const layers::SceneFrame truth = show.scene.at(f / kPlanFps);
      const layers::dmat4 now_from_world =
          layers::clip_from_world(truth.camera, show.settings.view.display_px);
      for (std::size_t i = 0; i < slices.followed().parts.size(); ++i) {
        const FollowedPart& part = slices.followed().parts[i];
        const int instant = planned.slice.first + planned.motion.words[i].run_start(f - planned.slice.first);
        const layers::SceneFrame seen = Slices::expected(pipeline, planned.slice, instant);
        const layers::dmat4 then_from_world =
            layers::clip_from_world(seen.camera, show.settings.view.display_px);
        for (const layers::vec3& p : show.scene.meshes[show.scene.parts[part.part].mesh].positions) {
          const layers::dvec4 now = now_from_world * truth.world_from_node[part.node] * layers::dvec4(p, 1);
          const layers::dvec4 then = then_from_world * seen.world_from_node[part.node] * layers::dvec4(p, 1);
          if (!(now.z > -now.w && then.z > -then.w)) continue;
          const layers::dvec2 a = layers::screen_from_clip(now, show.settings.view.display_px);
          const layers::dvec2 b = layers::screen_from_clip(then, show.settings.view.display_px);
          const auto on_display = [&](const layers::dvec2& q) {
            return q.x >= 0 && q.y >= 0 && q.x <= show.settings.view.display_px.x &&
                   q.y <= show.settings.view.display_px.y;
          };
          if (!on_display(a) && !on_display(b)) continue;
          ++displayed;
          ASSERT_LE(std::hypot(a.x - b.x, a.y - b.y), delta * (1 + 1e-9)) << f << " " << i;
        }
      }
    }
    EXPECT_GT(displayed, 500);
  }
}

}  // namespace
}  // namespace talisman::sequences
