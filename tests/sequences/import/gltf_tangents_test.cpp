// SPDX-License-Identifier: Apache-2.0
// Normal maps of glTF as they are read: which tangents a mesh gets, and what is said of maps that cannot be drawn.
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "layers/effects.h"
#include "tests/sequences/import/gltf_builder.h"

namespace talisman::sequences {
namespace {

using layers::vec4;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using tests::Gltf;
using tests::Json;

/// The square with normals, coordinates and a normal map of one pixel.
Gltf bumpy() {
  Gltf file;
  const std::string text = "P6\n1 1\n255\n\x80\x80\xff";
  file.json["images"].push_back(
      {{"bufferView", file.view(std::vector<std::uint8_t>(text.begin(), text.end()))},
       {"mimeType", "image/x-ppm"}});
  file.json["textures"].push_back({{"source", 0}});
  Json& attributes = file.primitive()["attributes"];
  attributes["NORMAL"] = file.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 5126, "VEC3");
  attributes["TEXCOORD_0"] = file.add<float>({0, 1, 1, 1, 1, 0, 0, 0}, 5126, "VEC2");
  file.primitive()["material"] = 0;
  file.json["materials"] = Json::array({{{"name", "bark"}, {"normalTexture", {{"index", 0}}}}});
  return file;
}

void set_tangents(Gltf& file, const vec4& t) {
  std::vector<float> values;
  for (int i = 0; i < 4; ++i) values.insert(values.end(), {t.x, t.y, t.z, t.w});
  file.primitive()["attributes"]["TANGENT"] = file.add<float>(values, 5126, "VEC4");
}

/// There is none, and this is why.
void expect_no_map(Gltf& file, const std::string& warning) {
  const ImportedModel model = file.import();
  EXPECT_THAT(model.warnings, ElementsAre(warning));
  EXPECT_THAT(model.scene.meshes[0].tangents, IsEmpty());
}

TEST(GltfTangents, AreMadeFromCoordinatesWhereTheFileHasNone) {
  const ImportedModel model = bumpy().import();
  EXPECT_THAT(model.warnings, IsEmpty());
  EXPECT_THAT(model.scene.meshes[0].tangents, Each(vec4(1, 0, 0, 1)));
  EXPECT_GE(model.scene.materials[0].normal_texture, 0);
  EXPECT_EQ(model.scene.materials[0].normal_scale, 1);
}

TEST(GltfTangents, OfTheFileAreMadeUnitsWithASign) {
  Gltf file = bumpy();
  set_tangents(file, {0, 0.5f, 0, -0.25f});
  const ImportedModel model = file.import();
  EXPECT_THAT(model.warnings, IsEmpty());
  EXPECT_THAT(model.scene.meshes[0].tangents, Each(vec4(0, 1, 0, -1)));
}

TEST(GltfTangents, WithoutADirectionAreReplacedAndSaidOnce) {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinite = std::numeric_limits<float>::infinity();
  for (const vec4& broken : {vec4(nan, 0, 0, 1), vec4(0, 0, 0, 1), vec4(1, 0, 0, 0), vec4(1, 0, 0, nan),
                             vec4(infinite, 0, 0, 1)}) {
    Gltf file = bumpy();
    set_tangents(file, broken);
    const ImportedModel model = file.import();
    EXPECT_THAT(
        model.warnings,
        ElementsAre(
            "tangents without a direction are replaced by those of the texture coordinates: 'sheet'"));
    EXPECT_THAT(model.scene.meshes[0].tangents, Each(vec4(1, 0, 0, 1)));
  }
}

TEST(GltfTangents, OfAnotherLengthAreRefused) {
  Gltf file = bumpy();
  file.primitive()["attributes"]["TANGENT"] = file.add<float>({1, 0, 0, 1}, 5126, "VEC4");
  EXPECT_THAT(file.refusal(),
              HasSubstr("TANGENT of mesh 'sheet' has 1 elements, rule: as many as POSITION, 4"));
}

TEST(GltfTangents, NoCoordinatesNoMapAndItIsSaid) {
  Gltf file = bumpy();
  file.primitive()["attributes"].erase("TEXCOORD_0");
  set_tangents(file, {1, 0, 0, 1});
  expect_no_map(file, "normal maps without texture coordinates are not drawn: 'sheet'");
}

TEST(GltfTangents, CoordinatesWithoutAreaNoMapAndItIsSaid) {
  Gltf file = bumpy();
  file.primitive()["attributes"]["TEXCOORD_0"] = file.add<float>({0, 0, 1, 1, 2, 2, 3, 3}, 5126, "VEC2");
  expect_no_map(file, "normal maps are not drawn where texture coordinates have no area: 'sheet'");
}

TEST(GltfTangents, ShapesThatMorphWithoutNormalsHaveNoMapAndItIsSaid) {
  Gltf file = bumpy();
  file.primitive()["attributes"].erase("NORMAL");
  file.primitive()["targets"] =
      Json::array({{{"POSITION", file.add<float>({0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 5126, "VEC3")}}});
  const int times = file.add<float>({0, 1}, 5126, "SCALAR"),
            weights = file.add<float>({0, 1}, 5126, "SCALAR");
  file.json["animations"] = Json::array(
      {{{"samplers", Json::array({{{"input", times}, {"output", weights}}})},
        {"channels", Json::array({{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}})}}});
  expect_no_map(file, "normal maps of shapes that morph and have no normals are not drawn: 'sheet'");
}

TEST(GltfTangents, WithoutNormalsEachTriangleHasItsOwn) {
  Gltf file = bumpy();
  file.primitive()["attributes"].erase("NORMAL");
  const ImportedModel model = file.import();
  EXPECT_EQ(model.scene.meshes[0].positions.size(), 6u);
  EXPECT_THAT(model.scene.meshes[0].normals, Each(layers::vec3(0, 0, 1)));
  EXPECT_THAT(model.scene.meshes[0].tangents, Each(vec4(1, 0, 0, 1)));
}

TEST(GltfTangents, AMapThatNobodySeesIsNotRead) {
  for (const bool unlit : {true, false}) {
    Gltf file = bumpy();
    if (unlit)
      file.json["materials"][0]["extensions"]["KHR_materials_unlit"] = Json::object();
    else
      file.json["materials"][0]["normalTexture"]["scale"] = 0;
    const ImportedModel model = file.import();
    EXPECT_EQ(model.scene.materials[0].normal_texture, -1);
    EXPECT_THAT(model.scene.meshes[0].tangents, IsEmpty());
    EXPECT_THAT(model.scene.textures, IsEmpty());
    EXPECT_THAT(model.warnings, IsEmpty());
  }
}

TEST(GltfTangents, TheEffectIsCalledForByItsMaterial) {
  Gltf file = bumpy();
  ImportedModel model = file.import();
  model.scene.lights.emplace_back();  // a sun
  const layers::LayerSet set = layers::factor(model.scene, layers::default_layer_specs(model.scene));
  layers::RunEffects coarse;
  coarse.per_pixel = false;
  const auto call = [&](const layers::RunEffects& run) {
    const auto effects = layers::effects_called_for(model.scene, set.layers, run);
    return effects[static_cast<std::size_t>(layers::Effect::NormalMap)];
  };
  EXPECT_EQ(call({}).effect, layers::Effect::NormalMap);
  EXPECT_TRUE(call({}).called);
  EXPECT_EQ(call({}).why, "material 'bark' has normal texture 'image 0'");
  EXPECT_FALSE(call(coarse).called);
  EXPECT_EQ(call(coarse).why, "the run does not shade per pixel");
  model.scene.lights[0].kind = layers::Light::Kind::Ambient;
  EXPECT_FALSE(call({}).called);
  EXPECT_EQ(call({}).why, "no lit part has a normal texture and tangents");
}

}  // namespace
}  // namespace talisman::sequences
