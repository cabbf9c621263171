// SPDX-License-Identifier: Apache-2.0
// Metalness and occlusion maps in the colour texture: m = 1 leaves 1 − 1 + 0.45 of the light, occlusion 0 a half.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/sequences/import/gltf_builder.h"

namespace talisman::sequences {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using tests::Gltf;
using tests::Json;

/// sRGB of 0.45 and of 0.5 in linear light, by IEC 61966-2-1.
constexpr int kOf045 = 179, kOf050 = 188;

/// A picture of two pixels.
int add_picture(Gltf& file, std::vector<std::uint8_t> rgb) {
  const std::string text = "P6\n2 1\n255\n";
  std::vector<std::uint8_t> bytes(text.begin(), text.end());
  bytes.insert(bytes.end(), rgb.begin(), rgb.end());
  file.json["images"].push_back({{"bufferView", file.view(bytes)}, {"mimeType", "image/x-ppm"}});
  file.json["textures"].push_back({{"source", file.json["images"].size() - 1}});
  return static_cast<int>(file.json["textures"].size()) - 1;
}

Gltf with_material(const Json& material) {
  Gltf file;
  file.primitive()["attributes"]["TEXCOORD_0"] = file.add<float>({0, 1, 1, 1, 1, 0, 0, 0}, 5126, "VEC2");
  file.primitive()["attributes"]["TEXCOORD_1"] = file.add<float>({0, 0, 1, 0, 1, 1, 0, 1}, 5126, "VEC2");
  file.primitive()["material"] = 0;
  file.json["materials"] = Json::array({material});
  return file;
}

std::vector<int> reds_of(const ImportedModel& model) {
  const layers::Texture& texture = model.scene.textures.at(model.scene.materials.at(0).texture);
  std::vector<int> reds;
  for (std::size_t i = 0; i < texture.rgba.size(); i += 4) reds.push_back(texture.rgba[i]);
  return reds;
}

TEST(GltfTexture, SamplerSaysHowItIsMinified) {
  struct Filter {
    int number;
    bool nearest, finest, one_level;
  };
  for (const Filter& f : std::initializer_list<Filter>{{9728, true, true, false},
                                                       {9729, false, true, false},
                                                       {9984, true, false, true},
                                                       {9985, false, false, true},
                                                       {9986, true, false, false},
                                                       {9987, false, false, false}}) {
    Gltf file = with_material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    add_picture(file, {1, 2, 3, 4, 5, 6});
    file.json["samplers"] = Json::array({{{"minFilter", f.number}}});
    file.json["textures"][0]["sampler"] = 0;
    const layers::Texture texture = file.import().scene.textures.at(0);
    EXPECT_EQ(texture.nearest_minified, f.nearest) << f.number;
    EXPECT_EQ(texture.finest, f.finest) << f.number;
    EXPECT_EQ(texture.one_level, f.one_level) << f.number;
    EXPECT_FALSE(texture.nearest) << f.number;  // it says nothing of what is magnified
  }
}

TEST(GltfMaps, MetalnessIsInTheColourTexelByTexel) {
  Gltf file = with_material({{"name", "half metal"}});
  const int white = add_picture(file, {255, 255, 255, 255, 255, 255});
  const int metal = add_picture(file, {0, 255, 0, 0, 255, 255});  // roughness 1; metalness 0, 1
  file.json["materials"][0]["pbrMetallicRoughness"] = {{"baseColorTexture", {{"index", white}}},
                                                       {"metallicRoughnessTexture", {{"index", metal}}}};
  const ImportedModel model = file.import();
  EXPECT_THAT(model.warnings, IsEmpty());
  EXPECT_THAT(reds_of(model), ElementsAre(255, kOf045));
  EXPECT_EQ(model.scene.materials[0].base_color, layers::vec3(1));
}

TEST(GltfMaps, WithoutAColourTextureTheMapIsOne) {
  Gltf file = with_material({{"name", "half metal"}});
  const int metal = add_picture(file, {0, 255, 255, 0, 255, 0});
  file.json["materials"][0]["pbrMetallicRoughness"] = {{"baseColorFactor", {0.5, 0.5, 0.5, 1}},
                                                       {"metallicRoughnessTexture", {{"index", metal}}}};
  const ImportedModel model = file.import();
  EXPECT_THAT(reds_of(model), ElementsAre(kOf045, 255));
  EXPECT_EQ(model.scene.materials[0].base_color, layers::vec3(0.5f));
}

TEST(GltfMaps, OcclusionTakesHalfOfTheLight) {
  Gltf file = with_material({{"pbrMetallicRoughness", {{"metallicFactor", 0}}}});
  const int hollow = add_picture(file, {0, 0, 0, 255, 255, 255});
  file.json["materials"][0]["occlusionTexture"] = {{"index", hollow}};
  EXPECT_THAT(reds_of(file.import()), ElementsAre(kOf050, 255));
  file.json["materials"][0]["occlusionTexture"]["strength"] = 0;
  EXPECT_EQ(file.import().scene.materials[0].texture, -1);  // it changes nothing
}

TEST(GltfMaps, CoordinatesOfTheirOwnAreSaid) {
  Gltf file = with_material({{"name", "wall"}, {"pbrMetallicRoughness", {{"metallicFactor", 0}}}});
  const int white = add_picture(file, {255, 255, 255, 255, 255, 255});
  const int hollow = add_picture(file, {0, 0, 0, 255, 255, 255});
  file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", white}};
  file.json["materials"][0]["occlusionTexture"] = {{"index", hollow}, {"texCoord", 1}};
  const ImportedModel model = file.import();
  EXPECT_THAT(model.warnings,
              ElementsAre("occlusion maps with coordinates of their own are not drawn: 'wall'"));
  EXPECT_THAT(reds_of(model), ElementsAre(255, 255));
}

TEST(GltfMaps, UnevenRoughnessIsSaidAndEvenIsNot) {
  Gltf file = with_material({{"name", "floor"}});
  const int uneven = add_picture(file, {0, 0, 0, 0, 255, 0});
  file.json["materials"][0]["pbrMetallicRoughness"] = {{"metallicFactor", 0},
                                                       {"metallicRoughnessTexture", {{"index", uneven}}}};
  EXPECT_THAT(file.import().warnings, ElementsAre("roughness maps are drawn as their mean: 'floor'"));
}

TEST(GltfMaps, OfAnUnlitMaterialChangeNothing) {
  Gltf file = with_material({{"extensions", {{"KHR_materials_unlit", Json::object()}}}});
  const int white = add_picture(file, {255, 255, 255, 255, 255, 255});
  const int metal = add_picture(file, {0, 255, 255, 0, 0, 255});
  file.json["materials"][0]["pbrMetallicRoughness"] = {{"baseColorTexture", {{"index", white}}},
                                                       {"metallicRoughnessTexture", {{"index", metal}}}};
  const ImportedModel model = file.import();
  EXPECT_THAT(reds_of(model), ElementsAre(255, 255));
  EXPECT_THAT(model.warnings, IsEmpty());
}

TEST(GltfMaps, TheSameMapsAreBakedOnce) {
  Gltf file = with_material({{"name", "one"}});
  const int metal = add_picture(file, {0, 255, 0, 0, 255, 255});
  file.json["materials"][0]["pbrMetallicRoughness"] = {{"metallicRoughnessTexture", {{"index", metal}}}};
  file.json["materials"].push_back(file.json["materials"][0]);
  const ImportedModel model = file.import();
  EXPECT_EQ(model.scene.textures.size(), 1u);
  EXPECT_EQ(model.scene.materials[0].texture, model.scene.materials[1].texture);
}

}  // namespace
}  // namespace talisman::sequences
