// SPDX-License-Identifier: Apache-2.0
// OBJ by the specification of Wavefront (1995), on files of a few faces.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/import/model_import.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using tests::TemporaryFolder;

ImportedModel read_obj_text(const std::string& text) {
  const TemporaryFolder folder;
  return import_model(folder.write("thing.obj", text));
}

double area_of(const layers::Mesh& mesh) {
  double area = 0;
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const layers::vec3 a = mesh.positions[mesh.indices[t]], b = mesh.positions[mesh.indices[t + 1]],
                       c = mesh.positions[mesh.indices[t + 2]];
    area += 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
  }
  return area;
}

TEST(ReadObj, PolygonsKeepTheirArea) {
  // An L of six corners, which a fan from its first corner would not fill: 4 - 1 = 3.
  const ImportedModel model =
      read_obj_text("v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4 5 6\n");
  EXPECT_EQ(model.scene.meshes.at(0).triangle_count(), 4);
  EXPECT_NEAR(area_of(model.scene.meshes[0]), 3, 1e-6);
}

TEST(ReadObj, NegativeIndicesCountFromTheLast) {
  const ImportedModel model = read_obj_text("v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n");
  EXPECT_THAT(model.scene.meshes.at(0).positions,
              ElementsAre(layers::vec3(0), layers::vec3(1, 0, 0), layers::vec3(0, 1, 0)));
}

TEST(ReadObj, CornersOfOnePlaceWithOtherCoordinatesAreOtherVertices) {
  const ImportedModel model = read_obj_text(
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\nf 1/2 3/3 4/1\n");
  const layers::Mesh& mesh = model.scene.meshes.at(0);
  EXPECT_EQ(mesh.positions.size(), 5u);        // the first corner twice, the third shared
  EXPECT_EQ(mesh.uvs[0], layers::vec2(0, 1));  // v grows downwards
}

TEST(ReadObj, SmoothingGroupsEndAtTheirBorders) {
  // Two faces at a right angle along one edge, in one group, in two, and in none.
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\n";
  const auto normal = [&](const std::string& first, const std::string& second) {
    return read_obj_text(corners + first + "f 1 2 3 4\n" + second + "f 2 1 5 6\n")
        .scene.meshes.at(0)
        .normals.at(0);
  };
  EXPECT_NEAR(normal("s 1\n", "s 2\n").z, 1, 1e-6);
  EXPECT_NEAR(normal("s 1\n", "s 1\n").z, normal("", "").z, 1e-6);  // without any: all are one
  EXPECT_LT(normal("s 1\n", "s 1\n").z, 0.95);
  EXPECT_NEAR(normal("s off\n", "s 1\n").z, 1, 1e-6);
}

/// Sum of the triangles' areas in the plane of x and y.
double flat_area(const layers::Scene& scene) {
  double sum = 0;
  for (const layers::Mesh& mesh : scene.meshes)
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      const layers::vec3 a = mesh.positions[mesh.indices[i]], b = mesh.positions[mesh.indices[i + 1]],
                         c = mesh.positions[mesh.indices[i + 2]];
      sum += 0.5 * std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
    }
  return sum;
}

TEST(ReadObj, PolygonsOfManyCornersStayWhole) {
  // A comb of 200 teeth, 403 corners: each tooth has an area of 1/2 above a bar of 200 x 1. Between two triangles.
  std::string text = "v 0 0 0\nv 200 0 0\n", face = "f 1 2";
  for (int k = 200; k > 0; --k) {
    text += "v " + std::to_string(k) + " 1 0\nv " + std::to_string(k - 0.5) + " 2 0\n";
    face += " " + std::to_string(2 * (200 - k) + 3) + " " + std::to_string(2 * (200 - k) + 4);
  }
  text += "v 0 1 0\n", face += " 403\n";
  EXPECT_NEAR(flat_area(read_obj_text(text + "f 1 2 3\n" + face + "f 1 2 403\n").scene), 100 + 300 + 100,
              1e-3);
  EXPECT_NEAR(flat_area(read_obj_text(text + face).scene), 300, 1e-3);
}

TEST(ReadObj, PolygonAroundAHoleAndConcaveQuadrilateral) {
  const std::string square = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 1 0\nv 1 3 0\nv 3 3 0\nv 3 1 0\n";
  EXPECT_NEAR(flat_area(read_obj_text(square + "f 1 2 3 4 1 5 6 7 8 5\n").scene), 12, 1e-4);
  EXPECT_NEAR(flat_area(read_obj_text("v 0 0 0\nv 4 -1 0\nv 3.5 0 0\nv 4 1 0\nf 1 2 3 4\n").scene), 3.5,
              1e-4);
}

