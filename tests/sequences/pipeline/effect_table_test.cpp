// SPDX-License-Identifier: Apache-2.0
// The whole table of effects, word for word, of the sequences that ship with the tool and of bare models: an
// effect that is called for without need costs time, one that is missed leaves a hole in the picture.
#include "layers/effects.h"

#include <gtest/gtest.h>

#include "sequences/content/sequence.h"
#include "sequences/files/image_io.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using tests::TemporaryFolder;

/// One line of the table, as `talisman inspect` prints it.
struct Row {
  std::string effect;
  bool called = false;
  std::string why;
};

constexpr bool kCalled = true, kNot = false;

/// The table must have these rows and no others, in this order.
void expect_table(const Sequence& s, const std::vector<Row>& rows, const layers::RunEffects& run = {}) {
  const std::vector<layers::EffectCall> table = layers::effects_called_for(*s.scene, s.layers.layers, run);
  ASSERT_EQ(rows.size(), layers::kAllEffects.size()) << "every effect is expected to be called for or not";
  ASSERT_EQ(table.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(layers::name(table[i].effect), rows[i].effect);
    EXPECT_EQ(table[i].called, rows[i].called) << rows[i].effect;
    EXPECT_EQ(table[i].why, rows[i].why) << rows[i].effect;
    EXPECT_EQ(table[i].layers.empty(), !rows[i].called) << rows[i].effect;
  }
}

/// Names of the layers that use an effect, in one text.
std::string users_of(const Sequence& s, layers::Effect effect) {
  std::string names;
  for (const layers::EffectCall& call : layers::effects_called_for(*s.scene, s.layers.layers))
    if (call.effect == effect)
      for (const int layer : call.layers) names += (names.empty() ? "" : ", ") + s.layers.layers[layer].name;
  return names;
}

/// A sequence whose content lies in packages: skipped where they were not fetched.
class EffectTable : public ::testing::Test {
 protected:
  bool load(const std::string& name) {
    try {
      sequence_ = load_sequence(name);
    } catch (const InputError& e) {
      missing_ = std::string("content was not fetched: ") + e.what();
      return false;
    }
    return true;
  }
  Sequence sequence_;
  std::string missing_;
};

/// What only models of other programs bring, or the policy of a run.
const std::vector<Row> kOfModels = {
    {"emissive_map", kNot, "no lit material has an emissive texture"},
    {"morphing", kNot, "no part has morph targets"},
    {"light_falloff", kNot, "no light fades with distance"},
    {"normal_map", kNot, "no lit part has a normal texture and tangents"},
    {"moving_picture", kNot, "no material shows an image sequence or a video"},
    {"predictive", kNot, "the run does not ask for it"}};

/// The stage, factored or not: it differs in the resolution of its layers and from the shadow layers on.
std::vector<Row> stage_table(const Row& resolution, const std::vector<Row>& shade_layers) {
  std::vector<Row> rows{
      {"texture", kCalled, "material 'floor' has texture 'floor01.png'"},
      {"mip_filter", kCalled, "material 'floor' has texture 'floor01.png'"},
      {"lighting", kCalled, "material 'wall' is lit"},
      {"specular_highlight", kCalled, "material 'wall' has specular > 0"},
      {"translucency", kCalled, "material 'glass' has opacity < 1"},
      {"skinning", kCalled, "part 'figure/$dummy_root/Wuson' has a skin"},
      resolution,
      {"motion_blur", kNot, "no layer has motion_blur > 0"},
      {"sprite_compression", kNot, "the run does not ask for it"},
      {"visibility_sort", kCalled, "layers 'wall' and 'floor' of group background can overlap"},
      {"color_warp", kCalled, "part 'wall' and light 'spot' move against each other"},
      {"shadow_map", kCalled, "light 'spot': drawn again when light or casters move"}};
  rows.insert(rows.end(), shade_layers.begin(), shade_layers.end());
  rows.insert(rows.end(), kOfModels.begin(), kOfModels.end());
  return rows;
}

