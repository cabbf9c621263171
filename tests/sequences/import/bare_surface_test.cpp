// SPDX-License-Identifier: Apache-2.0
// STL and PLY by their specifications, on files of a few triangles; values by hand.
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "sequences/import/model_import.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using layers::vec2;
using layers::vec3;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using tests::TemporaryFolder;

ImportedModel read(const std::string& name, const std::string& bytes) {
  const TemporaryFolder folder;
  return import_model(folder.write(name, bytes));
}

std::string refusal(const std::string& name, const std::string& bytes) {
  return tests::message_of([&] { read(name, bytes); });
}

template <typename T>
std::string raw(std::initializer_list<T> values) {
  std::string bytes;
  for (const T& value : values) bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  return bytes;
}

void expect_color(const vec3& color, const vec3& expected) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(color[k], expected[k], 2e-4) << k;
}

const layers::Mesh& mesh_of(const ImportedModel& model) { return model.scene.meshes.at(0); }
const layers::Material& look_of(const ImportedModel& model) { return model.scene.materials.at(0); }

// --- STL

/// A triangle in z = 0 whose normal is said to be `normal`, and its attributes.
std::string facet(std::uint16_t attributes, float normal = 1) {
  return raw<float>({0, 0, normal, 0, 0, 0, 1, 0, 0, 0, 1, 0}) + raw<std::uint16_t>({attributes});
}

std::string binary_stl(std::string title, const std::vector<std::string>& facets) {
  title.resize(80, ' ');
  std::string bytes = title + raw<std::uint32_t>({static_cast<std::uint32_t>(facets.size())});
  for (const std::string& one : facets) bytes += one;
  return bytes;
}

TEST(Stl, ColoursOfVisCamAreRedFromTheHighBits) {
  // 1 11111 00000 00000 is red; 1 00000 00000 11111 blue; without bit 15 it is the grey of 0.6 in sRGB.
  const ImportedModel model = read("a.stl", binary_stl("", {facet(0xFC00), facet(0x801F), facet(0x001F)}));
  ASSERT_EQ(mesh_of(model).colors.size(), 9u);
  expect_color(mesh_of(model).colors[0], {1, 0, 0});
  expect_color(mesh_of(model).colors[3], {0, 0, 1});
  expect_color(mesh_of(model).colors[6], vec3(0.31855f));
  expect_color(look_of(model).base_color, vec3(1));
}

TEST(Stl, ColoursOfMaterialiseAreRedFromTheLowBits) {
  // 0 00000 00000 11111 is red; bit 15 set: the colour of the whole, which is green.
  const std::string title = std::string("COLOR=") + '\0' + '\xFF' + '\0' + '\xFF';
  const ImportedModel model = read("a.stl", binary_stl(title, {facet(0x001F), facet(0x8000)}));
  expect_color(mesh_of(model).colors.at(0), {1, 0, 0});
  expect_color(mesh_of(model).colors.at(3), {0, 1, 0});
  EXPECT_EQ(look_of(model).opacity, 1);
}

TEST(Stl, WithoutColoursItIsGrey) {
  const ImportedModel model = read("a.stl", binary_stl("solid, but binary", {facet(0)}));
  EXPECT_THAT(mesh_of(model).colors, IsEmpty());
  expect_color(look_of(model).base_color, vec3(0.31855f));
  EXPECT_TRUE(look_of(model).two_sided);
  EXPECT_EQ(model.scene.parts.at(0).name, "a.stl");
}

TEST(Stl, NormalsAreThoseOfThePlaces) {
  for (const float said : {1.0f, 0.0f, -1.0f, NAN})
    EXPECT_THAT(mesh_of(read("a.stl", binary_stl("", {facet(0, said)}))).normals, Each(vec3(0, 0, 1)))
        << said;
}

TEST(Stl, CutOffIsRefusedWithItsCounts) {
  std::string bytes = binary_stl("", {facet(0), facet(0), facet(0)});
  bytes.resize(bytes.size() - 30);
  EXPECT_THAT(refusal("a.stl", bytes), HasSubstr("says 3 facets and holds 2"));
}

std::string solid(const std::string& name, const std::string& third = "0 1 0") {
  return "solid " + name +
         "\n facet normal 0 0 0\n  outer loop\n   vertex 0 0 0\n   vertex 1e0 0 0\n   vertex " + third +
         "\n  endloop\n endfacet\nendsolid " + name + "\n";
}

