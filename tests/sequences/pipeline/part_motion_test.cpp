// SPDX-License-Identifier: Apache-2.0
// Motion words of parts, against every vertex of their meshes.
#include "sequences/pipeline/predictive/part_motion.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include "layers/state.h"
#include "regulator/plan_tree.h"
#include "sequences/pipeline/predictive/motion_study.h"
#include "tests/support/scenes.h"

namespace talisman::sequences {
namespace {

using layers::dmat4;
using layers::dvec2;
using layers::dvec3;
using layers::dvec4;
using layers::Scene;

constexpr layers::ivec2 kSmall{160, 120};

/// Cubes, balls and squares that are thrown about before a camera that flies or stands, some of them out of view or past
/// the eye.
Scene thrown_scene(std::uint32_t seed, bool camera_flies) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto some = [&](double size) { return size * dvec3(unit(random), unit(random), unit(random)); };
  Scene scene = tests::cube_scene();
  scene.meshes.push_back(tests::sphere_mesh(6, 9));
  scene.meshes.push_back(tests::quad_mesh());
  for (int i = 0; i < 24; ++i) {
    layers::TransformTrack track;
    dvec3 at = some(4);
    for (int key = 0; key < 5; ++key) {
      track.translation.times_s.push_back(0.4 * key);
      track.translation.values.push_back(at);
      if (i % 3 != 0 || key % 2 == 0) at += some(i % 4 == 0 ? 3 : 0.02);
    }
    scene.nodes.push_back({"thrown", -1, {}});
    const int node = static_cast<int>(scene.nodes.size()) - 1;
    if (i % 6 != 5)
      scene.tracks.push_back({node, track});
    else
      scene.nodes.back().local.translation = at;
    scene.nodes.push_back({"turned", node, {}});
    if (i % 5 == 1)
      scene.tracks.push_back({node + 1, layers::SpinTrack{glm::normalize(some(1)), 0.3 * unit(random)}});
    scene.parts.push_back({"thrown " + std::to_string(i), node + 1, i % 3, 0, -1});
  }
  if (camera_flies) {
    layers::TransformTrack track;
    track.translation = {{0, 1, 2}, {{0, 0, 4}, {0, 0.5, 4.2}, {0.3, 0.5, 3}}};
    scene.nodes.push_back({"camera", -1, {}});
    const int node = static_cast<int>(scene.nodes.size()) - 1;
    scene.tracks.push_back({node, track});
    scene.cameras[static_cast<std::size_t>(scene.active_camera)].node = node;
  }
  return scene;
}

layers::LayerSet all_of(const Scene& scene) {
  layers::LayerSpec all;
  all.name = "all";
  all.part_globs = {"*"};
  return layers::factor(scene, {&all, 1});
}

struct Projected {
  bool in_front = false;
  bool on_display = false;
  dvec2 px{0, 0};
};

std::vector<Projected> projected(const layers::SceneFrame& frame, const layers::Part& part) {
  const dmat4 clip = layers::clip_from_world(frame.camera, kSmall);
  std::vector<Projected> result;
  for (const dvec3& p : layers::world_positions(frame, part)) {
    const dvec4 q = clip * dvec4(p, 1);
    Projected vertex{q.z > -q.w && q.w > 0, false, {}};
    if (vertex.in_front) {
      vertex.px = layers::screen_from_clip(q, kSmall);
      vertex.on_display =
          vertex.px.x >= 0 && vertex.px.y >= 0 && vertex.px.x <= kSmall.x && vertex.px.y <= kSmall.y;
    }
    result.push_back(vertex);
  }
  return result;
}

TEST(PartMotion, NoVertexThatIsDisplayedIsBeyondDelta) {
  // Every vertex of every part as it was drawn by the plan and as it is now; only what lies off the display in both is
  // not asked about.
  constexpr double kFps = 12;
  int at_rest = 0, looked_at = 0;
  for (std::uint32_t seed = 1; seed <= 6; ++seed)
    for (const double delta : {0.05, 0.5, 2.0}) {
      const Scene scene = thrown_scene(seed, seed % 2 == 0);
      const FollowedParts followed = followed_parts(scene, all_of(scene));
      const regulator::PlanShape plan{16, seed % 3 == 0 ? 4 : 2};
      const FrameAt frame_at = [&](int f) { return scene.at(f / kFps); };
      MotionOptions options;
      options.delta_px = delta;
      const MotionSlice slice = follow_parts(followed, kSmall, 0, plan.frames, 1000, frame_at, options);
      for (std::size_t i = 0; i < followed.parts.size(); ++i)
        for (int f = 0; f < plan.frames; ++f) {
          const int drawn = regulator::draw_shown(plan, slice.words[i], f).frame;
          const int as_of = regulator::instant_of(slice.words[i], drawn, regulator::DrawnAs::RunStart);
          if (as_of == f) continue;
          ++at_rest;
          const layers::Part& part = scene.parts[followed.parts[i].part];
          const std::vector<Projected> then = projected(frame_at(as_of), part),
                                       now = projected(frame_at(f), part);
          for (std::size_t v = 0; v < now.size(); ++v) {
            if (!then[v].on_display && !now[v].on_display) continue;
            ++looked_at;
            ASSERT_TRUE(then[v].in_front && now[v].in_front) << seed << " " << part.name << " " << f;
            ASSERT_LE(glm::length(now[v].px - then[v].px), delta + 1e-9)
                << seed << " " << part.name << " " << f;
          }
        }
    }
  EXPECT_GT(at_rest, 1000);
  EXPECT_GT(looked_at, 1000);
}

/// Words of all parts of a scene.
MotionSlice words_of(const Scene& scene, const FrameAt& frame_at, const MotionOptions& options,
                     int frames = 8) {
  return follow_parts(followed_parts(scene, all_of(scene)), kSmall, 0, frames, 1000, frame_at, options);
}

TEST(PartMotion, WithDeltaZeroEveryBitThatDiffersCounts) {
  // A metre of 1e-16 more is no motion that a pixel shows, but another picture may come of it.
  const Scene scene = tests::cube_scene();
  const FrameAt frame_at = [&](int f) {
    layers::SceneFrame frame = scene.at(0);
    if (f == 3) frame.world_from_node[scene.parts[0].node][3].x = 1e-16;
    return frame;
  };
  EXPECT_EQ(words_of(scene, frame_at, {}).words[0].marks(), "#..##...");
  MotionOptions loose;
  loose.delta_px = 1e-6;
  EXPECT_EQ(words_of(scene, frame_at, loose).words[0].marks(), "#.......");
}

TEST(PartMotion, ALightThatMovesChangesWhatIsLitAndNothingElse) {
  Scene scene = tests::cube_scene();
  scene.materials.push_back(scene.materials.front());
  scene.materials.back().unlit = true;
  scene.parts.push_back(scene.parts.front());
  scene.parts.back().material = static_cast<int>(scene.materials.size()) - 1;
  const FrameAt frame_at = [&](int f) {
    layers::SceneFrame frame = scene.at(0);
    if (f >= 4) frame.lights.back().color *= 0.5f;
    return frame;
  };
  MotionOptions options;
  options.delta_px = 1;
  const MotionSlice slice = words_of(scene, frame_at, options);
  EXPECT_EQ(slice.words[0].marks(), "#...#...");
  EXPECT_EQ(slice.words[1].marks(), "#.......");
}

TEST(PartMotion, WhatIsOutsideOnOneSideRestsUntilItComesIn) {
  const Scene scene = tests::cube_scene();
  const FrameAt frame_at = [&](int f) {
    layers::SceneFrame frame = scene.at(0);
    frame.world_from_node[scene.parts[0].node] = glm::translate(dmat4(1), dvec3(20.0 - 4 * f, 0, 0));
    return frame;
  };
  MotionOptions options;
  options.delta_px = 1;
  // In view at 4, 0 and -4 metres at most: frames 4, 5 and 6.
  const std::string with_rule = words_of(scene, frame_at, options).words[0].marks();
  EXPECT_EQ(with_rule.substr(0, 4), "#...");
  EXPECT_NE(with_rule.find('#', 1), std::string::npos);
  options.clip_rule = false;
  EXPECT_EQ(words_of(scene, frame_at, options).words[0].marks(), "########");
}

TEST(PartMotion, WhatDeformsRestsOnlyWhileNothingDiffers) {
  const Scene scene = tests::skinned_bar_scene();
  MotionOptions options;
  options.delta_px = 1000;
  const auto moving = [&](int f) { return scene.at(f / 24.0); };
  EXPECT_EQ(words_of(scene, moving, options).words[0].marks(), "########");
  const auto standing = [&](int) { return scene.at(0.5); };
  EXPECT_EQ(words_of(scene, standing, options).words[0].marks(), "#.......");
}

TEST(PartMotion, FramesBehindTheLastAreNotAskedFor) {
  const Scene scene = tests::moving_scene();
  int largest = 0;
  const FrameAt frame_at = [&](int f) {
    largest = std::max(largest, f);
    return scene.at(f / 24.0);
  };
  const FollowedParts followed = followed_parts(scene, all_of(scene));
  const MotionSlice slice = follow_parts(followed, kSmall, 8, 8, 10, frame_at, {});
  EXPECT_EQ(largest, 10);
  for (const regulator::MotionWord& word : slice.words) EXPECT_TRUE(word.rests_over(3, 7));
}

TEST(MotionStudy, CountsOfOneSlice) {
  regulator::MotionWord word(8);
  word.mark(7);
  // Drawn at 0, 4, 6, 7 with shared buffers, twice with one of its own.
  const MotionCounts whole = counts_of(word, 0, 100, {8, 2}, 10);
  EXPECT_EQ(whole.draws, 4);
  EXPECT_EQ(whole.runs, 2);
  EXPECT_EQ(whole.polygons, 40);
  EXPECT_EQ(whole.polygons_direct, 80);
  // The sequence ends behind frame 4 of the slice: two drawings, and the change is never seen.
  regulator::MotionWord cut(8);
  cut.mark(4);
  const MotionCounts half = counts_of(cut, 0, 5, {8, 2}, 1);
  EXPECT_EQ(half.draws, 2);
  EXPECT_EQ(half.shown, 5);
}

}  // namespace
}  // namespace talisman::sequences
