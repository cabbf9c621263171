// SPDX-License-Identifier: Apache-2.0
// The keys of a sequence file that say how surfaces are shaded and their sprites are kept: each value arrives
// where it is used, and what is wrong is refused with its line.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "layers/effects.h"
#include "sequences/commands/options.h"
#include "sequences/content/sequence_file.h"
#include "sequences/files/image_io.h"
#include "tests/sequences/sequence_lines.h"

namespace talisman::sequences {
namespace {

using layers::Interpolation;
using layers::Layer;
using layers::LayerKind;
using ::testing::HasSubstr;
using tests::message_of;
using tests::TemporaryFolder;

/// Line 1 … of a file that is right; tests change one line.
// NOLINTBEGIN(bugprone-suspicious-missing-comma): a line of the file may take two of these
const std::vector<std::string> kShadedLines = {
    /*1*/ "frames: 24",
    /*2*/ "shapes:",
    /*3*/
    "  - {id: floor, plane: [8, 8], texture: a.png, texture2: b.png, texture_blend: [0.6, 0.35],"
    " specular: [0.5, 0.25, 0.125], shininess: 60, reflectivity: 0.22}",
    /*4*/ "  - {id: ball, sphere: 1, position: [0, 1, 0]}",
    /*5*/ "camera: {position: [0, 3, 8], look_at: [0, 0, 0]}",
    /*6*/ "lights:",
    /*7*/
    "  - {kind: spot, name: lamp, position: [3, 4, 0], look_at: [0, 0, 0], color: [1, 0.5, 0.25],"
    " intensity: 2, inner_deg: 10, outer_deg: 25, casts_shadow: true,"
    " shadow_map: {resolution_px: 512, bias_texels: 2.5, slope_bias: 3, pcf_radius: 4}}",
    /*8*/ "  - {kind: directional, name: sun, direction: [0, -1, 0]}",
    /*9*/ "layers:",
    /*10*/ "  - name: floor",
    /*11*/ "    parts: [floor]",
    /*12*/ "    casts_shadows: false",
    /*13*/ "    fade: [{t: 0, value: 1}, {t: 0.5, value: 0.25}]",
    /*14*/ "    shading:",
    /*15*/ "      shadows: {as: shade, resolution_scale: 0.5, max_update_rate: 0.75}",
    /*16*/ "      specular: {motion_blur: 0.25}",
    /*17*/ "      reflection: {min_update_rate: 0.125}",
    /*18*/ "      textures: {importance: {photometric: 0}}",
    /*19*/ "      first_blend: 0.4",
    /*20*/ "      second_blend: [{t: 0, value: 0.3}, {t: 0.5, value: 0.7}]",
    /*21*/ "  - {name: ball, parts: [ball], fade: 0.85, preferences: {motion_blur: 0.5}}",
    /*22*/ "compression: {quality: 70}"};
// NOLINTEND(bugprone-suspicious-missing-comma)

Sequence load_shaded(const TemporaryFolder& folder, const std::vector<std::string>& lines = kShadedLines) {
  for (const char* name : {"/a.png", "/b.png"})
    write_png(folder.path() + name, {2, 1, std::vector<std::uint8_t>(6, name[1] == 'a' ? 200 : 100)});
  return load_sequence(folder.write("test.yaml", tests::text_of(lines)));
}

Sequence load_shaded() {
  const TemporaryFolder folder;
  return load_shaded(folder);
}

const Layer& layer_of(const Sequence& s, const std::string& name) {
  for (const Layer& layer : s.layers.layers)
    if (layer.name == name) return layer;
  throw std::runtime_error("no layer " + name);
}

TEST(LoadShading, EveryTermIsALayerWithItsOwnPreferences) {
  const Sequence s = load_shaded();
  const Layer& floor = layer_of(s, "floor");
  EXPECT_TRUE(floor.factored.shadows && floor.factored.specular && floor.factored.reflection &&
              floor.factored.second_texture);
  EXPECT_EQ(floor.holds, layers::HeldTerms{});
  const Layer& shadow = layer_of(s, "floor/shadow of lamp");
  EXPECT_EQ(shadow.kind, LayerKind::Shadow);
  EXPECT_EQ(shadow.preferences.resolution_scale, 0.5);
  EXPECT_EQ(shadow.preferences.max_update_rate, 0.75);
  EXPECT_EQ(shadow.light, 0);
  const Layer& specular = layer_of(s, "floor/specular");
  EXPECT_EQ(specular.kind, LayerKind::Specular);
  EXPECT_EQ(specular.preferences.motion_blur, 0.25);
  EXPECT_EQ(specular.preferences.resolution_scale, 1) << "that of the shadow is the shadow's alone";
  const Layer& reflection = layer_of(s, "floor/reflection");
  EXPECT_EQ(reflection.kind, LayerKind::Reflection);
  EXPECT_EQ(reflection.preferences.min_update_rate, 0.125);
  const Layer& texture = layer_of(s, "floor/texture 2");
  EXPECT_EQ(texture.kind, LayerKind::Texture);
  EXPECT_EQ(texture.preferences.importance.photometric, 0);
  EXPECT_EQ(texture.preferences.importance.geometric, 1);
  EXPECT_EQ(s.layers.layers.size(), 6u);
}

// Both textures are lit by the lamp, and each has a multiplier of its own.
TEST(LoadShading, ShadowsAsLightAreALayerForEachTexture) {
  const TemporaryFolder folder;
  std::vector<std::string> lines = kShadedLines;
  lines[14] = "      shadows: {as: light, resolution_scale: 0.5}";
  const Sequence s = load_shaded(folder, lines);
  EXPECT_EQ(layer_of(s, "floor").shadows_as, layers::ShadowsAs::Light);
  const Layer &first = layer_of(s, "floor/light of lamp"),
              &second = layer_of(s, "floor/light of lamp, texture 2");
  EXPECT_EQ(first.kind, LayerKind::Light);
  EXPECT_EQ(first.preferences.resolution_scale, 0.5);
  EXPECT_EQ(first.gain.values, (std::vector{0.4}));
  EXPECT_EQ(second.gain.values, (std::vector{0.3, 0.7}));
  EXPECT_EQ(first.fade.values, (std::vector{1, 0.25})) << "a fade takes the light with it";
  lines[14] = "      shadows: {}";
  EXPECT_EQ(layer_of(load_shaded(folder, lines), "floor").shadows_as, layers::ShadowsAs::Light)
      << "two lights reach the floor";
}

TEST(LoadShading, TermThatIsNotNamedStaysInTheSprite) {
  const TemporaryFolder folder;
  std::vector<std::string> lines = kShadedLines;
  for (const int line : {15, 16, 18, 19, 20}) lines[line - 1] = "";
  const Sequence s = load_shaded(folder, lines);
  ASSERT_EQ(s.layers.layers.size(), 3u);
  const layers::HeldTerms stays{
      .shadows = true, .reflection = false, .specular = true, .second_texture = true};
  EXPECT_EQ(layer_of(s, "floor").holds, stays);
  EXPECT_EQ(layer_of(s, "floor/reflection").preferences.min_update_rate, 0.125);
}

TEST(LoadShading, BlendsAndFadesAreKeysOverTime) {
  const Sequence s = load_shaded();
  const layers::Keys<double>&second = layer_of(s, "floor/texture 2").gain, &first = layer_of(s, "floor").gain;
  EXPECT_EQ(second.times_s, (std::vector{0.0, 0.5}));
  EXPECT_EQ(second.values, (std::vector{0.3, 0.7}));
  EXPECT_EQ(second.interpolation, Interpolation::Linear);
  EXPECT_EQ(first.values, (std::vector{0.4})) << "one number holds at all times";
  EXPECT_EQ(layer_of(s, "floor").fade.values, (std::vector{1, 0.25}));
  EXPECT_EQ(layer_of(s, "floor/shadow of lamp").fade.values, (std::vector{1, 0.25}))
      << "a base fades with its terms";
  EXPECT_EQ(layer_of(s, "ball").fade.values, (std::vector{0.85}));
}

TEST(LoadShading, LayerThatCastsNoShadowIsInNoMap) {
  const Sequence s = load_shaded();
  const int ball = layer_of(s, "ball").id;
  EXPECT_EQ(layer_of(s, "floor/shadow of lamp").casters, std::vector{ball});
  EXPECT_EQ(s.layers.casting_parts, layer_of(s, "ball").parts);
  // A floor that may cast lies below the ball and the lamp above it: none of its shadow falls on the ball.
  const TemporaryFolder folder;
  std::vector<std::string> lines = kShadedLines;
  lines[11] = "    casts_shadows: true";
  EXPECT_EQ(load_shaded(folder, lines).layers.casting_parts.size(), 1u);
}

TEST(LoadShading, MotionBlurIsThatOfTheLayer) {
  const Sequence s = load_shaded();
  EXPECT_EQ(layer_of(s, "ball").preferences.motion_blur, 0.5);
  EXPECT_EQ(layer_of(s, "floor").preferences.motion_blur, 0);
}

TEST(LoadMaterial, SecondTextureHighlightAndMirrorArrive) {
  const Sequence s = load_shaded();
  const layers::Material& floor = s.scene->materials[s.scene->parts[0].material];
  ASSERT_GE(floor.texture2, 0);
  EXPECT_EQ(s.scene->textures[floor.texture].name, "a.png");
  EXPECT_EQ(s.scene->textures[floor.texture2].name, "b.png");
  EXPECT_EQ(s.scene->textures[floor.texture2].rgba[0], 100);
  EXPECT_EQ(floor.texture_blend, layers::vec2(0.6f, 0.35f));
  EXPECT_EQ(floor.specular, layers::vec3(0.5f, 0.25f, 0.125f));
  EXPECT_EQ(floor.shininess, 60);
  EXPECT_EQ(floor.reflectivity, 0.22f);
}

TEST(LoadMaterial, BlendOfTheMaterialHoldsWhereTheLayerSaysNone) {
  const TemporaryFolder folder;
  std::vector<std::string> lines = kShadedLines;
  lines[18] = lines[19] = "";
  const Sequence s = load_shaded(folder, lines);
  EXPECT_EQ(layer_of(s, "floor").gain.values, (std::vector{double{0.6f}}));
  EXPECT_EQ(layer_of(s, "floor/texture 2").gain.values, (std::vector{double{0.35f}}));
}

TEST(LoadLights, SpotStandsWhereItIsPutAndShinesWhereItLooks) {
  const Sequence s = load_shaded();
  ASSERT_EQ(s.scene->lights.size(), 2u);
  const layers::LightState lamp = s.scene->at(0).lights[0];
  EXPECT_EQ(lamp.kind, layers::Light::Kind::Spot);
  EXPECT_LT(glm::distance(lamp.position, layers::dvec3(3, 4, 0)), 1e-12);
  EXPECT_LT(glm::distance(lamp.direction, layers::dvec3(-0.6, -0.8, 0)), 1e-12);
  EXPECT_EQ(lamp.color, layers::vec3(2, 1, 0.5f)) << "times the intensity";
  EXPECT_NEAR(lamp.inner_cone_rad, 10 * M_PI / 180, 1e-12);
  EXPECT_NEAR(lamp.outer_cone_rad, 25 * M_PI / 180, 1e-12);
}

TEST(LoadLights, ShadowMapHasItsOptions) {
  const Sequence s = load_shaded();
  EXPECT_TRUE(s.scene->lights[0].casts_shadow);
  EXPECT_EQ(s.scene->lights[0].shadow, (layers::ShadowMapOptions{512, 2.5f, 3, 4}));
  EXPECT_FALSE(s.scene->lights[1].casts_shadow);
  EXPECT_EQ(s.scene->lights[1].shadow, layers::ShadowMapOptions{});
}

TEST(LoadLights, MapWithoutTexelsCastsNoShadowAndCostsNothing) {
  const TemporaryFolder folder;
  std::vector<std::string> lines = kShadedLines;
  lines[6].replace(lines[6].find("512"), 3, "0");
  const Sequence s = load_shaded(folder, lines);
  EXPECT_TRUE(s.layers.casting_parts.empty());
  for (const Layer& layer : s.layers.layers) EXPECT_NE(layer.kind, LayerKind::Shadow) << layer.name;
  for (const layers::EffectCall& call : layers::effects_called_for(*s.scene, s.layers.layers))
    if (call.effect == layers::Effect::ShadowMap) {
      EXPECT_FALSE(call.called);
      EXPECT_EQ(call.why, "no light casts shadows");
    }
}

TEST(LoadLights, NoMoreThanFourCastShadows) {
  const TemporaryFolder folder;
  std::vector<std::string> lines = kShadedLines;
  for (int i = 0; i < 4; ++i)
    lines[7] += "\n  - {kind: directional, direction: [0, -1, 0], casts_shadow: true}";
  EXPECT_THAT(message_of([&] { load_shaded(folder, lines); }),
              HasSubstr("5 lights cast shadows, rule: at most 4"));
}

TEST(LoadCompression, QualityArrivesAndTheCommandLineOverridesIt) {
  const Sequence s = load_shaded();
  ASSERT_TRUE(s.compression);
  EXPECT_EQ(s.compression->quality, 70);
  CommandLine line;
  EXPECT_EQ(resolve(line, s, false).settings.compression->quality, 70);
  line.compression = 30;
  EXPECT_EQ(resolve(line, s, false).settings.compression->quality, 30);
  line.compression = 0;
  EXPECT_FALSE(resolve(line, s, false).settings.compression);
  line.compression.reset();
  line.policy = "direct";
  EXPECT_FALSE(resolve(line, s, false).settings.compression) << "one pass has no sprites to compress";
}

TEST(LoadCompression, WithoutTheKeySpritesAreKeptAsTheyAre) {
  const TemporaryFolder folder;
  std::vector<std::string> lines = kShadedLines;
  lines[21] = "";
  EXPECT_FALSE(load_shaded(folder, lines).compression);
}

// --- What is wrong ---

void expect_refused(const std::vector<tests::Fault>& faults) {
  tests::expect_refused(kShadedLines, faults, [](const std::vector<std::string>& lines) {
    const TemporaryFolder folder;
    load_shaded(folder, lines);
  });
}

/// Line 3 with `more` keys of its material.
std::string floor_with(const std::string& more) { return "  - {id: floor, plane: [8, 8], " + more + "}"; }

TEST(LoadMaterial, WhatIsWrongIsRefusedWithItsLine) {
  expect_refused({
      {3, floor_with("reflectivity: 1.5"), "shapes[0].reflectivity is '1.5', rule: a number from 0 to 1"},
      {3, floor_with("reflectivity: -0.1"), "shapes[0].reflectivity is '-0.1'"},
      {3, floor_with("reflectivity: .nan"), "shapes[0].reflectivity is '.nan'"},
      {3, floor_with("reflectivity: [1]"), "shapes[0].reflectivity is a list of 1"},
      {3, floor_with("shininess: -1"), "shapes[0].shininess is '-1', rule: a number from 0 to 100000"},
      {3, floor_with("specular: shiny"), "shapes[0].specular is 'shiny', rule: [r, g, b]"},
      {3, floor_with("opacity: 2"), "shapes[0].opacity is '2', rule: a number from 0 to 1"},
      {3, floor_with("texture2: gone.png"), "'gone.png' is not there"},
      {3, floor_with("texture2: [b.png]"), "shapes[0].texture2 is a list of 1, rule: a text"},
      {3, floor_with("texture_blend: [1, 1]"), "key 'texture_blend' is not known here"},
      {3, floor_with("texture2: b.png, texture_blend: [1, 2]"),
       "shapes[0].texture_blend[1] is '2', rule: a number from 0 to 1"},
      {3, floor_with("texture2: b.png, texture_blend: 0.5"),
       "shapes[0].texture_blend is '0.5', rule: a list of 2 numbers"},
  });
}

/// Line 7 with these keys beside kind and place.
std::string spot_with(const std::string& more) {
  return "  - {kind: spot, name: lamp, position: [3, 4, 0], look_at: [0, 0, 0], " + more + "}";
}

TEST(LoadLights, WhatIsWrongIsRefusedWithItsLine) {
  expect_refused({
      {7, spot_with("inner_deg: 30, outer_deg: 20"),
       "lights[0] has inner_deg '30' and outer_deg '20', rule: inner_deg at most outer_deg"},
      {7, spot_with("inner_deg: 31"), "rule: inner_deg at most outer_deg"},  // the outer one is 30 by default
      {7, spot_with("outer_deg: 91"), "lights[0].outer_deg is '91', rule: a number from 0 to 90"},
      {7, spot_with("inner_deg: -1"), "lights[0].inner_deg is '-1'"},
      {7, spot_with("inner_deg: wide"), "lights[0].inner_deg is 'wide'"},
      {7, spot_with("intensity: -2"), "lights[0].intensity is '-2', rule: a number from 0 to 1e+09"},
      {7, spot_with("casts_shadow: often"), "lights[0].casts_shadow is 'often', rule: true or false"},
      {7, spot_with("shadow_map: 512"), "lights[0].shadow_map is '512', rule: a map"},
      {7, spot_with("shadow_map: {resolution_px: 8193}"),
       "lights[0].shadow_map.resolution_px is '8193', rule: a whole number from 0 to 8192"},
      {7, spot_with("shadow_map: {resolution_px: 2.5}"), "resolution_px is '2.5', rule: a whole number"},
      {7, spot_with("shadow_map: {bias_texels: -1}"), "bias_texels is '-1', rule: a number from 0 to 100"},
      {7, spot_with("shadow_map: {slope_bias: 17}"), "slope_bias is '17', rule: a number from 0 to 16"},
      {7, spot_with("shadow_map: {pcf_radius: 9}"), "pcf_radius is '9', rule: a whole number from 0 to 8"},
      {7, spot_with("shadow_map: {pcf: 2}"), "key 'pcf' is not known here; keys are bias_texels"},
      {8, "  - {kind: directional, direction: [0, -1, 0], inner_deg: 5}",
       "key 'inner_deg' is not known here"},
      {8, "  - {kind: directional, direction: [0, 0, 0]}",
       "lights[1].direction is a list of 3, rule: not the zero"},
      {8, "  - {kind: ambient, casts_shadow: true}", "key 'casts_shadow' is not known here"},
      {8, "  - {kind: point}", "has the key 'position'"},
      {8, "  - {kind: bulb}", "lights[1].kind is 'bulb', rule: one of ambient, directional, point, spot"},
  });
}

TEST(LoadShading, WhatIsWrongIsRefusedWithItsLine) {
  expect_refused({
      {12, "    casts_shadows: 2", "layers[0].casts_shadows is '2', rule: true or false"},
      {13, "    fade: 2", "layers[0].fade is '2', rule: a number from 0 to 1"},
      {13, "    fade: []", "layers[0].fade is a list of 0"},
      {13, "    fade: {t: 0}", "layers[0].fade is a map, rule: a number from 0 to 1"},
      {13, "    fade: [{t: 0, value: 1}, {t: 0, value: 0}]",
       "layers[0].fade[1].t is '0', rule: after the key before it"},
      {13, "    fade: [{t: 0, value: -1}]", "layers[0].fade[0].value is '-1'"},
      {13, "    fade: [{t: 0, value: 1, ease: in}]", "key 'ease' is not known here; keys are t, value"},
      {15, "      shadow: {}", "key 'shadow' is not known here; keys are first_blend, reflection"},
      {15, "      shadows: true", "layers[0].shading.shadows is 'true', rule: a map"},
      {15, "      shadows: {resolution_scale: 0}",
       "layers[0].shading.shadows.resolution_scale is '0', rule: a number from 1e-09 to 4"},
      {15, "      shadows: {max_update_rate: 0}", "max_update_rate is '0', rule: a number from 1e-09 to 1"},
      {16, "      specular: {motion_blur: 1.5}",
       "layers[0].shading.specular.motion_blur is '1.5', rule: a number from 0 to 1"},
      {16, "      specular: {motion_blur: .nan}", "motion_blur is '.nan'"},
      {17, "      reflection: {min_update_rate: 2}",
       "layers[0].shading.reflection.min_update_rate is '2', rule: a number from 0 to 1"},
      {17, "      reflection: {shadows: {}}", "key 'shadows' is not known here"},
      {18, "      textures: {importance: {photometric: -1}}",
       "layers[0].shading.textures.importance.photometric is '-1'"},
      {19, "      first_blend: 1.2", "layers[0].shading.first_blend is '1.2', rule: a number from 0 to 1"},
      {20, "      second_blend: much", "layers[0].shading.second_blend is 'much'"},
      {20, "      second_blend: [{value: 1}]", "has the key 't'"},
      {21, "  - {name: ball, parts: [ball], preferences: {motion_blur: -0.5}}",
       "layers[1].preferences.motion_blur is '-0.5', rule: a number from 0 to 1"},
      {21, "  - {name: ball, parts: [ball], preferences: {motion_blur: on}}",
       "layers[1].preferences.motion_blur is 'on'"},
  });
}

TEST(LoadShading, BlendWithoutATextureLayerIsRefused) {
  const TemporaryFolder folder;
  std::vector<std::string> lines = kShadedLines;
  lines[17] = "";
  EXPECT_THAT(
      message_of([&] { load_shaded(folder, lines); }),
      HasSubstr("test.yaml:19: layers[0].shading.first_blend is '0.4', rule: only together with textures"));
}

TEST(LoadCompression, WhatIsWrongIsRefusedWithItsLine) {
  expect_refused({
      {22, "compression: {quality: 0}", "compression.quality is '0', rule: a whole number from 1 to 100"},
      {22, "compression: {quality: 101}", "compression.quality is '101'"},
      {22, "compression: {quality: 2.5}", "compression.quality is '2.5', rule: a whole number"},
      {22, "compression: {quality: high}", "compression.quality is 'high'"},
      {22, "compression: {ratio: 10}", "key 'ratio' is not known here; keys are quality"},
      {22, "compression: 85", "compression is '85', rule: a map"},
  });
}

}  // namespace
}  // namespace talisman::sequences