TEST(Stl, EverySolidOfATextIsAPart) {
  const ImportedModel model = read("a.stl", solid("lid") + solid("empty").substr(0, 12) + solid("box"));
  ASSERT_EQ(model.scene.parts.size(), 2u);
  EXPECT_EQ(model.scene.parts[0].name, "a.stl/lid");
  EXPECT_EQ(model.scene.parts[1].name, "a.stl/box");
  EXPECT_THAT(mesh_of(model).normals, Each(vec3(0, 0, 1)));
  EXPECT_EQ(read("a.stl", solid("lid")).scene.parts.at(0).name, "a.stl");
}

TEST(Stl, FarFromItsOriginItKeepsItsShape) {
  const ImportedModel model =
      read("a.stl",
           "solid x\nfacet normal 0 0 1\nouter loop\nvertex 1000000.1 0 0\n"
           "vertex 1000000.3 0 0\nvertex 1000000.1 0.2 0\nendloop\nendfacet\nendsolid\n");
  EXPECT_NEAR(mesh_of(model).positions.at(1).x - mesh_of(model).positions.at(0).x, 0.2, 1e-7);
}

TEST(Stl, WhatIsNoNumberIsRefusedWithItsLine) {
  EXPECT_THAT(refusal("a.stl", solid("x", "0 q 0")), HasSubstr("line 6: '   vertex 0 q 0', rule"));
  EXPECT_THAT(refusal("a.stl", solid("x", "0 nan 0")), HasSubstr("line 6: "));
  EXPECT_THAT(refusal("a.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop\n"),
              HasSubstr("line 5: a facet has 1 vertices, rule: 3"));
  EXPECT_THAT(refusal("a.stl", "no model at all"), HasSubstr("neither binary STL nor"));
}

// --- PLY

std::string ply(const std::string& header, const std::string& values) {
  return "ply\nformat ascii 1.0\n" + header + "end_header\n" + values;
}

constexpr const char* kPlace = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
constexpr const char* kFace = "element face 1\nproperty list uchar int vertex_indices\n";

TEST(Ply, DiffuseRedIsAColour) {
  for (const std::string prefix : {"", "diffuse_"}) {
    const std::string colors = "property uchar " + prefix + "red\nproperty uchar " + prefix +
                               "green\nproperty uchar " + prefix + "blue\n";
    const ImportedModel model =
        read("a.ply", ply(kPlace + colors + kFace, "0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0 0 0 128\n3 0 1 2\n"));
    expect_color(mesh_of(model).colors.at(0), {1, 0, 0});
    expect_color(mesh_of(model).colors.at(1), {0, 1, 0});
    expect_color(mesh_of(model).colors.at(2), {0, 0, 0.21586f});  // 128 / 255 in sRGB
    expect_color(look_of(model).base_color, vec3(1));
    EXPECT_THAT(model.warnings, IsEmpty());
  }
}

constexpr const char* kRgba =
    "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n";

TEST(Ply, AlphaOfVerticesIsDrawn) {
  const ImportedModel model = read("a.ply", ply(std::string(kPlace) + kRgba + kFace,
                                                "0 0 0 9 9 9 255\n1 0 0 9 9 9 51\n0 1 0 9 9 9 0\n3 0 1 2\n"));
  EXPECT_THAT(mesh_of(model).alphas, ElementsAre(1, 0.2f, 0));
  const ImportedModel clear = read("a.ply", ply(std::string(kPlace) + kRgba + kFace,
                                                "0 0 0 9 9 9 0\n1 0 0 9 9 9 0\n0 1 0 9 9 9 0\n3 0 1 2\n"));
  EXPECT_THAT(mesh_of(clear).alphas, IsEmpty());
  EXPECT_THAT(clear.warnings, ElementsAre(HasSubstr("alpha is left out")));
}

TEST(Ply, FacesHaveColoursOfTheirOwn) {
  // A square of a red and a blue triangle.
  const ImportedModel model = read(
      "a.ply", ply("element vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n"
                   "property list uchar int vertex_index\nproperty uchar red\nproperty uchar green\nproperty "
                   "uchar blue\n",
                   "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 255 0 0\n3 0 2 3 0 0 255\n"));
  ASSERT_EQ(mesh_of(model).colors.size(), 6u);
  for (std::size_t k = 0; k < 3; ++k) expect_color(mesh_of(model).colors[k], {1, 0, 0});
  for (std::size_t k = 3; k < 6; ++k) expect_color(mesh_of(model).colors[k], {0, 0, 1});
  EXPECT_THAT(mesh_of(model).normals, Each(vec3(0, 0, 1)));
}

