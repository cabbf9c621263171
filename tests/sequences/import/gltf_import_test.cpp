// SPDX-License-Identifier: Apache-2.0
// What glTF 2.0 says, on files of a few triangles whose right values are worked out by hand.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/sequences/import/gltf_builder.h"

namespace talisman::sequences {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using tests::Gltf;
using tests::Json;
using tests::TemporaryFolder;

layers::Mesh only_mesh(const ImportedModel& model) {
  return model.scene.meshes.at(model.scene.parts.at(0).mesh);
}

layers::dvec3 corner_at(const ImportedModel& model, double t_s, std::size_t vertex = 0) {
  return layers::world_positions(model.scene.at(t_s), model.scene.parts.at(0)).at(vertex);
}

/// 2 × 1 pixels, red and green, as binary PPM.
std::vector<std::uint8_t> two_pixels() {
  const std::string text = "P6\n2 1\n255\n";
  std::vector<std::uint8_t> bytes(text.begin(), text.end());
  bytes.insert(bytes.end(), {255, 0, 0, 0, 255, 0});
  return bytes;
}

/// The square with texture coordinates, and a material whose base map is the texture 0 over an embedded image.
Gltf textured() {
  Gltf file;
  file.primitive()["attributes"]["TEXCOORD_0"] = file.add<float>({0, 1, 1, 1, 1, 0, 0, 0}, 5126, "VEC2");
  file.primitive()["material"] = 0;
  file.json["images"] = Json::array({{{"bufferView", file.view(two_pixels())}, {"mimeType", "image/x-ppm"}}});
  file.json["textures"] = Json::array({{{"source", 0}}});
  file.json["materials"] =
      Json::array({{{"name", "paint"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}});
  return file;
}

// --- Accessors

TEST(GltfAccessor, NormalizedIntegersAreSharesOfTheLargest) {
  Gltf file = textured();
  file.primitive()["attributes"]["TEXCOORD_0"] =
      file.add<std::uint8_t>({0, 255, 51, 102, 255, 0, 0, 0}, 5121, "VEC2", true);
  // Elements of 2 bytes need a stride of 4, which the file does not claim: 2 apart, as written.
  const layers::Mesh mesh = only_mesh(file.import());
  EXPECT_FLOAT_EQ(mesh.uvs[1].x, 0.2f);  // 51 / 255
  EXPECT_FLOAT_EQ(mesh.uvs[1].y, 0.4f);
}

TEST(GltfAccessor, SignedIntegersEndAtMinusOne) {
  Gltf file;
  file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  file.primitive()["attributes"]["POSITION"] =
      file.add<std::int8_t>({-128, -127, 0, 127, -127, 0, 127, 127, 0, 64, 0, 0}, 5120, "VEC3", true);
  const layers::Mesh mesh = only_mesh(file.import());
  EXPECT_EQ(mesh.positions[0].x, -1);  // max(-128 / 127, -1)
  EXPECT_EQ(mesh.positions[0].y, -1);
  EXPECT_FLOAT_EQ(mesh.positions[3].x, 64 / 127.0f);
}

TEST(GltfAccessor, StrideLeavesOutWhatLiesBetween) {
  Gltf file;
  file.add<float>({-1, -1, 0, 9, 1, -1, 0, 9, 1, 1, 0, 9, -1, 1, 0, 9}, 5126, "VEC3");
  const int view = static_cast<int>(file.json["bufferViews"].size()) - 1;
  file.json["bufferViews"][view]["byteStride"] = 16;
  file.json["accessors"].back()["count"] = 4;
  file.primitive()["attributes"]["POSITION"] = file.json["accessors"].size() - 1;
  EXPECT_EQ(only_mesh(file.import()).positions[3], layers::vec3(-1, 1, 0));
}

TEST(GltfAccessor, SparseWithoutAViewReplacesZeros) {
  Gltf file;
  const int indices = file.view<std::uint8_t>({1, 2}), values = file.view<float>({2, 0, 0, 2, 2, 0});
  file.json["accessors"].push_back({{"componentType", 5126},
                                    {"count", 4},
                                    {"type", "VEC3"},
                                    {"sparse",
                                     {{"count", 2},
                                      {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                      {"values", {{"bufferView", values}}}}}});
  file.primitive()["attributes"]["POSITION"] = file.json["accessors"].size() - 1;
  const layers::Mesh mesh = only_mesh(file.import());
  EXPECT_THAT(mesh.positions,
              ElementsAre(layers::vec3(0), layers::vec3(2, 0, 0), layers::vec3(2, 2, 0), layers::vec3(0)));
}

TEST(GltfAccessor, SparseIndicesMustIncrease) {
  Gltf file;
  const int indices = file.view<std::uint8_t>({2, 1}), values = file.view<float>({2, 0, 0, 2, 2, 0});
  file.json["accessors"][0]["sparse"] = {{"count", 2},
                                         {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                         {"values", {{"bufferView", values}}}};
  EXPECT_THAT(file.refusal(), HasSubstr("sparse index 1, rule: above the one before it and below 4"));
}

TEST(GltfAccessor, ElementsBeyondTheViewAreRefused) {
  Gltf file;
  file.json["accessors"][0]["count"] = 5;
  EXPECT_THAT(file.refusal(), HasSubstr("an accessor of 5 elements of 12 bytes"));
}

TEST(GltfAccessor, IndexBeyondTheVerticesIsRefused) {
  Gltf file;
  file.primitive()["indices"] = file.add<std::uint8_t>({0, 1, 4}, 5121, "SCALAR");
  EXPECT_THAT(file.refusal(), HasSubstr("index 4, rule: below 4 vertices"));
}

// --- Primitives

TEST(GltfPrimitive, StripTurnsEverySecondTriangle) {
  Gltf file;
  file.primitive()["mode"] = 5;
  file.primitive()["indices"] = file.add<std::uint8_t>({0, 1, 3, 2}, 5121, "SCALAR");
  EXPECT_THAT(only_mesh(file.import()).indices, ElementsAre(0, 1, 3, 1, 2, 3));
}

TEST(GltfPrimitive, FanSharesItsFirstVertex) {
  Gltf file;
  file.primitive()["mode"] = 6;
  file.primitive().erase("indices");
  EXPECT_THAT(only_mesh(file.import()).indices, ElementsAre(1, 2, 0, 2, 3, 0));
}

TEST(GltfPrimitive, LinesBesideTrianglesAreNamed) {
  Gltf file;
  Json lines = file.primitive();
  lines["mode"] = 1;
  file.json["meshes"][0]["primitives"].push_back(lines);
  const ImportedModel model = file.import();
  EXPECT_EQ(model.scene.parts.size(), 1u);
  EXPECT_THAT(model.warnings, ElementsAre("lines are not drawn: 'sheet'"));
}

TEST(GltfPrimitive, FileOfPointsAloneIsRefused) {
  Gltf file;
  file.primitive()["mode"] = 0;
  EXPECT_THAT(file.refusal(), HasSubstr("has no triangles, only points or lines"));
}

TEST(GltfPrimitive, ColoursOfVerticesKeepTheirAlphaWhereTheMaterialBlends) {
  Gltf file;
  file.primitive()["attributes"]["COLOR_0"] =
      file.add<std::uint8_t>({255, 0, 0, 51, 0, 255, 0, 255, 0, 0, 255, 255, 0, 0, 0, 0}, 5121, "VEC4", true);
  file.primitive()["material"] = 0;
  file.json["materials"] = Json::array({{{"alphaMode", "BLEND"}}});
  const layers::Mesh mesh = only_mesh(file.import());
  EXPECT_THAT(mesh.alphas, ElementsAre(0.2f, 1, 1, 0));
  EXPECT_EQ(mesh.colors[0], layers::vec3(1, 0, 0));
  file.json["materials"][0]["alphaMode"] = "OPAQUE";
  EXPECT_THAT(only_mesh(file.import()).alphas, IsEmpty());
}

// --- Materials and textures

TEST(GltfTexture, OfAGlbIsRead) {
  const TemporaryFolder folder;
  const ImportedModel model = import_model(folder.write("model.glb", textured().glb()));
  EXPECT_THAT(model.warnings, IsEmpty());
  ASSERT_EQ(model.scene.textures.size(), 1u);
  EXPECT_EQ(model.scene.textures[0].rgba, (std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 255}));
}

TEST(GltfTexture, UrisArePercentEncoded) {
  const TemporaryFolder folder;
  const auto picture = two_pixels();
  folder.write("my tex ü.ppm", std::string(picture.begin(), picture.end()));
  Gltf file = textured();
  file.json["images"] = Json::array({{{"uri", "my%20tex%20%C3%BC.ppm"}}});
  const ImportedModel model = import_model(folder.write("model.gltf", file.text()));
  EXPECT_THAT(model.warnings, IsEmpty());
  EXPECT_EQ(model.scene.textures.size(), 1u);
}

TEST(GltfTexture, OutsideTheModelsFolderIsNotOpened) {
  const TemporaryFolder folder;
  const auto picture = two_pixels();
  folder.write("secret.ppm", std::string(picture.begin(), picture.end()));
  Gltf file = textured();
  for (const std::string& uri : {std::string("../secret.ppm"), folder.path() + "/secret.ppm"}) {
    file.json["images"] = Json::array({{{"uri", uri}}});
    const ImportedModel model = import_model(folder.write("models/model.gltf", file.text()));
    ASSERT_EQ(model.warnings.size(), 1u) << uri;
    EXPECT_THAT(model.warnings[0], HasSubstr("is missing"));
    EXPECT_THAT(model.scene.textures, IsEmpty());
  }
}

TEST(GltfTexture, SamplerSaysHowItIsLookedUp) {
  Gltf file = textured();
  file.json["samplers"] =
      Json::array({{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}, {"minFilter", 9729}}});
  file.json["textures"][0]["sampler"] = 0;
  const layers::Texture texture = file.import().scene.textures.at(0);
  EXPECT_EQ(texture.wrap_u, layers::Wrap::Clamp);
  EXPECT_EQ(texture.wrap_v, layers::Wrap::Mirror);
  EXPECT_TRUE(texture.nearest);
  EXPECT_TRUE(texture.finest);
  EXPECT_FALSE(texture.nearest_minified);
}

TEST(GltfTexture, TransformScalesTurnsAndMovesInThisOrder) {
  Gltf file = textured();
  file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]
           ["KHR_texture_transform"] = {
      {"offset", {0, 1}}, {"rotation", std::acos(-1.0) / 2}, {"scale", {0.5, 0.5}}};
  const layers::Mesh mesh = only_mesh(file.import());
  // (u, v) → (0.5 v, -0.5 u + 1): of vertex 1, (1, 1) → (0.5, 0.5); of vertex 2, (1, 0) → (0, 0.5)
  EXPECT_NEAR(mesh.uvs[1].x, 0.5, 1e-6);
  EXPECT_NEAR(mesh.uvs[1].y, 0.5, 1e-6);
  EXPECT_NEAR(mesh.uvs[2].x, 0, 1e-6);
  EXPECT_NEAR(mesh.uvs[2].y, 0.5, 1e-6);
}

TEST(GltfTexture, EmissiveMapMayHaveCoordinatesOfItsOwn) {
  Gltf file = textured();
  file.primitive()["attributes"]["TEXCOORD_1"] = file.add<float>({0.25f, 0, 0, 0, 0, 0, 0, 0}, 5126, "VEC2");
  file.json["materials"][0]["emissiveFactor"] = {1, 0.5, 0};
  file.json["materials"][0]["emissiveTexture"] = {{"index", 0}, {"texCoord", 1}};
  file.json["materials"][0]["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", 4}};
  const ImportedModel model = file.import();
  EXPECT_EQ(only_mesh(model).emissive_uvs.at(0).x, 0.25f);
  EXPECT_EQ(model.scene.materials[0].emissive, layers::vec3(4, 2, 0));
  EXPECT_GE(model.scene.materials[0].emissive_texture, 0);
}

