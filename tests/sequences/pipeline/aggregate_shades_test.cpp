// SPDX-License-Identifier: Apache-2.0
// Layers whose shading is factored, merged and split: where the terms go while an aggregate draws them, and
// how the light on an aggregate is followed.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/commands/options.h"
#include "sequences/files/image_io.h"
#include "sequences/pipeline/aggregates.h"
#include "sequences/results/frame_lines.h"
#include "tests/sequences/playback.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using layers::Layer;
using regulator::Action;
using regulator::Policy;
using ::testing::StartsWith;
using tests::Playback;
using tests::TemporaryFolder;

/// A shiny wall at rest under a lamp, whose shadows and highlights are factored, and a ball that flies
/// through it from the lamp's side. A frame is a second; they meet while the ball's centre is within 1.5 m of
/// the wall's.
const std::string kLampAndWall =
    "frames: 32\n"
    "fps: 1\n"
    "display: [160, 120]\n"
    "shapes:\n"
    "  - {id: wall, box: [1, 4, 4], color: [0.6, 0.5, 0.4], specular: [0.4, 0.4, 0.4], shininess: 3}\n"
    "  - id: ball\n"
    "    sphere: 2\n"
    "    segments: 12\n"
    "    flight: [{t: 0, position: [5, 0, 0], target: [-100, 0, 0]},\n"
    "             {t: 10, position: [-5, 0, 0], target: [-100, 0, 0]}]\n"
    "camera: {fov_deg: 60, near_m: 1, far_m: 100, position: [8, 2, 10], look_at: [0, 0, 0]}\n"
    "lights:\n"
    "  - {kind: ambient, color: [0.2, 0.2, 0.2]}\n"
    "  - {kind: spot, name: lamp, position: [9, 7, 3], look_at: [0, 0, 0], inner_deg: 30, outer_deg: 40,\n"
    "     casts_shadow: true, shadow_map: {resolution_px: 256}}\n"
    "layers:\n"
    "  - {name: wall, parts: [wall], shading: {shadows: {}, specular: {}}}\n"
    "  - {name: ball, parts: [ball]}\n";
constexpr int kShadedWall = 0, kShadow = 1, kSpecular = 2, kShadedBall = 3, kShadedBoth = 4;

/// `text` with `from` replaced, which must be there.
std::string with(std::string text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
  return text;
}

Sequence sequence_of(const std::string& text) {
  const TemporaryFolder folder;
  return load_sequence(folder.write("merging.yaml", text));
}

/// Sprites lie on the lattice of the pixels, so that nothing is resampled.
Settings shaded_settings(const Sequence& sequence, Policy policy, double geometric_px = 1) {
  Settings settings = resolve({}, sequence, true).settings;
  settings.regulator.policy = policy;
  settings.regulator.thresholds.geometric_px = geometric_px;
  settings.placement.min_rotation_gain = 1;
  return settings;
}

bool is_merged(const FrameReport& report) { return !report.order.mergers.empty(); }

TEST(AggregateShades, TermsAreDroppedWithAReasonWhileTheirBaseIsMerged) {
  const Sequence s = sequence_of(kLampAndWall);
  ASSERT_EQ(s.layers.layers.size(), 4u);
  ASSERT_EQ(s.layers.layers[kShadow].name, "wall/shadow of lamp");
  ASSERT_EQ(s.layers.layers[kSpecular].name, "wall/specular");
  Playback run(s, shaded_settings(s, Policy::Threshold));
  int merged_frames = 0, splits = 0;
  while (run.frame < 16) {
    const FrameReport report = run.next();
    const auto& decisions = report.plan.decisions;
    const auto& order = report.order.back_to_front;
    const auto base = std::find(order.begin(), order.end(), kShadedWall);
    for (const int term : {kShadow, kSpecular}) {
      SCOPED_TRACE(s.layers.layers[term].name + " in frame " + std::to_string(report.frame));
      const bool shown = std::any_of(report.shown.begin(), report.shown.end(),
                                     [&](const ShownSprite& sprite) { return sprite.layer == term; });
      EXPECT_EQ(decisions[term].action == Action::Drop, is_merged(report));
      EXPECT_EQ(report.order.merged_into[term], report.order.merged_into[kShadedWall]);
      EXPECT_EQ(shown, !is_merged(report));
      if (is_merged(report)) {
        EXPECT_THAT(decisions[term].reason, StartsWith("merged into wall+ball: "));
      } else {
        ASSERT_GT(order.end() - base, 2);
        EXPECT_EQ(*(base + (term - kShadedWall)), term) << "directly in front of its base";
      }
    }
    splits += decisions[kShadow].reason.rfind("split from wall+ball: ", 0) == 0;
    merged_frames += is_merged(report);
  }
  EXPECT_GT(merged_frames, 2);
  EXPECT_LT(merged_frames, 12);
  EXPECT_EQ(splits, 1);
}

