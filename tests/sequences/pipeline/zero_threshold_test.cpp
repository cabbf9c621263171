// SPDX-License-Identifier: Apache-2.0
// With a geometric threshold of 0 px only what would be drawn identically is reused, so that every frame is that
// of `reference`, byte for byte: on scenes drawn by lot (tests/support/random_scene.h), and on the sequence that
// calls for every effect.
//
// TALISMAN_RANDOM_SCENES=FIRST-LAST looks at those seeds instead (by hand: 1-500), one case for all of them.
#include <cstdio>
#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/sequences/playback.h"
#include "tests/sequences/temporary_folder.h"
#include "tests/support/random_scene.h"
#include "tests/support/sequences.h"

namespace talisman::sequences {
namespace {

using regulator::Action;
using regulator::Policy;

constexpr std::uint32_t kScenesPerCase = 10;

Settings with_policy(const Variant& variant, Policy policy) {
  Settings settings = variant.settings;
  settings.regulator.policy = policy;
  settings.regulator.thresholds.geometric_px = 0;
  return settings;
}

/// What a run under threshold 0 and the reference have in common.
struct Comparison {
  int first_difference = -1;  ///< frame; -1: none
  int reused = 0;             ///< of sprites that were there, over all frames
  std::string suspects;       ///< what was reused in that frame
};

Comparison compare_zero_with_reference(const Variant& variant) {
  tests::Playback zero(variant.sequence, with_policy(variant, Policy::Threshold), true);
  tests::Playback reference(variant.sequence, with_policy(variant, Policy::Reference), true);
  Comparison result;
  for (int frame = 0; frame < variant.sequence.frames && result.first_difference < 0; ++frame) {
    const FrameReport a = zero.next(), b = reference.next();
    if (!(a.picture == b.picture)) result.first_difference = frame;
    for (const regulator::LayerDecision& decision : a.plan.decisions) {
      if (decision.action != Action::Reuse) continue;
      ++result.reused;
      if (result.first_difference >= 0) result.suspects += " '" + a.layers[decision.layer].name + "'";
    }
  }
  return result;
}

Variant random_variant(std::uint32_t seed, const tests::TemporaryFolder& folder) {
  const Sequence sequence = tests::random_sequence(seed, folder.path());
  Variant variant = tests::run_of(sequence);
  variant.settings.cycles = sequence.cycles;
  variant.settings.compositor = sequence.compositor;
  return variant;
}

/// A run of a small sequence file.
Comparison compare(const std::string& text) {
  const tests::TemporaryFolder folder;
  tests::write_checker(folder.path());
  return compare_zero_with_reference(tests::run_of(load_sequence(folder.write("small.yaml", text))));
}

void expect_equal(std::uint32_t first, std::uint32_t last) {
  const tests::TemporaryFolder folder;
  int reused = 0;
  for (std::uint32_t seed = first; seed <= last; ++seed) {
    const Comparison result = compare_zero_with_reference(random_variant(seed, folder));
    EXPECT_EQ(result.first_difference, -1) << "seed " << seed << ", reused:" << result.suspects << "\n"
                                           << tests::random_sequence_text(seed);
    reused += result.reused;
  }
  EXPECT_GT(reused, 0);  // or nothing was shown
}

class ZeroThresholdSeeds : public testing::TestWithParam<std::uint32_t> {};

TEST_P(ZeroThresholdSeeds, EqualsTheReferenceInScenesByLot) {
  if (std::getenv("TALISMAN_RANDOM_SCENES")) GTEST_SKIP() << "other seeds are asked for";
  expect_equal(GetParam(), GetParam() + kScenesPerCase - 1);
}
INSTANTIATE_TEST_SUITE_P(By10, ZeroThresholdSeeds, testing::Values(1, 11, 21, 31, 41));

TEST(ZeroThresholdByHand, EqualsTheReferenceInScenesThatAreAskedFor) {
  const char* const asked = std::getenv("TALISMAN_RANDOM_SCENES");
  unsigned first = 0, last = 0;
  if (asked == nullptr || std::sscanf(asked, "%u-%u", &first, &last) != 2)
    GTEST_SKIP() << "TALISMAN_RANDOM_SCENES=FIRST-LAST asks for seeds";
  expect_equal(first, last);
}

TEST(ZeroThreshold, EqualsTheReferenceWithEveryEffect) {
  const Comparison result = compare_zero_with_reference(tests::every_effect(12));
  EXPECT_EQ(result.first_difference, -1);
}

// A shadow's alpha is the share of one light in all of them: a lamp without shadow that crosses the sun's
// shadow makes it paler.
TEST(ZeroThreshold, ShadowFollowsLightsThatCastNone) {
  const Comparison result = compare(
      "frames: 12\n"
      "display: [96, 72]\n"
      "shapes:\n"
      "  - {id: floor, plane: [8, 8]}\n"
      "  - {id: post, box: [0.6, 1.2, 0.6], position: [0, 0.6, 0]}\n"
      "camera: {fov_deg: 40, position: [0, 5, 7], look_at: [0, 0, 0]}\n"
      "lights:\n"
      "  - {kind: directional, name: sun, direction: [1, -1, 0], color: [0.5, 0.5, 0.5], casts_shadow: "
      "true}\n"
      "  - {kind: spot, name: lamp, color: [0.8, 0.8, 0.8], inner_deg: 15, outer_deg: 20,\n"
      "     flight: [{t: 0, position: [2, 4, 0], target: [2, 0, 0.01]},\n"
      "              {t: 0.5, position: [1, 4, 0], target: [1, 0, 0.01]}]}\n"
      "layers:\n"
      "  - {name: floor, parts: [floor], group: background, shading: {shadows: {}}}\n"
      "  - {name: post, parts: [post]}\n");
  EXPECT_EQ(result.first_difference, -1) << result.suspects;
}

// While layers are merged the renderer blends their textures, and the picture is that of one instant.
TEST(ZeroThreshold, MergedLayersFollowTheBlendOfTheirTextures) {
  const Comparison result = compare(
      "frames: 6\n"
      "display: [96, 72]\n"
      "shapes:\n"
      "  - {id: floor, plane: [8, 8], texture: checker.ppm, texture2: checker.ppm}\n"
      "  - {id: post, box: [2, 2, 2]}\n"
      "camera: {fov_deg: 40, position: [0, 5, 7], look_at: [0, 0, 0]}\n"
      "lights: [{kind: directional, name: sun, direction: [1, -1, 0]}]\n"
      "layers:\n"
      "  - name: floor\n"
      "    parts: [floor]\n"
      "    shading: {textures: {}, second_blend: [{t: 0, value: 0}, {t: 0.1, value: 0.9}]}\n"
      "  - {name: post, parts: [post]}\n");
  EXPECT_EQ(result.first_difference, -1) << result.suspects;
  EXPECT_GT(result.reused, 0);  // the blend rests at the end
}

}  // namespace
}  // namespace talisman::sequences
