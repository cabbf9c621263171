// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/culling/culling.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "sequences/content/own_settings.h"
#include "sequences/pipeline/step.h"
#include "tests/sequences/temporary_folder.h"
#include "tests/support/fleet.h"
#include "tests/support/random_scene.h"
#include "tests/support/scenes.h"

namespace talisman::sequences {
namespace {

using regulator::Policy;

constexpr VisibilityOptions kFrustum{Precomputed::None, ViewTest::None, ViewTest::Frustum};

Settings fleet_settings(Policy policy) {
  Settings settings;
  settings.regulator.policy = policy;
  settings.regulator.thresholds.geometric_px = 1;
  settings.regulator.budget.polygons = 200;
  settings.view.display_px = {96, 72};
  settings.frames = 12;
  return settings;
}

std::string without_reason_of_drop(const regulator::LayerDecision& d) {
  std::string text = std::to_string(d.layer) + " " + std::to_string(static_cast<int>(d.action)) + " " +
                     std::to_string(d.shown_geometric_px) + " " + std::to_string(d.cost.pixels);
  if (d.action != regulator::Action::Drop) text += d.reason;
  return text;
}

/// Plans and draws both; nothing but the reasons of what is dropped may differ.
void expect_same_pictures_and_decisions(const layers::Scene& scene, const layers::LayerSet& set,
                                        Settings settings, int frames, bool costs = true) {
  const chunker::PreparedScene prepared(scene, settings.render);
  const Pipeline all = make_pipeline(scene, set, settings);
  settings.visibility = kFrustum;
  const Pipeline culling = make_pipeline(scene, set, settings);
  PipelineState state_all(all), state_culling(culling);
  for (int frame = 0; frame < frames; ++frame) {
    const FrameReport a = step(all, state_all, frame, &prepared),
                      b = step(culling, state_culling, frame, &prepared);
    ASSERT_EQ(a.plan.decisions.size(), b.plan.decisions.size());
    for (std::size_t i = 0; costs && i < a.plan.decisions.size(); ++i)
      EXPECT_EQ(without_reason_of_drop(a.plan.decisions[i]), without_reason_of_drop(b.plan.decisions[i]))
          << frame;
    EXPECT_EQ(a.picture == b.picture, true) << "frame " << frame;
    EXPECT_EQ(a.reference.polygons, b.reference.polygons);
  }
}

TEST(Culling, TheFrustumChangesNoPictureAndNoDecision) {
  const layers::Scene scene = tests::fleet_scene(40, 11);
  const layers::LayerSet set = layers::factor(scene, tests::one_layer_per_part(scene));
  for (const Policy policy : {Policy::Direct, Policy::Reference, Policy::Threshold, Policy::Budget})
    expect_same_pictures_and_decisions(scene, set, fleet_settings(policy), 12);
}

// Shadows, mirrors, shade layers, fades, skins, merged layers, open shutters: what is not seen is looked at from
// elsewhere.
TEST(Culling, TheFrustumChangesNoPictureOfRandomScenes) {
  const tests::TemporaryFolder folder;
  for (std::uint32_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    const Sequence sequence = tests::random_sequence(seed, folder.path());
    Settings settings = own_settings(sequence);
    settings.regulator.policy = seed % 2 == 0 ? Policy::Threshold : Policy::Direct;
    expect_same_pictures_and_decisions(*sequence.scene, sequence.layers, settings, 6);
  }
}

TEST(Culling, WhatIsOutOfViewIsCulledAndNamedSo) {
  const tests::TemporaryFolder folder;
  const Sequence s = load_sequence(
      folder.write("three.yaml",
                   "frames: 4\n"
                   "display: [96, 72]\n"
                   "shapes:\n"
                   "  - {id: left, box: [1, 1, 1], position: [-30, 0, 0]}\n"
                   "  - {id: middle, box: [1, 1, 1]}\n"
                   "  - {id: behind, box: [1, 1, 1], position: [0, 0, 30]}\n"
                   "camera: {fov_deg: 40, near_m: 1, far_m: 100, position: [0, 0, 10], look_at: [0, 0, 0]}\n"
                   "layers:\n"
                   "  - {name: left, parts: [left]}\n"
                   "  - {name: middle, parts: [middle]}\n"
                   "  - {name: behind, parts: [behind]}\n"));
  Settings settings = own_settings(s);
  settings.regulator.policy = Policy::Threshold;
  settings.visibility = kFrustum;
  const Pipeline pipeline = make_pipeline(*s.scene, s.layers, settings);
  PipelineState state(pipeline);
  for (int frame = 0; frame < s.frames; ++frame) {
    const FrameReport report = step(pipeline, state, frame, nullptr);
    const std::vector<regulator::LayerDecision>& decisions = report.plan.decisions;
    for (const int hidden : {0, 2}) {
      EXPECT_EQ(decisions[hidden].action, regulator::Action::Drop);
      EXPECT_EQ(decisions[hidden].reason, "culled: outside of the view");
    }
    EXPECT_NE(decisions[1].action, regulator::Action::Drop) << decisions[1].reason;
  }
}

// Frames in any order, repeated, and far apart: as from a new state.
TEST(Culling, FramesInAnyOrderAreThoseOfANewState) {
  const layers::Scene scene = tests::fleet_scene(20, 6);
  const layers::LayerSet set = layers::factor(scene, tests::one_layer_per_part(scene));
  Settings settings = fleet_settings(Policy::Direct);
  settings.visibility = kFrustum;
  const Pipeline pipeline = make_pipeline(scene, set, settings);
  PipelineState carried(pipeline);
  for (const int frame : {5, 4, 4, 11, 0, 1, 7}) {
    step(pipeline, carried, frame, nullptr);
    const SeenParts seen = *seen_at(pipeline, carried, frame);
    PipelineState fresh(pipeline);
    step(pipeline, fresh, frame, nullptr);
    EXPECT_EQ(seen.part, seen_at(pipeline, fresh, frame)->part);
  }
}

TEST(Culling, WithoutTheOptionNothingIsBuilt) {
  const layers::Scene scene = tests::fleet_scene(3, 6);
  const Pipeline pipeline = make_pipeline(scene, layers::factor(scene, tests::one_layer_per_part(scene)),
                                          fleet_settings(Policy::Direct));
  PipelineState state(pipeline);
  step(pipeline, state, 0, nullptr);
  EXPECT_EQ(pipeline.culling, nullptr);
  EXPECT_FALSE(state.culling);
  EXPECT_TRUE(state.captured.at(0).culled.empty());
}

TEST(Visibility, TwentyOneTriplesAndNoOther) {
  std::set<std::string> good;
  int bad = 0;
  for (const char* pre : {"none", "ctc", "cto"})
    for (const char* cell : {"none", "frustum", "eye"})
      for (const char* object : {"none", "frustum", "eye"}) {
        const std::string text = std::string(pre) + "," + cell + "," + object;
        const auto options = visibility_from(text);
        bad += !options;
        if (!options) continue;
        EXPECT_EQ(text_of(*options), text);
        good.insert(text);
      }
  EXPECT_EQ(good.size(), 21u);
  EXPECT_EQ(bad, 6);
  for (const char* text : {"", "none", "none,none", "none,none,none,none", "cto,eye,eye ", "CTO,eye,eye",
                           ",,", "eye,eye,eye", "none,none,cto"})
    EXPECT_FALSE(visibility_from(text)) << text;
  EXPECT_FALSE(visibility_from("none,none,frustum")->needs_cells());
  EXPECT_TRUE(visibility_from("none,frustum,none")->needs_cells());
}

}  // namespace
}  // namespace talisman::sequences