TEST(AggregateShades, AggregateHoldsTheTermsOfItsMembers) {
  const Sequence s = sequence_of(kLampAndWall);
  ASSERT_FALSE(s.layers.layers[kShadedWall].holds.shadows || s.layers.layers[kShadedWall].holds.specular);
  Playback run(s, shaded_settings(s, Policy::Threshold));
  while (run.frame < 8) run.next();
  ASSERT_EQ(run.state.layers.size(), 5u);
  const Layer& both = run.state.layers[kShadedBoth];
  EXPECT_EQ(both.members, (std::vector{kShadedWall, kShadedBall})) << "terms are no members";
  EXPECT_EQ(both.parts.size(), 2u) << "the surface of the wall is drawn once, not once per term";
  EXPECT_EQ(both.holds, (layers::HeldTerms{.shadows = true, .specular = true}));
  EXPECT_EQ(both.casters, (std::vector{kShadedWall, kShadedBall}));
  EXPECT_EQ(both.polygons, s.layers.layers[kShadedWall].polygons + s.layers.layers[kShadedBall].polygons);
}

TEST(AggregateShades, FadeThatAllMembersShareGoesOn) {
  // The fade needs no render, and must not stop because two layers meet.
  const std::string fade = ", fade: [{t: 0, value: 1}, {t: 16, value: 0}]}";
  const std::string one = with(kLampAndWall, "parts: [ball]}", "parts: [ball]" + fade);
  const std::string all = with(one, "specular: {}}}", "specular: {}}" + fade);
  for (const bool common : {true, false}) {
    const Sequence s = sequence_of(common ? all : one);
    Playback run(s, shaded_settings(s, Policy::Threshold));
    int merged_frames = 0;
    while (run.frame < 12) {
      const FrameReport report = run.next();
      for (const ShownSprite& sprite : report.shown) {
        if (sprite.layer != kShadedBoth) continue;
        ++merged_frames;
        EXPECT_FLOAT_EQ(sprite.multipliers.alpha, common ? 1 - report.frame / 16.0f : 1.0f) << report.frame;
      }
    }
    EXPECT_GT(merged_frames, 2);
  }
}

/// The alpha of a shown sprite at a pixel, 0 … 255.
int alpha_at(const ShownSprite& shown, const chunker::SpriteStore& sprites, int x, int y) {
  const int column = x - static_cast<int>(std::lround(shown.screen_from_sprite[2].x));
  const int row = y - static_cast<int>(std::lround(shown.screen_from_sprite[2].y));
  return sprites.find(shown.layer)->texel(column, row).a;
}

bool is_covered_in_part(const FrameReport& report, const chunker::SpriteStore& sprites, int x, int y) {
  return std::any_of(report.shown.begin(), report.shown.end(), [&](const ShownSprite& shown) {
    const int alpha = alpha_at(shown, sprites, x, y);
    return alpha > 0 && alpha < 255;
  });
}

int difference(const Image8& a, const Image8& b, int pixel) {
  int largest = 0;
  for (int c = 0; c < 3; ++c)
    largest = std::max(largest, std::abs(a.rgb[3 * pixel + c] - b.rgb[3 * pixel + c]));
  return largest;
}

