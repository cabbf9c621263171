// SPDX-License-Identifier: Apache-2.0
// Material libraries by the specification of Wavefront (1995), colours worked out by hand.
#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "sequences/import/model_import.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using layers::vec3;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using tests::TemporaryFolder;

constexpr const char* kTriangle =
    "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\n";

/// A triangle in material 'a' that says `statements`.
ImportedModel obj_with_material(const std::string& statements) {
  const TemporaryFolder folder;
  folder.write("m.mtl", "newmtl a\n" + statements);
  folder.write("t.ppm", "P6\n1 1\n255\nabc");
  return import_model(folder.write("thing.obj", kTriangle));
}

layers::Material look_of(const ImportedModel& model) {
  return model.scene.materials.at(static_cast<std::size_t>(model.scene.parts.at(0).material));
}

void expect_color(const vec3& color, const vec3& expected) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(color[k], expected[k], 2e-4) << k;
}

TEST(ObjMaterial, OneNumberIsGrey) {
  const ImportedModel model = obj_with_material("Kd 0.5\nKs 1\nNs 20\n");
  expect_color(look_of(model).base_color, vec3(0.21404f));  // 0.5 in sRGB
  expect_color(look_of(model).specular, vec3(1));
  EXPECT_THAT(model.warnings, IsEmpty());
}

TEST(ObjMaterial, ColourOfCieXyz) {
  // The red of sRGB is (0.4124, 0.2126, 0.0193).
  expect_color(look_of(obj_with_material("Kd xyz 0.4124564 0.2126729 0.0193339\n")).base_color,
               vec3(1, 0, 0));
}

TEST(ObjMaterial, OddLineIsNamedAndTheRestHolds) {
  const ImportedModel model = obj_with_material("Ns 30\nKd spectral paint.rfl\nKs 1 1 1\n");
  EXPECT_THAT(model.warnings,
              ElementsAre(HasSubstr("m.mtl, line 3: 'Kd spectral paint.rfl' of material 'a'")));
  expect_color(look_of(model).base_color, vec3(0.31855f));  // the default, 0.6 in sRGB
  EXPECT_NEAR(look_of(model).shininess, 30, 1e-6);
  for (const char* odd :
       {"Kd 1 x 0\n", "Kd 1 0\n", "Kd\n", "Kd nan 0 0\n", "d half\n", "Kq 1 1 1\n", "illum\n"})
    EXPECT_THAT(obj_with_material(odd).warnings, ElementsAre(HasSubstr("m.mtl, line 2: '"))) << odd;
}

TEST(ObjMaterial, DissolveCountsBeforeItsOpposite) {
  EXPECT_NEAR(look_of(obj_with_material("d 0.25\n")).opacity, 0.25, 1e-6);
  EXPECT_NEAR(look_of(obj_with_material("Tr 0.25\n")).opacity, 0.75, 1e-6);
  EXPECT_NEAR(look_of(obj_with_material("d 1\nTr 1\n")).opacity, 1, 1e-6);
}

TEST(ObjMaterial, IlluminationSaysWhatIsLit) {
  EXPECT_TRUE(look_of(obj_with_material("Kd 1 0 0\nillum 0\n")).unlit);
  const layers::Material dull = look_of(obj_with_material("Ks 1 1 1\nNs 50\nillum 1\n"));
  EXPECT_FALSE(dull.unlit);
  expect_color(dull.specular, vec3(0));
  expect_color(look_of(obj_with_material("Ks 1 1 1\nNs 50\nillum 2\n")).specular, vec3(1));
  EXPECT_THAT(obj_with_material("illum 4\n").warnings, ElementsAre(HasSubstr("reflections and refraction")));
}

/// Where the corners of the triangle look their picture up, v downwards.
std::vector<layers::vec2> coordinates_with(const std::string& map) {
  const ImportedModel model = obj_with_material("map_Kd " + map + "\n");
  EXPECT_THAT(model.warnings, IsEmpty()) << map;
  EXPECT_EQ(model.scene.textures.size(), 1u) << map;
  return model.scene.meshes.at(0).uvs;
}

TEST(ObjMaterial, PictureIsScaledAndThenMoved) {
  using layers::vec2;
  // (0, 0), (1, 0), (0, 1) become (0.25, 0.5), (2.25, 0.5), (0.25, 3.5); then v is turned over.
  for (const char* map :
       {"-s 2 3 1 -o 0.25 0.5 0 t.ppm", "-o 0.25 0.5 -s 2 3 t.ppm", "t.ppm -s 2 3 1 -o 0.25 0.5 0",
        "-blendu on -s 2 3 1 -texres 512 -o 0.25 0.5 0 -boost 2 t.ppm"})
    EXPECT_THAT(coordinates_with(map), ElementsAre(vec2(0.25, 0.5), vec2(2.25, 0.5), vec2(0.25, -2.5)))
        << map;
  // One number is of u alone; the others keep 1 and 0.
  EXPECT_THAT(coordinates_with("-s 2 t.ppm"), ElementsAre(vec2(0, 1), vec2(2, 1), vec2(0, 0)));
}