TEST(GltfTexture, EmissiveFactorWithoutItsMapDoesNotGlow) {
  Gltf file = textured();
  file.json["materials"][0]["emissiveFactor"] = {1, 1, 1};
  file.json["materials"][0]["emissiveTexture"] = {{"index", 1}};
  file.json["images"].push_back({{"uri", "nowhere.png"}});
  file.json["textures"].push_back({{"source", 1}});
  const ImportedModel model = file.import();
  EXPECT_EQ(model.scene.materials[0].emissive, layers::vec3(0));
  EXPECT_EQ(model.warnings.size(), 1u);
}

TEST(GltfMaterial, MaskComparesTheProductWithTheCutoff) {
  Gltf file = textured();
  Json& material = file.json["materials"][0];
  material["alphaMode"] = "MASK";
  material["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0.8};
  EXPECT_FLOAT_EQ(file.import().scene.materials[0].alpha_cutoff, 0.625f);  // 0.5 / 0.8
  EXPECT_EQ(file.import().scene.materials[0].opacity, 1);
  material["alphaCutoff"] = 0.9;
  EXPECT_EQ(file.import().scene.materials[0].opacity, 0);  // no texel can reach it
}

TEST(GltfMaterial, UnlitAndDoubleSidedAreKept) {
  Gltf file = textured();
  file.json["materials"][0]["doubleSided"] = true;
  file.json["materials"][0]["extensions"]["KHR_materials_unlit"] = Json::object();
  const layers::Material material = file.import().scene.materials.at(0);
  EXPECT_TRUE(material.unlit);
  EXPECT_TRUE(material.two_sided);
}

TEST(GltfMaterial, WhatIsNotDrawnIsNamedOnce) {
  Gltf file = textured();
  const Json dim = {{"KHR_materials_specular", {{"specularTexture", {{"index", 0}}}}}};
  file.json["materials"][0]["extensions"] = dim;
  file.json["materials"].push_back({{"name", "wood"}, {"extensions", dim}});
  EXPECT_THAT(file.import().warnings, ElementsAre("specular maps are not drawn: 'paint', 'wood'"));
}

// --- Extensions

TEST(GltfExtension, RequiredAndNotReadIsRefusedByName) {
  Gltf file;
  file.json["extensionsRequired"] = {"KHR_materials_unlit", "KHR_texture_basisu"};
  EXPECT_THAT(file.refusal(), HasSubstr("model.gltf: requires \"KHR_texture_basisu\""));
}

TEST(GltfExtension, UsedAndNotReadIsAWarning) {
  Gltf file;
  file.json["extensionsUsed"] = {"KHR_materials_clearcoat"};
  EXPECT_THAT(file.import().warnings, ElementsAre("extension KHR_materials_clearcoat is not drawn"));
}

// --- Nodes

TEST(GltfNode, ShearedMatrixIsKeptWhole) {
  Gltf file;
  file.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 3, 0, 0, 1};  // x' = x + y / 2 + 3
  const ImportedModel model = file.import();
  EXPECT_NEAR(corner_at(model, 0, 2).x, 4.5, 1e-9);  // (1, 1)
  EXPECT_NEAR(corner_at(model, 0, 0).x, 1.5, 1e-9);  // (-1, -1)
  EXPECT_NEAR(corner_at(model, 0, 2).y, 1, 1e-9);
}