/// Draws all frames as `reference` does and compares the merged ones with one pass over the scene, at pixels
/// that no sprite covers in part. `without` is the same scene without the term that is to be seen in the
/// aggregate.
void expect_merged_frames_equal_one_pass(const Sequence& s, const Sequence& without) {
  Playback run(s, shaded_settings(s, Policy::Reference), true);
  const Pipeline plain =
      make_pipeline(*without.scene, without.layers, shaded_settings(without, Policy::Direct));
  const chunker::PreparedScene plain_scene(*without.scene);
  long compared = 0, wrong = 0, of_the_term = 0;
  int largest = 0;
  while (run.frame < 12) {
    const FrameReport report = run.next();
    if (!is_merged(report)) continue;
    const Image8 shown = to_image8(report.picture);
    const Image8 direct = to_image8(draw_direct(run.pipeline, report.frame, *run.prepared));
    const Image8 bare = to_image8(draw_direct(plain, report.frame, plain_scene));
    for (int pixel = 0; pixel < shown.width * shown.height; ++pixel) {
      if (is_covered_in_part(report, run.state.sprites, pixel % shown.width, pixel / shown.width)) continue;
      const int d = difference(shown, direct, pixel);
      ++compared;
      wrong += d > 2;
      largest = std::max(largest, d);
      of_the_term += difference(shown, bare, pixel) > 8;
    }
  }
  std::printf("  %ld pixels compared, at most %d code values apart; %ld show the term\n", compared, largest,
              of_the_term);
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(compared, 3L * 160 * 120 / 2);
  EXPECT_GT(of_the_term, 200) << "the term is not to be seen: nothing was tested";
}

TEST(AggregateShades, ShadowInAnAggregateIsThatOfOnePass) {
  expect_merged_frames_equal_one_pass(
      sequence_of(kLampAndWall),
      sequence_of(with(kLampAndWall, "casts_shadow: true", "casts_shadow: false")));
}

TEST(AggregateShades, HighlightInAnAggregateIsThatOfOnePass) {
  const std::string dull = with(kLampAndWall, "specular: [0.4, 0.4, 0.4]", "specular: [0, 0, 0]");
  expect_merged_frames_equal_one_pass(sequence_of(kLampAndWall), sequence_of(dull));
}

/// A mirror on the ground, factored, through which a ball rises; a post stands on one side.
const std::string kMirror =
    "frames: 32\n"
    "fps: 1\n"
    "display: [160, 120]\n"
    "shapes:\n"
    "  - {id: mirror, plane: [8, 8], color: [0.2, 0.2, 0.3], reflectivity: 0.6}\n"
    "  - id: ball\n"
    "    sphere: 2\n"
    "    segments: 12\n"
    "    color: [0.9, 0.3, 0.1]\n"
    "    flight: [{t: 0, position: [0, 4, 0], target: [0, -100, 0]},\n"
    "             {t: 8, position: [0, -4, 0], target: [0, -100, 0]}]\n"
    "  - {id: post, box: [0.5, 2, 0.5], position: [2.5, 1.2, -1], color: [0.8, 0.8, 0.2]}\n"
    "camera: {fov_deg: 60, near_m: 1, far_m: 100, position: [0, 4, 9], look_at: [0, 0, 0]}\n"
    "lights: [{kind: ambient, color: [1, 1, 1]}]\n"
    "layers:\n"
    "  - {name: mirror, parts: [mirror], shading: {reflection: {}}}\n"
    "  - {name: ball, parts: [ball]}\n"
    "  - {name: post, parts: [post], group: foreground}\n";

TEST(AggregateShades, ReflectionInAnAggregateIsThatOfOnePass) {
  const Sequence s = sequence_of(kMirror);
  ASSERT_EQ(s.layers.layers[1].name, "mirror/reflection");
  expect_merged_frames_equal_one_pass(s, sequence_of(with(kMirror, "reflectivity: 0.6", "reflectivity: 0")));
}