/// An element with a list before the vertices, in the byte order asked for.
std::string binary_ply(bool big) {
  const auto bytes = [&](auto value) {
    std::string one(reinterpret_cast<const char*>(&value), sizeof value);
    if (big) std::reverse(one.begin(), one.end());
    return one;
  };
  std::string text = "ply\nformat binary_" + std::string(big ? "big" : "little") +
                     "_endian 1.0\nelement grid 2\nproperty list uchar short at\n" + kPlace + kFace +
                     "end_header\n";
  for (const int length : {2, 0}) {
    text += static_cast<char>(length);
    for (int k = 0; k < length; ++k) text += bytes(static_cast<std::int16_t>(-k));
  }
  for (const float value : {0.f, 0.f, 0.f, 2.f, 0.f, 0.f, 0.f, 3.f, 0.f}) text += bytes(value);
  text += '\3';
  for (const int index : {0, 1, 2}) text += bytes(static_cast<std::int32_t>(index));
  return text;
}

TEST(Ply, ListsBeforeTheVerticesAreStridden) {
  for (const bool big : {false, true}) {
    const ImportedModel model = read("a.ply", binary_ply(big));
    EXPECT_THAT(mesh_of(model).positions, ElementsAre(vec3(0), vec3(2, 0, 0), vec3(0, 3, 0))) << big;
    EXPECT_THAT(model.warnings, ElementsAre("element 'grid' is not drawn"));
  }
}

TEST(Ply, SidesFollowTheNormalsAndBothAreDrawn) {
  const std::string header =
      std::string(kPlace) + "property float nx\nproperty float ny\nproperty float nz\n" + kFace;
  const ImportedModel model =
      read("a.ply", ply(header, "0 0 0 0 0 -2\n1 0 0 0 0 -2\n0 1 0 0 0 -2\n3 0 1 2\n"));
  EXPECT_THAT(mesh_of(model).indices, ElementsAre(0u, 2u, 1u));
  EXPECT_THAT(mesh_of(model).normals, Each(vec3(0, 0, -1)));
  EXPECT_TRUE(look_of(model).two_sided);
}

TEST(Ply, CoordinatesOfCornersAndTheirPicture) {
  const TemporaryFolder folder;
  folder.write("t.ppm", "P6\n1 1\n255\nabc");
  const ImportedModel model =
      import_model(folder.write("a.ply", ply("comment TextureFile t.ppm\n" + std::string(kPlace) + kFace +
                                                 "property list uchar float texcoord\n",
                                             "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 6 0 0 0.5 0.25 0 1\n")));
  EXPECT_EQ(look_of(model).texture, 0);
  expect_color(look_of(model).base_color, vec3(1));
  EXPECT_THAT(mesh_of(model).uvs, ElementsAre(vec2(0, 1), vec2(0.5, 0.75), vec2(0, 0)));
}

TEST(Ply, StripsTurnEverySecondTriangle) {
  // A square as a strip of four, then -1 and one more triangle.
  const ImportedModel model =
      read("a.ply",
           ply("element vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement tristrips 1\n"
               "property list int int vertex_indices\n",
               "0 0 0\n1 0 0\n0 1 0\n1 1 0\n8 0 1 2 3 -1 0 1 3\n"));
  EXPECT_THAT(mesh_of(model).indices, ElementsAre(0u, 1u, 2u, 1u, 3u, 2u, 0u, 1u, 3u));
}

TEST(Ply, RefusalsNameElementAndRule) {
  const std::string three = "0 0 0\n1 0 0\n0 1 0\n", header = std::string(kPlace) + kFace;
  EXPECT_THAT(refusal("a.ply", ply(header, three + "3 0 1 3\n")),
              HasSubstr("face 0 names vertex 3, rule: from 0, below 3"));
  EXPECT_THAT(refusal("a.ply", ply(header, three + "3 0 1")), HasSubstr("ends within face 0 of 1"));
  EXPECT_THAT(refusal("a.ply", ply(header, "0 0 zero\n")), HasSubstr("'zero' in vertex 0, rule: a number"));
  EXPECT_THAT(refusal("a.ply", ply("element vertex 1\nproperty quad x\n", "")),
              HasSubstr("line 4 of its header: type 'quad', rule: char"));
  EXPECT_THAT(refusal("a.ply", ply(kPlace, three)), HasSubstr("has no triangles"));
}

}  // namespace
}  // namespace talisman::sequences
