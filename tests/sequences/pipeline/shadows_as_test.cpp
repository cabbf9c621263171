// SPDX-License-Identifier: Apache-2.0
// The ways of factoring shadows (layers/shading.h) against the picture without sprites: under lights of several
// hues, at edges, beyond white, behind glass, faded, at rest and in motion.
#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/results/frame_lines.h"
#include "tests/sequences/playback.h"
#include "tests/sequences/temporary_folder.h"
#include "tests/support/sequences.h"

namespace talisman::sequences {
namespace {

using layers::Layer;
using layers::LayerKind;
using layers::ShadowsAs;
using regulator::Action;
using regulator::Policy;

/// `text` with `from` replaced, which must be there.
std::string changed(std::string text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
  return text;
}

/// A white floor under a red, a green and a blue sun, each with its own shadow of a post, ambient light that is
/// none of them. "SHADOWS" is how the floor's shadows are factored.
const std::string kThreeSuns =
    "frames: 12\n"
    "display: [200, 150]\n"
    "background: \"#ffffff\"\n"
    "shapes:\n"
    "  - {id: floor, plane: [7, 7], color: [1, 1, 1]}\n"
    "  - {id: post, box: [0.8, 1.6, 0.8], position: [0, 0.8, 0], color: [0.2, 0.2, 0.2]}\n"
    "camera: {fov_deg: 45, near_m: 0.1, far_m: 60, position: [0.5, 6, 7], look_at: [0, 0, 0]}\n"
    "lights:\n"
    "  - {kind: ambient, color: [0.05, 0.03, 0.08]}\n"
    "  - {kind: directional, name: red, direction: [1, -1.2, 0.1], color: [0.7, 0.1, 0.05], casts_shadow: "
    "true}\n"
    "  - {kind: directional, name: green, direction: [-1, -1.1, 0.3], color: [0.1, 0.5, 0.1], casts_shadow: "
    "true}\n"
    "  - {kind: directional, name: blue, direction: [0.2, -1, -1], color: [0.05, 0.2, 0.6], casts_shadow: "
    "true}\n"
    "layers:\n"
    "  - {name: floor, parts: [floor], group: background, shading: {shadows: {SHADOWS}}}\n"
    "  - {name: post, parts: [post]}\n";

Variant variant_of(const std::string& text, const std::string& as, Policy policy = Policy::Reference) {
  const tests::TemporaryFolder folder;
  Variant variant = tests::run_of(load_sequence(folder.write("suns.yaml", changed(text, "SHADOWS", as))));
  variant.settings.regulator.policy = policy;
  if (as.find("multiply") != std::string::npos || as.find("atop") != std::string::npos)
    variant.settings.compositor = Compositor::Extended;
  return variant;
}

chunker::Frame first_frame(const Variant& variant) {
  return tests::Playback(variant.sequence, variant.settings, true).next().picture;
}

std::vector<std::uint8_t> bytes_of(const std::string& text, const std::string& as,
                                   Policy policy = Policy::Reference) {
  return srgb_bytes(first_frame(variant_of(text, as, policy)));
}

/// The same with shadows in the sprite of their surface.
std::vector<std::uint8_t> unfactored(const std::string& text) {
  return bytes_of(changed(text, ", shading: {shadows: {SHADOWS}}}", "}  # SHADOWS"), "", Policy::Reference);
}

struct Gap {
  int largest = 0;          ///< code values
  std::int64_t beyond = 0;  ///< values that differ by more than 3
};

Gap gap(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  Gap result;
  EXPECT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    const int off = std::abs(a[i] - b[i]);
    result.largest = std::max(result.largest, off);
    result.beyond += off > 3;
  }
  return result;
}

// Edges of the floor, of the shadows and of the post included.
TEST(ShadowsAs, LightIsThePictureWithoutSpritesUpToRounding) {
  const auto direct = bytes_of(kThreeSuns, "as: light", Policy::Direct);
  EXPECT_LE(gap(bytes_of(kThreeSuns, "as: light"), direct).largest, 3);
}

// Three hues: black over the sum of all of them is not what one of them leaves behind.
TEST(ShadowsAs, ShadeIsFarOffUnderLightsOfSeveralHues) {
  const auto direct = bytes_of(kThreeSuns, "as: light", Policy::Direct);
  EXPECT_GT(gap(bytes_of(kThreeSuns, "as: shade"), direct).largest, 30);
}

TEST(ShadowsAs, MultiplyIsThePictureWithoutSpritesUpToRounding) {
  const auto direct = bytes_of(kThreeSuns, "as: light", Policy::Direct);
  const Gap multiply = gap(bytes_of(kThreeSuns, "as: multiply"), direct);
  EXPECT_LE(multiply.largest, 6);  // two roundings of a square root, multiplied, where light is deep red
  EXPECT_LT(multiply.beyond, 40);
}

/// One sun, and ambient light of its hue: a shade is exact but for the floor's edge, where it darkens the white
/// behind it too.
std::string one_sun() {
  std::string text = kThreeSuns;
  text = changed(text, "  - {kind: ambient, color: [0.05, 0.03, 0.08]}\n",
                 "  - {kind: ambient, color: [0.1, 0.1, 0.1]}\n");
  text = changed(text, "color: [0.7, 0.1, 0.05], casts_shadow: true",
                 "color: [0.6, 0.6, 0.6], casts_shadow: true");
  text = changed(text, "color: [0.1, 0.5, 0.1]", "color: [0, 0, 0]");
  text = changed(text, "color: [0.05, 0.2, 0.6]", "color: [0, 0, 0]");
  text = changed(text, "plane: [7, 7]", "plane: [2, 2]");  // the post's shadow falls across its edge
  return text;
}

TEST(ShadowsAs, AtopDarkensTheSurfaceAloneAtItsEdges) {
  const auto direct = bytes_of(one_sun(), "as: atop", Policy::Direct);
  const Gap atop = gap(bytes_of(one_sun(), "as: atop"), direct),
            shade = gap(bytes_of(one_sun(), "as: shade"), direct);
  EXPECT_GT(shade.largest, 8);
  EXPECT_LE(atop.largest, 5);  // where the shadow's own edge crosses the floor's: means of products
  EXPECT_LT(atop.beyond, shade.beyond / 2);
}

// Against sprites that hold all of it: without sprites a texel is averaged before it is cut off, whichever layers
// meet in it.
TEST(ShadowsAs, SumsAboveWhiteAreCutOffAlike) {
  std::string text = kThreeSuns;
  for (const char* color : {"[0.7, 0.1, 0.05]", "[0.1, 0.5, 0.1]", "[0.05, 0.2, 0.6]"})
    text = changed(text, color, "[0.9, 0.9, 0.9]");
  EXPECT_LE(gap(bytes_of(text, "as: light"), unfactored(text)).largest, 3);
  text = changed(text, "color: [1, 1, 1]}", "color: [1, 1, 1], opacity: 0.5}");
  EXPECT_LE(gap(bytes_of(text, "as: light"), unfactored(text)).largest, 3);
  text = changed(
      text, "camera:",
      "  - {id: glass, box: [3, 3, 0.01], position: [1, 3, 3], color: [0, 0.1, 0], opacity: 0.5}\ncamera:");
  text = changed(text, "  - {name: post,",
                 "  - {name: glass, parts: [glass], group: foreground}\n  - {name: post,");
  EXPECT_LE(gap(bytes_of(text, "as: light"), unfactored(text)).largest, 3);
}

TEST(ShadowsAs, OpacityAndFadeTakeTheLightWithThem) {
  std::string text = changed(kThreeSuns, "color: [1, 1, 1]}", "color: [1, 1, 1], opacity: 0.4}");
  EXPECT_LE(gap(bytes_of(text, "as: light"), bytes_of(text, "as: light", Policy::Direct)).largest, 3);
  text = changed(kThreeSuns, "group: background, shading", "group: background, fade: 0.3, shading");
  const auto direct = bytes_of(text, "as: light", Policy::Direct);
  EXPECT_LE(gap(bytes_of(text, "as: light"), direct).largest, 3);
  EXPECT_LE(gap(bytes_of(text, "as: multiply"), direct).largest, 6);
}

// Highlights that stay in the surface belong to their lights.
TEST(ShadowsAs, LightHoldsTheHighlightsThatAreNotFactored) {
  const std::string text = changed(kThreeSuns, "color: [1, 1, 1]}",
                                   "color: [0.3, 0.3, 0.3], specular: [0.5, 0.5, 0.5], shininess: 8}");
  const auto direct = bytes_of(text, "as: light", Policy::Direct);
  EXPECT_LE(gap(bytes_of(text, "as: light"), direct).largest, 3);
  EXPECT_LE(
      gap(bytes_of(changed(text, "shadows: {SHADOWS}", "shadows: {SHADOWS}, specular: {}"), "as: light"),
          direct)
          .largest,
      3);
}

// --- Which way is chosen ---

std::optional<ShadowsAs> chosen(const std::string& text) {
  return variant_of(text, "").sequence.layers.layers[0].shadows_as;
}

TEST(ShadowsAs, LightIsChosenWhereMoreThanOneLightReachesTheSurface) {
  EXPECT_EQ(chosen(kThreeSuns), ShadowsAs::Light);
  EXPECT_EQ(chosen(one_sun()), ShadowsAs::Shade);  // two suns are black
  EXPECT_EQ(chosen(changed(one_sun(), "[0.1, 0.1, 0.1]", "[0.1, 0.1, 0.2]")),
            ShadowsAs::Light);  // another hue
  EXPECT_EQ(chosen(changed(one_sun(), "color: [1, 1, 1]}", "color: [1, 1, 1], emissive: [0, 0.1, 0]}")),
            ShadowsAs::Light);
  const std::string lamp =
      "  - {kind: spot, name: lamp, outer_deg: 5, inner_deg: 2, position: [9, 3, 0], look_at: [9, 0, 0.1]}\n";
  EXPECT_EQ(chosen(changed(one_sun(), "layers:\n", lamp + "layers:\n")),
            ShadowsAs::Shade);  // it shines elsewhere
  EXPECT_EQ(
      chosen(changed(one_sun(), "layers:\n",
                     changed(lamp, "position: [9, 3, 0], look_at: [9,", "position: [1, 3, 0], look_at: [1,") +
                         "layers:\n")),
      ShadowsAs::Light);
  EXPECT_EQ(variant_of(kThreeSuns, "as: shade").sequence.layers.layers[0].shadows_as,
            ShadowsAs::Shade);  // the author wins
}

TEST(ShadowsAs, LightIsALayerForEachLightThatCasts) {
  const Variant variant = variant_of(kThreeSuns, "as: light");
  std::vector<std::string> names;
  for (const Layer& layer : variant.sequence.layers.layers)
    if (layer.kind == LayerKind::Light) names.push_back(layer.name);
  EXPECT_THAT(names,
              testing::ElementsAre("floor/light of red", "floor/light of green", "floor/light of blue"));
}

// --- In motion ---

/// A lamp that moves in one half of the frames, a sun that stands still, and a floor at rest.
const std::string kLampAndSun =
    "frames: 12\n"
    "display: [96, 72]\n"
    "shapes:\n"
    "  - {id: floor, plane: [8, 8]}\n"
    "  - {id: post, box: [0.6, 1.2, 0.6], position: [0, 0.6, 0], color: [0.3, 0.3, 0.3]}\n"
    "camera: {fov_deg: 40, position: [0, 5, 7], look_at: [0, 0, 0]}\n"
    "lights:\n"
    "  - {kind: directional, name: sun, direction: [1, -1, 0], color: [0.5, 0.5, 0.5], casts_shadow: true}\n"
    "  - {kind: point, name: lamp, color: [0.5, 0.3, 0.2], casts_shadow: true,\n"
    "     flight: [{t: 0.25, position: [2, 3, 1], target: [0, 0, 0]}, {t: 0.5, position: [1, 3, 1], target: "
    "[0, 0, 0]}]}\n"
    "layers:\n"
    "  - {name: floor, parts: [floor], group: background, shading: {shadows: {SHADOWS}}}\n"
    "  - {name: post, parts: [post]}\n";

int renders_of(const std::vector<FrameReport>& reports, const std::string& name) {
  int renders = 0;
  for (const FrameReport& report : reports)
    for (const regulator::LayerDecision& decision : report.plan.decisions)
      renders += report.layers[decision.layer].name == name && decision.action == Action::Rerender;
  return renders;
}

TEST(ShadowsAs, ALightDependsOnNoOtherLight) {
  for (const double threshold_px : {0.0, 1.0}) {
    Variant variant = variant_of(kLampAndSun, "as: light", Policy::Threshold);
    variant.settings.regulator.thresholds.geometric_px = threshold_px;
    const auto reports = tests::Playback(variant.sequence, variant.settings).all(12);
    EXPECT_EQ(renders_of(reports, "floor"), 1);
    EXPECT_EQ(renders_of(reports, "floor/light of sun"), 1);
    EXPECT_GE(renders_of(reports, "floor/light of lamp"), 2);
  }
}

// The eye moves, the lamp's light is drawn at most every third time: its sprite is carried beside the floor's.
TEST(ShadowsAs, LightBesideItsSurfaceIsMeasuredAndBounded) {
  const std::string text = changed(kLampAndSun, "position: [0, 5, 7], look_at: [0, 0, 0]}",
                                   "flight: [{t: 0, position: [0, 5, 7], target: [0, 0, 0]}, {t: 0.5, "
                                   "position: [2, 5, 6], target: [0, 0, 0]}]}");
  const Variant variant = variant_of(text, "as: light, max_update_rate: 0.3", Policy::Threshold);
  Settings settings = variant.settings;
  settings.regulator.thresholds.geometric_px = 0.5;
  tests::Playback play(variant.sequence, settings);
  double largest = 0;
  for (const FrameReport& report : play.all(12)) {
    const FrameLine line = line_of(report);
    ASSERT_TRUE(line.light_beside_px.has_value());
    largest = std::max(largest, *line.light_beside_px);
    for (const ShownSprite& shown : report.shown) {
      if (!shown.beside_base_px) continue;
      const auto& decisions = report.plan.decisions;
      const double bound = decisions[shown.layer].shown_geometric_px +
                           decisions[report.layers[shown.layer].base].shown_geometric_px;
      EXPECT_LE(*shown.beside_base_px, bound + 1e-9);
    }
  }
  EXPECT_GT(largest, 0.01);
}

TEST(ShadowsAs, LightAtRestFallsBesideNothing) {
  const Variant variant = variant_of(kThreeSuns, "as: light", Policy::Threshold);
  for (const FrameReport& report : tests::Playback(variant.sequence, variant.settings).all(3))
    EXPECT_EQ(line_of(report).light_beside_px, 0);
  const Variant shade = variant_of(kThreeSuns, "as: shade", Policy::Threshold);
  EXPECT_EQ(line_of(tests::Playback(shade.sequence, shade.settings).next()).light_beside_px, std::nullopt);
}

}  // namespace
}  // namespace talisman::sequences