TEST(GltfNode, MirroredAndFlatMatricesAreKeptWhole) {
  Gltf file;
  file.json["nodes"][0]["matrix"] = {-2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1};
  const ImportedModel model = file.import();
  EXPECT_NEAR(corner_at(model, 0, 2).x, -2, 1e-9);
  EXPECT_NEAR(corner_at(model, 0, 2).y, 1, 1e-9);
  EXPECT_THAT(model.warnings, IsEmpty());
}

TEST(GltfNode, EqualNamesMakeDifferentParts) {
  Gltf file;
  file.json["nodes"] = Json::array({{{"name", "n"}, {"mesh", 0}}, {{"name", "n"}, {"mesh", 0}}});
  file.json["scenes"][0]["nodes"] = {0, 1};
  const ImportedModel model = file.import();
  ASSERT_EQ(model.scene.parts.size(), 2u);
  EXPECT_EQ(model.scene.parts[0].name, "n");
  EXPECT_EQ(model.scene.parts[1].name, "n#2");
  EXPECT_EQ(model.scene.meshes.size(), 1u) << "shown twice, stored once";
}

TEST(GltfNode, WithoutANameIsCalledAsItsMesh) {
  Gltf file;
  file.json["nodes"][0].erase("name");
  EXPECT_EQ(file.import().scene.parts.at(0).name, "sheet");
}