TEST(ReadObj, FlatWhereItSaysThatNothingIsSmooth) {
  // Two faces at a right angle, as in SmoothingGroupsEndAtTheirBorders.
  const std::string faces = "f 1 2 3 4\nf 2 1 5 6\n",
                    corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\n";
  for (const char* off : {"s off\n", "s 0\n"})
    EXPECT_NEAR(read_obj_text(corners + off + faces).scene.meshes.at(0).normals.at(0).z, 1, 1e-6) << off;
  EXPECT_LT(read_obj_text(corners + faces).scene.meshes.at(0).normals.at(0).z, 0.95);  // says nothing
}

TEST(ReadObj, MarksCommentsAndContinuedLines) {
  const std::string plain = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const std::vector<layers::vec3> expected = read_obj_text(plain).scene.meshes.at(0).positions;
  for (const std::string& text :
       {"\xEF\xBB\xBF" + plain, std::string("v 0 0 0 # info\nv 1 0 0 # nan\nv 0 1 0\nf 1 2 3 # c\n"),
        std::string("v 0 0 0\r\nv 1 \\\r\n0 0\r\nv 0 1 0\r\nf 1 \\\r\n2 3\r\n"),
        std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nfo 1 2 3\n"),
        std::string("v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r")})
    EXPECT_EQ(read_obj_text(text).scene.meshes.at(0).positions, expected) << text;
}

TEST(ReadObj, MaterialBeforeItsLibraryIsFound) {
  const TemporaryFolder folder;
  folder.write("m.mtl", "\xEF\xBB\xBFnewmtl red\nKd 1 0 0\n");
  const ImportedModel model = import_model(
      folder.write("late.obj", "usemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nmtllib m.mtl\n"));
  EXPECT_EQ(model.scene.materials.at(model.scene.parts.at(0).material).base_color, layers::vec3(1, 0, 0));
  EXPECT_THAT(model.warnings, ElementsAre());  // the mark before "newmtl" is none of its letters
}

TEST(ReadObj, CurvesAreSaid) {
  EXPECT_THAT(read_obj_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nvp 0.1 0.2\ncurv 0 1 1 2 3\n").warnings,
              ElementsAre("curves and surfaces are not drawn"));
}

TEST(ReadObj, PartsAreObjectsAndTheirMaterials) {
  const TemporaryFolder folder;
  folder.write("my colours.mtl", "newmtl dark red\nKd 0.5 0 0\nnewmtl blue\nKd 0 0 1\n");
  const ImportedModel model = import_model(folder.write(
      "thing.obj",
      "mtllib my colours.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\no one\nusemtl dark red\nf 1 2 3\nusemtl blue\n"
      "f 3 2 1\no two\nusemtl blue\nf 1 2 3\n"));
  ASSERT_EQ(model.scene.parts.size(), 3u);
  EXPECT_EQ(model.scene.parts[0].name, "thing.obj/one#0");
  EXPECT_EQ(model.scene.parts[1].name, "thing.obj/one#1");
  EXPECT_EQ(model.scene.parts[2].name, "thing.obj/two");
  const auto color = [&](std::size_t part) {
    return model.scene.materials.at(model.scene.parts[part].material).base_color;
  };
  EXPECT_NEAR(color(0).x, 0.21404, 1e-4);
  EXPECT_EQ(color(1), layers::vec3(0, 0, 1));
  EXPECT_EQ(color(2), layers::vec3(0, 0, 1));
}

TEST(ReadObj, CornerThatIsNotThereIsRefused) {
  const auto refusal = [](const std::string& face) {
    return tests::message_of([&] { read_obj_text("v 0 0 0\nv 1 0 0\nv 0 1 0\n" + face); });
  };
  EXPECT_THAT(refusal("f 1 2 4\n"), HasSubstr("thing.obj: "));
  EXPECT_THAT(refusal("f 1 2 -4\n"), HasSubstr("thing.obj: "));
}

std::string utf16(const std::string& ascii, bool big) {
  std::string bytes = big ? "\xFE\xFF" : "\xFF\xFE";
  for (const char c : ascii) bytes += big ? std::string{'\0', c} : std::string{c, '\0'};
  return bytes;
}