TEST(ObjMaterial, ClampedPictureEndsAtItsEdge) {
  const ImportedModel model = obj_with_material("map_Kd -clamp on t.ppm\n");
  EXPECT_EQ(model.scene.textures.at(0).wrap_u, layers::Wrap::Clamp);
  EXPECT_EQ(model.scene.textures.at(0).wrap_v, layers::Wrap::Clamp);
  EXPECT_THAT(model.warnings, IsEmpty());
  EXPECT_THAT(obj_with_material("map_Kd -clamp on -s 2 2 t.ppm\n").warnings,
              ElementsAre(HasSubstr("-clamp")));
  EXPECT_EQ(obj_with_material("map_Kd -clamp off t.ppm\n").scene.textures.at(0).wrap_u, layers::Wrap::Repeat);
}

TEST(ObjMaterial, OptionsThatChangeThePictureAreNamed) {
  EXPECT_THAT(obj_with_material("map_Kd -mm 0.2 1 t.ppm\n").warnings,
              ElementsAre(HasSubstr("-mm of map_Kd")));
  EXPECT_THAT(obj_with_material("map_Kd -mm 0 1 t.ppm\n").warnings, IsEmpty());  // it changes nothing
  EXPECT_THAT(obj_with_material("map_Kd -t 0.1 0.1 t.ppm\n").warnings,
              ElementsAre(HasSubstr("-t of map_Kd")));
  EXPECT_THAT(obj_with_material("map_Kd -s t.ppm\n").warnings,
              ElementsAre(HasSubstr("-s without its value")));
}

TEST(ObjMaterial, EveryOtherMapIsNamedOnce) {
  for (const char* map : {"map_Ks", "map_Ns", "map_d", "map_Bump -bm 0.5", "bump", "disp", "decal", "map_Ke",
                          "refl -type sphere", "norm", "map_Pr", "map_Ka"}) {
    const std::string line = std::string(map) + " t.ppm\n";
    EXPECT_THAT(obj_with_material(line + line).warnings, ElementsAre(HasSubstr("not drawn"))) << map;
  }
  EXPECT_THAT(obj_with_material("map_Kd t.ppm\nmap_Ka t.ppm\n").warnings, IsEmpty());
}

TEST(ObjMaterial, NamesThatBeginAlikeAreTwo) {
  const TemporaryFolder folder;
  folder.write("m.mtl", "newmtl dark red\nKd 1 0 0\nnewmtl dark blue\nKd 0 0 1\n");
  const ImportedModel model = import_model(folder.write(
      "thing.obj",
      "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl dark red\nf 1 2 3\nusemtl dark blue\nf 1 2 3\n"));
  ASSERT_EQ(model.scene.parts.size(), 2u);
  expect_color(model.scene.materials.at(model.scene.parts[0].material).base_color, vec3(1, 0, 0));
  expect_color(model.scene.materials.at(model.scene.parts[1].material).base_color, vec3(0, 0, 1));
}

vec3 wound_normal(const layers::Mesh& mesh) {
  const auto p = [&](std::size_t k) { return mesh.positions.at(mesh.indices.at(k)); };
  return glm::normalize(glm::cross(p(1) - p(0), p(2) - p(0)));
}

TEST(ReadObj, FacesTurnToTheSideOfTheirNormals) {
  const TemporaryFolder folder;
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 -1\n";
  const layers::Scene scene = import_model(folder.write("thing.obj", corners + "f 1//1 2//1 3//1\n")).scene;
  EXPECT_EQ(wound_normal(scene.meshes.at(0)), vec3(0, 0, -1));
  EXPECT_EQ(scene.meshes[0].normals.at(0), vec3(0, 0, -1));
  EXPECT_TRUE(scene.materials.at(scene.parts.at(0).material).two_sided);
}

TEST(ReadObj, CornersWithoutANormalGetTheirTriangles) {
  // The first triangle has normals of its own, the second none, the third one without a length; all lie in z = 0.
  const TemporaryFolder folder;
  const layers::Mesh mesh =
      import_model(folder.write("thing.obj",
                                "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\nv 5 1 0\nvn 0 0 1\nvn 0 0 0\n"
                                "f 1//1 2//1 3//1\nf 4 5 6\nf 4//2 5//2 6//2\n"))
          .scene.meshes.at(0);
  for (const vec3& normal : mesh.normals) EXPECT_EQ(normal, vec3(0, 0, 1));
}

TEST(ReadObj, CoordinatesThatAreNotThereAreSaid) {
  const TemporaryFolder folder;
  EXPECT_THAT(
      import_model(folder.write("thing.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/2 3/1\n")).warnings,
      ElementsAre(HasSubstr("texture coordinates that the file has not")));
  EXPECT_THAT(
      import_model(folder.write("bent.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//7\n"))
          .warnings,
      ElementsAre(HasSubstr("normals that the file has not")));
}

TEST(ReadObj, RefusalsNameTheLine) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& text) {
    return tests::message_of([&] { import_model(folder.write("thing.obj", text)); });
  };
  const std::string corners = "# three corners\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_THAT(refusal(corners + "f 1 2 4\n"),
              HasSubstr("line 5: 'f 1 2 4' names vertex 4, rule: from 1 to 3"));
  EXPECT_THAT(refusal(corners + "f 1 2 -4\n"), HasSubstr("line 5: 'f 1 2 -4' names vertex -4"));
  EXPECT_THAT(refusal(corners + "f 1/1 0/1 3/1\n"), HasSubstr("line 5: "));
  EXPECT_THAT(refusal(corners + "v nan 0 0\nf 1 2 3\n"), HasSubstr("line 5: a mesh has 'v nan 0 0'"));
}

}  // namespace
}  // namespace talisman::sequences