TEST_F(EffectTable, OfTheStageCallsForAllShading) {
  if (!load("stage")) GTEST_SKIP() << missing_;
  expect_table(
      sequence_,
      stage_table(
          {"layer_resolution", kCalled, "layer 'wall/shadow of spot' has its own resolution"},
          {{"shadow_layer", kCalled, "layer 'wall/shadow of spot' holds the shadows of light 'spot'"},
           {"specular_layer", kCalled, "layer 'floor/specular' holds the highlights of its base"},
           {"reflection_map", kCalled, "layer 'floor/reflection' mirrors 5 layers"},
           {"reflection_layer", kCalled, "layer 'floor/reflection' holds the mirrored picture"},
           {"texture_layers", kCalled, "layer 'floor/texture 2' holds the second texture of its base"}}));
  EXPECT_EQ(users_of(sequence_, layers::Effect::SpecularLayer), "floor/specular, ball/specular");
  EXPECT_EQ(users_of(sequence_, layers::Effect::TextureLayers), "floor/texture 2");
  EXPECT_EQ(users_of(sequence_, layers::Effect::Skinning), "figure");
  EXPECT_EQ(users_of(sequence_, layers::Effect::ColorWarp),
            "wall, floor, mobile, figure, ball, ball/light of spot, glass");
}

TEST_F(EffectTable, OfTheStageUnfactoredHasNoShadeLayer) {
  if (!load("stage/unfactored")) GTEST_SKIP() << missing_;
  expect_table(
      sequence_,
      stage_table({"layer_resolution", kNot, "every layer has the display's resolution"},
                  {{"shadow_layer", kNot, "no layer factors its shadows: their sprites hold them"},
                   {"specular_layer", kNot, "no layer with highlights factors them: its sprite holds them"},
                   {"reflection_map", kCalled, "layer 'floor' mirrors 5 layers"},
                   {"reflection_layer", kNot, "no layer factors its reflection: its sprite holds it"},
                   {"texture_layers", kNot, "no layer factors its second texture: its sprite holds it"}}));
}

/// Lit, textured or not, and nothing else: what is said of all other effects is the same.
std::vector<Row> plain_rows(const Row& texture, const Row& lighting, const Row& sort, const Row& color_warp) {
  return {texture,
          {"mip_filter", texture.called, texture.why},
          lighting,
          {"specular_highlight", kNot, "no lit material has specular > 0"},
          {"translucency", kNot, "every material is opaque"},
          {"skinning", kNot, "no part has a skin"},
          {"layer_resolution", kNot, "every layer has the display's resolution"},
          {"motion_blur", kNot, "no layer has motion_blur > 0"},
          {"sprite_compression", kNot, "the run does not ask for it"},
          sort,
          color_warp,
          {"shadow_map", kNot, "no light casts shadows"},
          {"shadow_layer", kNot, "no light casts shadows"},
          {"specular_layer", kNot, "no lit material has specular > 0"},
          {"reflection_map", kNot, "no material has reflectivity > 0"},
          {"reflection_layer", kNot, "no material has reflectivity > 0"},
          {"texture_layers", kNot, "no material has a second texture"},
          kOfModels[0],
          kOfModels[1],
          kOfModels[2],
          kOfModels[3],
          kOfModels[4],
          kOfModels[5]};
}

TEST_F(EffectTable, OfTheCarouselCallsForOrderAndLight) {
  // Needs no package, so it is never skipped.
  expect_table(
      load_sequence("carousel"),
      plain_rows({"texture", kNot, "no material has a texture"},
                 {"lighting", kCalled, "material 'ground' is lit"},
                 {"visibility_sort", kCalled, "layers 'disc' and 'pole' of group normal can overlap"},
                 {"color_warp", kCalled, "part 'disc' and light 'sun' move against each other"}));
}

TEST_F(EffectTable, OfTheCanyonCallsForTexturesOrderAndLight) {
  if (!load("canyon")) GTEST_SKIP() << missing_;
  expect_table(
      sequence_,
      plain_rows(
          {"texture", kCalled, "material 'sky' has texture 'sky'"},
          {"lighting", kCalled, "material 'canyon/0' is lit"},
          {"visibility_sort", kCalled, "layers 'canyon 0' and 'canyon 1' of group normal can overlap"},
          {"color_warp", kCalled,
           "part 'crosser/<3DSRoot>/V2Grp01/V2Grp02/pSphere01/pSphere4_0' and light 'sun' move against "
           "each other"}));
}