TEST(GltfNode, InTheTreeTwiceIsRefused) {
  Gltf file;
  file.json["nodes"] = Json::array({{{"children", {1}}}, {{"mesh", 0}, {"children", {0}}}});
  EXPECT_THAT(file.refusal(), HasSubstr("node 0 is in the scene twice"));
}

TEST(GltfNode, OnlyTheChosenSceneIsDrawn) {
  Gltf file;
  file.json["nodes"].push_back({{"name", "other"}, {"mesh", 0}});
  file.json["scenes"] = Json::array({{{"nodes", {0}}}, {{"name", "second"}, {"nodes", {1}}}});
  file.json["scene"] = 1;
  const ImportedModel model = file.import();
  ASSERT_EQ(model.scene.parts.size(), 1u);
  EXPECT_EQ(model.scene.parts[0].name, "other");
  EXPECT_THAT(model.warnings, ElementsAre("2 scenes; only 'second' is drawn"));
}

TEST(GltfCamera, StandsWhereItsNodeStands) {
  Gltf file;
  file.json["nodes"].push_back({{"name", "eye"}, {"camera", 0}, {"translation", {0, 0, 3}}});
  file.json["scenes"][0]["nodes"] = {0, 1};
  file.json["cameras"] =
      Json::array({{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.25}}}}});
  const layers::CameraState camera = file.import().scene.at(0).camera;
  EXPECT_NEAR(camera.world_from_camera[3].z, 3, 1e-12);
  EXPECT_EQ(camera.fov_y_rad, 0.5);
  EXPECT_EQ(camera.near_m, 0.25);
  EXPECT_GT(camera.far_m, 1e5);  // infinite
}

