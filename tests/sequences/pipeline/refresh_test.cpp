// SPDX-License-Identifier: Apache-2.0
// Chunks drawn alone: what is shown is within the bound at every vertex, plans are those of renders, and any frame can be
// drawn by itself.
#include "sequences/pipeline/refresh/refresh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "sequences/pipeline/layer_planning.h"
#include "sequences/results/frame_lines.h"
#include "tests/sequences/small_run.h"
#include "tests/support/scenes.h"

namespace talisman::sequences {
namespace {

using layers::Affine2;
using layers::dvec2;
using layers::dvec4;
using regulator::Action;
using regulator::Policy;
using regulator::Refresh;

/// A flight low over a wide, finely divided ground: near it is off at once, far it serves for long. 400 × 300 px.
SmallRun ground_flight(double geometric_px = 2) {
  SmallRun small(tests::moving_scene());
  small.scene.meshes[small.scene.parts[0].mesh] = tests::quad_mesh(60, 64, 12);
  small.layers = layers::factor(small.scene, tests::one_layer_per_part(small.scene));
  small.settings.view.display_px = {400, 300};
  small.settings.fps = 80;
  small.settings.frames = 40;
  small.policy(Policy::Threshold, geometric_px);
  small.settings.regulator.refresh = Refresh::Chunks;
  return small;
}

struct RefreshPlayback {
  std::map<int, std::string> hashes;   ///< of the frames that were drawn
  std::vector<std::string> decisions;  ///< of all
  std::vector<chunker::RenderCounters> counters;
};

/// All frames are planned, those in `drawn` are drawn.
template <typename Drawn>
RefreshPlayback play_chunks(const SmallRun& small, const Drawn& drawn) {
  const Pipeline pipeline = make_pipeline(small.scene, small.layers, small.settings);
  const chunker::PreparedScene prepared(small.scene, small.settings.render);
  PipelineState state(pipeline);
  RefreshPlayback played;
  for (int frame = 0; frame < small.settings.frames; ++frame) {
    const FrameReport report = step(pipeline, state, frame, drawn(frame) ? &prepared : nullptr);
    if (drawn(frame)) played.hashes[frame] = hash_of(report.picture);
    for (const regulator::LayerDecision& decision : report.plan.decisions)
      played.decisions.push_back(json_of(report, decision));
    played.counters.push_back(report.render);
  }
  return played;
}

TEST(RefreshByChunks, SomeChunksAreDrawnAloneAndTheirDecisionsSaySo) {
  const std::vector<FrameReport> reports = ground_flight().run(40, false);
  EXPECT_GT(count(reports, Action::Refresh), 5);
  for (const FrameReport& report : reports)
    for (const regulator::LayerDecision& decision : report.plan.decisions) {
      if (decision.action != Action::Refresh) continue;
      ASSERT_TRUE(decision.chunks);
      EXPECT_GT(decision.chunks->drawn, 0);
      EXPECT_LE(decision.chunks->drawn, 0.6 * decision.chunks->stored);
      EXPECT_EQ(decision.cost.chunks, decision.chunks->drawn);
      EXPECT_LE(decision.cost.pixels, decision.cost.chunks * 1024);
      EXPECT_LE(decision.cost.polygons, report.layers[decision.layer].polygons);
      EXPECT_LE(decision.chunks->step_px, 4 + 1e-9) << "2 δ";
      EXPECT_LE(decision.shown_geometric_px, 2 + 1e-9);
      EXPECT_THAT(decision.reason, ::testing::HasSubstr(" chunks"));
    }
}

/// The warp of a frame and those of a sprite's instants, with the states of these.
struct ShownChunks {
  const regulator::SpriteChunks& chunks;
  const layers::SpritePlacement& placement;
  Affine2 warp;
};

bool is_on_display(const dvec2& p, layers::ivec2 size) {
  return p.x >= 0 && p.y >= 0 && p.x <= size.x && p.y <= size.y;
}

/// The largest error of a vertex of the layer in the chunk that shows it, and the largest distance of the places in
/// which two chunks show it.
void expect_vertices_within(const SmallRun& small, const Pipeline& pipeline, const layers::Layer& layer,
                            const ShownChunks& shown, int frame, double limit_px, int& looked_at) {
  const layers::ivec2 size = small.settings.view.display_px;
  const Affine2 texel = *inverse(shown.placement.screen_from_sprite);
  const auto places_at = [&](int instant) {
    const layers::SceneFrame at = scene_at(pipeline, instant);
    const layers::dmat4 clip = layers::clip_from_world(at.camera, size);
    std::vector<dvec4> places;
    for (const int part : layer.parts)
      for (const layers::dvec3& p : layers::world_positions(at, small.scene.parts[part]))
        places.push_back(clip * dvec4(p, 1));
    return places;
  };
  const std::vector<dvec4> now = places_at(frame);
  double worst = 0, step = 0;
  std::vector<std::vector<dvec2>> shown_at(now.size());
  for (std::size_t s = 0; s < shown.chunks.instants.size(); ++s) {
    const regulator::ChunkInstant& instant = *shown.chunks.instants[s];
    const std::vector<dvec4> then = places_at(instant.frame);
    const Affine2 back = *inverse(instant.carried);
    for (std::size_t v = 0; v < then.size(); ++v) {
      if (!(then[v].w > 0.1)) continue;
      const dvec2 first = back(layers::screen_from_clip(then[v], size)), at = texel(first);
      if (!is_on_display(at, shown.placement.size_px - 1)) continue;
      const int chunk = static_cast<int>(at.y) / 32 * shown.chunks.count.x + static_cast<int>(at.x) / 32;
      if (shown.chunks.of_chunk[chunk] != s) continue;
      const dvec2 displayed = shown.warp(first);
      const bool is_in_front = now[v].w > 0.1;
      const dvec2 right = is_in_front ? layers::screen_from_clip(now[v], size) : dvec2(-1e9);
      if (!is_on_display(displayed, size)) continue;
      worst = std::max(worst, glm::distance(displayed, right));
      if (!is_on_display(right, size)) continue;
      for (const dvec2& other : shown_at[v]) step = std::max(step, glm::distance(displayed, other));
      shown_at[v].push_back(displayed);
      ++looked_at;
    }
  }
  EXPECT_LE(worst, limit_px + 1e-9) << layer.name << ", frame " << frame;
  EXPECT_LE(step, 2 * limit_px + 1e-9) << layer.name << ", frame " << frame;
}

TEST(RefreshByChunks, EveryVertexOfEveryChunkShownIsWithinTheBound) {
  for (const double limit_px : {1.0, 2.0, 4.0}) {
    const SmallRun small = ground_flight(limit_px);
    const Pipeline pipeline = make_pipeline(small.scene, small.layers, small.settings);
    PipelineState state(pipeline);
    int looked_at = 0, mixed = 0;
    for (int frame = 0; frame < small.settings.frames; ++frame) {
      const FrameReport report = step(pipeline, state, frame, nullptr);
      for (const ShownSprite& sprite : report.shown) {
        const LayerMemory& memory = state.memory[sprite.layer];
        if (!memory.chunks || !memory.chunks->mixed()) continue;  // else one instant, judged by its hull
        ++mixed;
        expect_vertices_within(
            small, pipeline, report.layers[sprite.layer],
            {*memory.chunks, memory.placement, report.plan.decisions[sprite.layer].shown_warp.affine()},
            frame, limit_px, looked_at);
      }
    }
    EXPECT_GT(mixed, 3) << limit_px;
    EXPECT_GT(looked_at, 5000) << limit_px;
  }
}

TEST(RefreshByChunks, APlanIsThatOfTheRender) {
  const SmallRun small = ground_flight();
  const RefreshPlayback planned = play_chunks(small, [](int) { return false; });
  const RefreshPlayback drawn = play_chunks(small, [](int) { return true; });
  EXPECT_EQ(planned.decisions, drawn.decisions);
}

TEST(RefreshByChunks, AFrameIsTheSameWhicheverWereDrawnBefore) {
  SmallRun small = ground_flight();
  for (const bool late : {false, true}) {
    small.settings.late_chunks = late;
    const RefreshPlayback all = play_chunks(small, [](int) { return true; });
    for (const int from : {1, 9, 23, 39}) {
      const RefreshPlayback tail = play_chunks(small, [from](int frame) { return frame >= from; });
      for (const auto& [frame, hash] : tail.hashes)
        EXPECT_EQ(hash, all.hashes.at(frame)) << from << " " << frame;
    }
    const RefreshPlayback some = play_chunks(small, [](int frame) { return frame % 7 == 3; });
    for (const auto& [frame, hash] : some.hashes) EXPECT_EQ(hash, all.hashes.at(frame)) << frame;
  }
}

TEST(RefreshByChunks, LateChunksAndThreadsShowTheSameFrames) {
  SmallRun small = ground_flight();
  const RefreshPlayback usual = play_chunks(small, [](int) { return true; });
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const RefreshPlayback alone = play_chunks(small, [](int) { return true; });
    EXPECT_EQ(alone.hashes, usual.hashes);
    EXPECT_EQ(alone.counters, usual.counters);
  }
  small.settings.late_chunks = true;
  const RefreshPlayback late = play_chunks(small, [](int) { return true; });
  EXPECT_EQ(late.hashes, usual.hashes);
  EXPECT_EQ(late.decisions, usual.decisions);
}

TEST(RefreshByChunks, AFreshChunkIsThePictureOfItsFrame) {
  // With a bound that no motion keeps, all that is shown is fresh: as many chunks are over as allowed, or all is drawn.
  SmallRun small = ground_flight(1e-3);
  const std::vector<FrameReport> reports = small.run(6, false);
  EXPECT_EQ(count(reports, Action::Refresh), 0);
  EXPECT_GT(count(reports, Action::Rerender), 10);
}

TEST(RefreshByChunks, WithoutTheOptionNothingIsKeptOrAsked) {
  SmallRun small = ground_flight();
  small.settings.regulator.refresh = Refresh::Sprite;
  const Pipeline pipeline = make_pipeline(small.scene, small.layers, small.settings);
  EXPECT_EQ(pipeline.contents, nullptr);
  PipelineState state(pipeline);
  for (int frame = 0; frame < 10; ++frame) {
    const FrameReport report = step(pipeline, state, frame, nullptr);
    EXPECT_FALSE(report.refresh);
    for (const LayerMemory& memory : state.memory) EXPECT_FALSE(memory.chunks);
    for (const regulator::LayerAssessment& assessment : report.assessments) EXPECT_FALSE(assessment.chunks);
  }
}

TEST(RefreshByChunks, RunsInWhichNothingIsJudgedByChunks) {
  const auto asks = [](auto&& change) {
    SmallRun small = ground_flight();
    change(small.settings);
    return refreshes_chunks(make_pipeline(small.scene, small.layers, small.settings));
  };
  EXPECT_TRUE(asks([](Settings&) {}));
  EXPECT_FALSE(asks([](Settings& s) { s.regulator.policy = Policy::Interpolate; }));
  EXPECT_FALSE(asks([](Settings& s) { s.regulator.thresholds.geometric_px = 0; }));
  EXPECT_FALSE(asks([](Settings& s) { s.regulator.blend_frames = 2; }));
  EXPECT_FALSE(asks([](Settings& s) { s.regulator.regroup.by = regulator::Regroup::Amortised; }));
  EXPECT_FALSE(asks([](Settings& s) { s.regulator.latency.render_ms = 20; }));
  EXPECT_FALSE(asks([](Settings& s) { s.compression = chunker::CompressionOptions{85}; }));
  EXPECT_FALSE(asks([](Settings& s) { s.accumulate = 4; }));
}

/// The reasons of all renders of the layer after the first.
std::set<std::string> whole_reasons(const SmallRun& small, int layer) {
  std::set<std::string> reasons;
  for (const FrameReport& report : small.run(20, false)) {
    const regulator::LayerDecision& decision = report.plan.decisions[layer];
    EXPECT_NE(decision.action, Action::Refresh);
    const std::size_t at = decision.reason.find("; whole: ");
    if (decision.action == Action::Rerender && at != std::string::npos)
      reasons.insert(decision.reason.substr(at + 9));
  }
  return reasons;
}

TEST(RefreshByChunks, WhereAllIsDrawnTheReasonSaysWhy) {
  SmallRun blurred = ground_flight();
  blurred.layers.layers[0].preferences.motion_blur = 0.5;
  EXPECT_THAT(whole_reasons(blurred, 0), ::testing::Contains("it is blurred by motion"));
  // The cube turns under the light.
  EXPECT_THAT(whole_reasons(ground_flight(0.5), 1), ::testing::Contains("the light on it has changed"));
}

TEST(RefreshByChunks, WhatDeformsIsDrawnWhole) {
  SmallRun small(tests::skinned_bar_scene());
  small.policy(Policy::Threshold, 0.5);
  small.settings.regulator.refresh = Refresh::Chunks;
  small.settings.regulator.color_warp = false;
  small.settings.regulator.thresholds.photometric = 0;
  for (layers::Material& material : small.scene.materials) material.unlit = true;
  EXPECT_THAT(whole_reasons(small, 0), ::testing::Contains("it deforms"));
}

}  // namespace
}  // namespace talisman::sequences