// --- Bare models ---

/// One triangle, without normals, coordinates or a material.
const char* const kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

TEST_F(EffectTable, OfABareTriangleCallsForLightAlone) {
  const TemporaryFolder folder;
  const std::vector<Row> rows =
      plain_rows({"texture", kNot, "no material has a texture"},
                 {"lighting", kCalled, "material 'DefaultMaterial' is lit"},
                 {"visibility_sort", kNot, "no two layers are in one group"},
                 {"color_warp", kNot, "no light moves against a lit layer, and no highlight moves"});
  expect_table(load_sequence(folder.write("triangle.obj", kTriangle), {.stage = false}), rows);
}

TEST_F(EffectTable, OfARunThatCompressesSaysSoOfEveryLayer) {
  const TemporaryFolder folder;
  std::vector<Row> rows =
      plain_rows({"texture", kNot, "no material has a texture"},
                 {"lighting", kCalled, "material 'DefaultMaterial' is lit"},
                 {"visibility_sort", kNot, "no two layers are in one group"},
                 {"color_warp", kNot, "no light moves against a lit layer, and no highlight moves"});
  rows[8] = {"sprite_compression", kCalled, "the run asks for quality 85"};
  expect_table(load_sequence(folder.write("triangle.obj", kTriangle), {.stage = false}), rows,
               {.compression_quality = 85});
}

TEST_F(EffectTable, OfARunThatPredictsSaysSoOfEveryLayer) {
  const Sequence blocks = load_sequence("fearing/blocks");
  layers::RunEffects run;
  run.predictive = true;
  const std::vector<layers::EffectCall> table =
      layers::effects_called_for(*blocks.scene, blocks.layers.layers, run);
  const layers::EffectCall& call = table.at(static_cast<std::size_t>(layers::Effect::Predictive));
  EXPECT_TRUE(call.called);
  EXPECT_EQ(call.why, "the run's policy is predictive");
  EXPECT_EQ(call.layers.size(), blocks.layers.layers.size());
}

TEST_F(EffectTable, OfAModelWithATileAndAPaneCallsForWhatTheirMaterialsNeed) {
  // The camera of a bare model orbits, so the pane's highlight moves though nothing else does.
  const TemporaryFolder folder;
  write_png(folder.path() + "/tile.png", {2, 2, std::vector<std::uint8_t>(12, 200)});
  folder.write("two.mtl",
               "newmtl tile\nKd 1 1 1\nmap_Kd tile.png\n"
               "newmtl glass\nKd 0.2 0.4 0.6\nKs 0.5 0.5 0.5\nNs 40\nd 0.5\n");
  const Sequence s = load_sequence(
      folder.write(
          "two.obj",
          "mtllib two.mtl\nv -2 0 0\nv -1 0 0\nv -1 1 0\nv 1 0 0\nv 2 0 0\nv 2 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
          "o floor\nusemtl tile\nf 1/1 2/2 3/3\no pane\nusemtl glass\nf 4/1 5/2 6/3\n"),
      {.stage = false});
  std::vector<Row> rows =
      plain_rows({"texture", kCalled, "material 'tile' has texture 'tile.png'"},
                 {"lighting", kCalled, "material 'tile' is lit"},
                 {"visibility_sort", kCalled, "layers 'floor' and 'pane' of group normal can overlap"},
                 {"color_warp", kCalled, "part 'two.obj/pane' is specular and moves against the eye"});
  rows[3] = {"specular_highlight", kCalled, "material 'glass' has specular > 0"};
  rows[4] = {"translucency", kCalled, "material 'glass' has opacity < 1"};
  rows[13] = {"specular_layer", kNot, "no layer with highlights factors them: its sprite holds them"};
  expect_table(s, rows);
}

}  // namespace
}  // namespace talisman::sequences