TEST(GltfCamera, OrthographicSeesItsRectangleAtEveryDistance) {
  Gltf file;
  file.json["nodes"].push_back({{"name", "eye"}, {"camera", 0}, {"translation", {0, 0, 5}}});
  file.json["scenes"][0]["nodes"] = {0, 1};
  file.json["cameras"] =
      Json::array({{{"type", "orthographic"},
                    {"orthographic", {{"xmag", 2}, {"ymag", 2}, {"znear", 0.1}, {"zfar", 100}}}}});
  const layers::CameraState camera = file.import().scene.at(0).camera;
  for (const double z : {-0.5, 0.0, 0.5}) {  // half the height at that depth
    const double distance = camera.world_from_camera[3].z - z;
    EXPECT_NEAR(distance * std::tan(camera.fov_y_rad / 2), 2, 0.001) << z;
    EXPECT_GT(distance, camera.near_m);
    EXPECT_LT(distance, camera.far_m);
  }
}

// --- Motion

/// The square's node moved by an animation of `path`.
Gltf animated(const std::string& path, const std::string& interpolation, const std::vector<float>& times,
              const std::vector<float>& values, const std::string& type) {
  Gltf file;
  const int input = file.add<float>(times, 5126, "SCALAR"), output = file.add<float>(values, 5126, type);
  file.json["animations"] = Json::array(
      {{{"samplers", Json::array({{{"input", input}, {"output", output}, {"interpolation", interpolation}}})},
        {"channels", Json::array({{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}})}}});
  return file;
}

TEST(GltfAnimation, StepHoldsUntilTheNextKey) {
  const ImportedModel model =
      animated("translation", "STEP", {0, 1, 2}, {0, 0, 0, 10, 0, 0, 20, 0, 0}, "VEC3").import();
  EXPECT_NEAR(corner_at(model, 0.99).x, -1, 1e-9);
  EXPECT_NEAR(corner_at(model, 1).x, 9, 1e-9);
}

TEST(GltfAnimation, CubicSplineHasTheSlopesOfItsKeys) {
  // From 0 to 1 in 2 s, leaving with 3 per s: at τ = 1/2 that is 1/2 + 2 · (1/8) · 3 = 1.25.
  const ImportedModel model = animated("translation", "CUBICSPLINE", {0, 2},
                                       {0, 0, 0, 0, 0, 0, 3, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0}, "VEC3")
                                  .import();
  EXPECT_NEAR(corner_at(model, 1).x, -1 + 1.25, 1e-6);
}

TEST(GltfAnimation, ChannelsRepeatTogether) {
  // One channel ends after 1 s, the other after 4 s: the first holds its end for 3 s.
  Gltf file = animated("translation", "LINEAR", {0, 1}, {0, 0, 0, 10, 0, 0}, "VEC3");
  const int input = file.add<float>({0, 4}, 5126, "SCALAR"),
            output = file.add<float>({1, 1, 1, 2, 2, 2}, 5126, "VEC3");
  file.json["animations"][0]["samplers"].push_back({{"input", input}, {"output", output}});
  file.json["animations"][0]["channels"].push_back(
      {{"sampler", 1}, {"target", {{"node", 0}, {"path", "scale"}}}});
  const ImportedModel model = file.import();
  EXPECT_NEAR(model.scene.at(3).world_from_node[0][3].x, 10, 1e-9);
  EXPECT_NEAR(model.scene.at(4.5).world_from_node[0][3].x, 5, 1e-9);
  EXPECT_EQ(model.scene.duration_s(), 4);
}

TEST(GltfMorph, DefaultWeightsAreBakedIn) {
  Gltf file;
  file.primitive()["targets"] =
      Json::array({{{"POSITION", file.add<float>({2, 0, 0, 2, 0, 0, 2, 0, 0, 2, 0, 0}, 5126, "VEC3")}}});
  file.json["meshes"][0]["weights"] = {0.5};
  const ImportedModel model = file.import();
  EXPECT_NEAR(corner_at(model, 0).x, 0, 1e-6);
  EXPECT_THAT(only_mesh(model).morphs, IsEmpty());
}