TEST(AggregateShades, ThresholdZeroEqualsReferenceByteForByte) {
  const Sequence s = sequence_of(kLampAndWall);
  Playback zero(s, shaded_settings(s, Policy::Threshold, 0), true),
      all(s, shaded_settings(s, Policy::Reference), true);
  int merged_frames = 0;
  while (all.frame < 14) {
    const FrameReport a = zero.next(), b = all.next();
    EXPECT_EQ(hash_of(a.picture), hash_of(b.picture)) << a.frame;
    merged_frames += is_merged(b);
  }
  EXPECT_GT(merged_frames, 2);
}

TEST(AggregateShades, PlanWithoutPixelsMakesTheSameDecisionsAndPasses) {
  const Sequence s = sequence_of(kLampAndWall);
  Playback planned(s, shaded_settings(s, Policy::Threshold)),
      drawn(s, shaded_settings(s, Policy::Threshold), true);
  while (drawn.frame < 14) {
    const FrameReport a = planned.next(), b = drawn.next();
    EXPECT_EQ(a.shade, b.shade) << a.frame;
    ASSERT_EQ(a.plan.decisions.size(), b.plan.decisions.size());
    for (const regulator::LayerDecision& d : a.plan.decisions)
      ASSERT_EQ(json_of(a, d), json_of(b, b.plan.decisions[d.layer]));
  }
}

// --- The light on an aggregate ---

/// Two squares that face the eye and cross in a line, tilted by two degrees each, so that they are always
/// merged. A sun that goes around them in the plane of that line gives both the same light, which falls to
/// 0.3 from frame to frame.
Sequence crossed_squares_at_dusk() {
  Sequence s = sequence_of(
      "frames: 12\n"
      "display: [160, 120]\n"
      "shapes:\n"
      "  - {id: red, plane: [4, 3], rotation_deg: [88, 0, 0], color: [0.9, 0.1, 0.1]}\n"
      "  - {id: green, plane: [3, 4], rotation_deg: [92, 0, 0], color: [0.1, 0.8, 0.1]}\n"
      "camera: {fov_deg: 50, near_m: 1, far_m: 100, position: [0, 0, 8], look_at: [0, 0, 0]}\n"
      "layers:\n"
      "  - {name: red, parts: [red]}\n"
      "  - {name: green, parts: [green]}\n");
  layers::Scene scene = *s.scene;
  layers::TransformTrack track;
  for (int frame = 0; frame < s.frames; ++frame) {
    track.rotation.times_s.push_back(frame / s.fps);
    const double level = 1 - 0.7 * frame / (s.frames - 1);
    track.rotation.values.push_back(glm::angleAxis(std::acos(level), layers::dvec3(0, 1, 0)));
  }
  scene.nodes.emplace_back();
  scene.tracks.push_back({static_cast<int>(scene.nodes.size()) - 1, track});
  layers::Light sun;
  sun.name = "sun";
  sun.node = scene.tracks.back().node;
  sun.direction = {0, 0, -1};
  scene.lights = {sun};
  s.scene = std::make_shared<const layers::Scene>(std::move(scene));
  return s;
}

constexpr int kSquares = 2;

TEST(AggregateLight, ThatDimsIsFollowedWithoutRenders) {
  const Sequence s = crossed_squares_at_dusk();
  Playback warped(s, shaded_settings(s, Policy::Threshold), true),
      truth(s, shaded_settings(s, Policy::Reference), true);
  int renders = 0;
  while (warped.frame < s.frames) {
    const FrameReport a = warped.next(), b = truth.next();
    ASSERT_TRUE(is_merged(a));
    const regulator::LayerDecision& decision = a.plan.decisions[kSquares];
    renders += decision.action == Action::Rerender;
    EXPECT_NEAR(decision.shown_color.x, 1 - 0.7 * a.frame / (s.frames - 1), 1e-6) << a.frame;
    const Image8 shown = to_image8(a.picture), want = to_image8(b.picture);
    int largest = 0;
    for (int pixel = 0; pixel < shown.width * shown.height; ++pixel)
      largest = std::max(largest, difference(shown, want, pixel));
    EXPECT_LE(largest, 2) << a.frame;
  }
  EXPECT_EQ(renders, 1);
}