TEST(ReadObj, TextIn16BitsIsRead) {
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  for (const bool big : {false, true})
    EXPECT_EQ(read_obj_text(utf16(text, big)).scene.meshes.at(0).positions.at(1), layers::vec3(1, 0, 0))
        << big;
}

TEST(ReadObj, LinesBesideFacesAreSaid) {
  EXPECT_THAT(read_obj_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 1 2\n").warnings,
              ElementsAre("lines are not drawn"));
}

constexpr const char* kFace = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST(ReadObj, LibraryWithSpacesInItsNameIsOneLibrary) {
  const TemporaryFolder folder;
  folder.write("my look.mtl", "newmtl red\nKd 1 0 0\n");
  const ImportedModel model = import_model(
      folder.write("thing.obj", "mtllib my look.mtl\n" + std::string(kFace) + "usemtl red\nf 1 2 3\n"));
  EXPECT_THAT(model.warnings, ElementsAre());
  EXPECT_EQ(model.scene.materials.at(model.scene.parts.at(0).material).base_color, layers::vec3(1, 0, 0));
}

TEST(ReadObj, SeveralLibrariesInOneLineAreAllRead) {
  const TemporaryFolder folder;
  folder.write("a.mtl", "newmtl red\nKd 1 0 0\n");
  folder.write("b.mtl", "newmtl blue\nKd 0 0 1\n");
  const ImportedModel model = import_model(folder.write(
      "thing.obj", "mtllib a.mtl b.mtl gone.mtl\n" + std::string(kFace) + "usemtl blue\nf 1 2 3\n"));
  EXPECT_THAT(model.warnings, ElementsAre("material library 'gone.mtl' is missing"));
  EXPECT_EQ(model.scene.materials.at(model.scene.parts.at(0).material).base_color, layers::vec3(0, 0, 1));
}

TEST(ReadObj, LibraryOfTheModelsNameStandsInAndIsNamed) {
  const TemporaryFolder folder;
  folder.write("thing.mtl", "newmtl red\nKd 1 0 0\n");
  const ImportedModel model = import_model(
      folder.write("thing.obj", "mtllib gone.mtl\n" + std::string(kFace) + "usemtl red\nf 1 2 3\n"));
  EXPECT_THAT(model.warnings,
              ElementsAre(testing::AllOf(HasSubstr("'gone.mtl' is missing"), HasSubstr("'thing.mtl'"))));
  EXPECT_EQ(model.scene.materials.at(model.scene.parts.at(0).material).base_color, layers::vec3(1, 0, 0));
}

TEST(ReadObj, ManyMaterialsOfNoLibraryAreOneLine) {
  std::string text = kFace;
  for (int k = 0; k < 8; ++k) text += "usemtl m" + std::to_string(k) + "\nf 1 2 3\n";
  EXPECT_THAT(read_obj_text(text).warnings,
              ElementsAre("materials 'm0', 'm1', 'm2', 'm3', 'm4' and 3 more are in no library"));
}

// 0.6 in sRGB is 0.31855: what has no material and no colour is that grey.
TEST(ReadObj, VerticesWithoutAColourBesideOthersThatHaveOne) {
  const layers::Scene scene =
      read_obj_text(
          "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nv 5 5 5\nv 6 5 5 0.5\nv 5 6 5\n"
          "o a\nf 1 2 3\no b\nf 4 5 6\nusemtl paint\nf 4 5 6\n")
          .scene;
  ASSERT_EQ(scene.meshes.size(), 3u);
  EXPECT_EQ(scene.meshes[0].colors, (std::vector<layers::vec3>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  for (std::size_t mesh : {1, 2})
    for (std::size_t part = 0; part < scene.parts.size(); ++part) {
      if (scene.parts[part].mesh != static_cast<int>(mesh)) continue;
      const layers::Material& look = scene.materials[scene.parts[part].material];
      for (const layers::vec3& color : scene.meshes[mesh].colors)
        EXPECT_NEAR((color * look.base_color).x, 0.31855f, 2e-4f) << scene.parts[part].name;
    }
  EXPECT_TRUE(read_obj_text("v 0 0 0\nv 1 0 0 0.5\nv 0 1 0\nf 1 2 3\n").scene.meshes.at(0).colors.empty())
      << "a weight is no colour";
}

}  // namespace
}  // namespace talisman::sequences