TEST(GltfMorph, AnimatedWeightsMoveVerticesAndNothingElse) {
  Gltf file = animated("weights", "LINEAR", {0, 1}, {0, 1}, "SCALAR");
  file.primitive()["targets"] =
      Json::array({{{"POSITION", file.add<float>({2, 0, 0, 2, 0, 0, 2, 0, 0, 2, 0, 0}, 5126, "VEC3")}}});
  const ImportedModel model = file.import();
  EXPECT_NEAR(corner_at(model, 0.5).x, 0, 1e-6);
  EXPECT_EQ(model.scene.at(0.5).world_from_node, model.scene.at(0).world_from_node);
  EXPECT_FALSE(layers::is_animated(model.scene, model.scene.parts[0].node));
  EXPECT_TRUE(layers::deforms(model.scene, model.scene.parts[0]));
}

TEST(GltfSkin, WithoutInverseBindMatricesHasTheIdentity) {
  Gltf file;
  file.json["nodes"][0]["skin"] = 0;
  file.json["nodes"][0]["translation"] = {100, 0, 0};  // a skinned mesh does not follow its own node
  file.json["nodes"].push_back({{"name", "bone"}, {"translation", {5, 0, 0}}});
  file.json["scenes"][0]["nodes"] = {0, 1};
  file.json["skins"] = Json::array({{{"joints", {1}}}});
  file.primitive()["attributes"]["JOINTS_0"] =
      file.add<std::uint8_t>(std::vector<std::uint8_t>(16, 0), 5121, "VEC4");
  file.primitive()["attributes"]["WEIGHTS_0"] =
      file.add<std::uint8_t>({255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0}, 5121, "VEC4", true);
  EXPECT_NEAR(corner_at(file.import(), 0, 1).x, 6, 1e-9);
}

// --- Lights

/// The square lit by lamps on nodes of their own, each at its place.
Gltf lit(const std::vector<std::pair<Json, std::vector<double>>>& lamps) {
  Gltf file;
  Json lights = Json::array(), roots = {0};
  for (const auto& [lamp, place] : lamps) {
    file.json["nodes"].push_back({{"name", "lamp"},
                                  {"translation", place},
                                  {"extensions", {{"KHR_lights_punctual", {{"light", lights.size()}}}}}});
    roots.push_back(file.json["nodes"].size() - 1);
    lights.push_back(lamp);
  }
  file.json["scenes"][0]["nodes"] = roots;
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = lights;
  return file;
}

double lux(const ImportedModel& model, std::size_t light, double distance) {
  const layers::LightState state = model.scene.at(0).lights.at(light);
  return state.color.x * layers::falloff(state, distance);
}

TEST(GltfLight, BrightestShowsOneAndRatiosStay) {
  const Json lamp = {{"type", "point"}, {"intensity", 10}};
  const ImportedModel model = lit({{lamp, {0, 0, 1}}, {lamp, {0, 0, 10}}}).import();
  EXPECT_NEAR(lux(model, 0, 1), 1, 1e-6);
  EXPECT_NEAR(lux(model, 1, 10), 0.01, 1e-8);  // 1/d²: 100 : 1
  EXPECT_THAT(model.notes, ElementsAre("the largest illuminance, 10 lx, is shown as 1 on white"));
}

TEST(GltfLight, SunIsNotPutOutByALampFarAway) {
  const ImportedModel model = lit({{{{"type", "directional"}, {"intensity", 1}}, {0, 0, 1}},
                                   {{{"type", "point"}, {"intensity", 1000}}, {0, 0, -500}}})
                                  .import();
  EXPECT_NEAR(model.scene.lights[0].color.x, 1, 1e-6);
  EXPECT_NEAR(lux(model, 1, 500), 0.004, 1e-6);
}

TEST(GltfLight, RangeEndsALamp) {
  const ImportedModel model =
      lit({{{{"type", "point"}, {"intensity", 1}, {"range", 2}}, {0, 0, 1}}}).import();
  EXPECT_NEAR(lux(model, 0, 1), 1, 1e-6);  // exposed by it
  EXPECT_EQ(lux(model, 0, 2), 0);
  EXPECT_NEAR(lux(model, 0, 1.5) / lux(model, 0, 1), (1 - 0.31640625) / 2.25 / (1 - 0.0625), 1e-6);
}

}  // namespace
}  // namespace talisman::sequences