TEST(AggregateLight, WithoutColourWarpTheLightIsTheReasonToDrawAgain) {
  const Sequence s = crossed_squares_at_dusk();
  Settings settings = shaded_settings(s, Policy::Threshold);
  settings.regulator.color_warp = false;
  Playback run(s, settings);
  int renders = 0, named = 0;
  while (run.frame < s.frames) {
    const regulator::LayerDecision decision = run.next().plan.decisions[kSquares];
    renders += decision.action == Action::Rerender;
    named += decision.reason.find("(light 'sun')") != std::string::npos;
  }
  EXPECT_GT(renders, 3);
  EXPECT_EQ(named, renders - 1) << "all but the first appearance";
}

/// Two white boxes that stand in each other, so that they are always merged, under ambient light of a half. The
/// first one's first texture is weighted by `first_keys`.
std::vector<FrameReport> fading_in_a_merged_sprite(double photometric, const std::string& first_keys) {
  const TemporaryFolder folder;
  folder.write("white.ppm", "P3 1 1 255\n255 255 255\n");
  const std::string text =
      "frames: 10\nfps: 10\ndisplay: [64, 48]\nshapes:\n"
      "  - {id: a, box: [4, 1, 1], color: [1, 1, 1], texture: white.ppm, texture2: white.ppm, texture_blend: "
      "[1, 0]}\n"
      "  - {id: b, box: [1, 4, 1], color: [1, 1, 1]}\n"
      "camera: {fov_deg: 60, near_m: 1, far_m: 100, position: [0, 0, 10], look_at: [0, 0, 0]}\n"
      "lights: [{kind: ambient, color: [0.5, 0.5, 0.5]}]\n"
      "layers:\n  - {name: a, parts: [a], shading: {textures: {}, first_blend: " +
      first_keys + "}}\n  - {name: b, parts: [b]}\n";
  const Sequence sequence = load_sequence(folder.write("fading.yaml", text));
  Settings settings = shaded_settings(sequence, Policy::Threshold);
  settings.regulator.thresholds.photometric = photometric;
  return Playback(sequence, settings).all(10);
}

TEST(AggregateShades, TexturesThatFadeInsideAMergedSpriteAreFollowed) {
  const std::string fading = "[{t: 0, value: 1}, {t: 1, value: 0.5}]",
                    steady = "[{t: 0, value: 1}, {t: 1, value: 1}]";
  const auto reports = fading_in_a_merged_sprite(0.1, fading);
  int renders = 0, checked = 0, depicted = 0;
  for (const FrameReport& report : reports) {
    ASSERT_TRUE(is_merged(report)) << report.frame;
    const std::size_t both = report.layers.size() - 1;
    ASSERT_EQ(report.layers[both].name, "a+b");
    const bool drawn = report.plan.decisions[both].action == Action::Rerender;
    if (report.frame > 0) {
      // The factor has fallen by 0.05 a frame since the sprite was drawn; the colour of white under a half is 0.5 √3.
      const double change = 0.05 * (report.frame - depicted);
      EXPECT_NEAR(report.assessments[both].fiducials.photometric.color, change * 0.5 * std::sqrt(3.0), 1e-9);
      ++checked;
    }
    renders += drawn;
    if (drawn) depicted = report.frame;
  }
  EXPECT_EQ(checked, 9);
  EXPECT_EQ(renders, 4);  // 0.0433 a frame: beyond 0.1 in every third
  renders = 0;
  for (const FrameReport& report : fading_in_a_merged_sprite(0.1, steady))
    renders += report.plan.decisions[report.layers.size() - 1].action == Action::Rerender;
  EXPECT_EQ(renders, 1);
}

}  // namespace
}  // namespace talisman::sequences
