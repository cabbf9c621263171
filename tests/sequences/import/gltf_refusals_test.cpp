// SPDX-License-Identifier: Apache-2.0
// What is against the rules of glTF 2.0 is refused with the value and the rule.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/sequences/import/gltf_builder.h"

namespace talisman::sequences {
namespace {

using ::testing::HasSubstr;
using tests::Gltf;
using tests::Json;

TEST(GltfRules, AlphaModeIsOneOfThree) {
  Gltf file;
  file.json["materials"].push_back({{"name", "paint"}, {"alphaMode", "FOO"}});
  file.primitive()["material"] = 0;
  EXPECT_THAT(file.refusal(), HasSubstr("alphaMode 'FOO' of material 'paint', rule: OPAQUE, MASK or BLEND"));
  file.json["materials"][0]["alphaMode"] = "MASK";
  EXPECT_EQ(file.refusal(), "");
}

TEST(GltfRules, WhatNeedsALaterReaderIsRefused) {
  Gltf file;
  file.json["asset"]["minVersion"] = "2.1";
  EXPECT_THAT(file.refusal(), HasSubstr("wants a reader of glTF 2.1, rule: 2.0"));
  file.json["asset"]["minVersion"] = "2.0";
  EXPECT_EQ(file.refusal(), "");
}

TEST(GltfRules, StrideIsAtLeastAnElement) {
  Gltf file;
  file.json["bufferViews"][0]["byteStride"] = 8;
  EXPECT_THAT(file.refusal(), HasSubstr("byteStride 8, rule: at least the 12 bytes of an element"));
}

TEST(GltfRules, AttributesOfAPrimitiveHaveOneCount) {
  Gltf file;
  // The square has four corners; nothing asks for its coordinates, and they are against the rules all the same.
  file.primitive()["attributes"]["TEXCOORD_0"] = file.add<float>({0, 0, 1, 0, 1, 1}, 5126, "VEC2");
  EXPECT_THAT(file.refusal(),
              HasSubstr("TEXCOORD_0 of mesh 'sheet' has 3 elements, rule: as many as POSITION, 4"));
}

/// The square before a camera at z = 5.
Gltf with_camera(const std::string& type, const Json& lens) {
  Gltf file;
  file.json["nodes"].push_back({{"name", "eye"}, {"camera", 0}, {"translation", {0, 0, 5}}});
  file.json["scenes"][0]["nodes"] = {0, 1};
  file.json["cameras"] = Json::array({{{"type", type}, {type, lens}}});
  return file;
}

TEST(GltfRules, LensOfACamera) {
  const auto perspective = [](const Json& lens) { return with_camera("perspective", lens).refusal(); };
  EXPECT_THAT(perspective({{"yfov", 0}, {"znear", 1}}),
              HasSubstr("'eye' has yfov 0, rule: above 0 and below pi"));
  EXPECT_THAT(perspective({{"yfov", 3.2}, {"znear", 1}}), HasSubstr("yfov 3.2, rule"));
  EXPECT_THAT(perspective({{"yfov", 1}, {"znear", 0}}), HasSubstr("znear 0, rule: above 0"));
  EXPECT_THAT(perspective({{"yfov", 1}, {"znear", 1}, {"zfar", 1}}),
              HasSubstr("zfar 1, rule: greater than znear, 1"));
  EXPECT_EQ(perspective({{"yfov", 1}, {"znear", 1}}), "");
  const auto orthographic = [](double x, double y, double near, double far) {
    return with_camera("orthographic", {{"xmag", x}, {"ymag", y}, {"znear", near}, {"zfar", far}}).refusal();
  };
  EXPECT_THAT(orthographic(0, 1, 0, 10), HasSubstr("xmag 0, rule: not 0"));
  EXPECT_THAT(orthographic(1, 0, 0, 10), HasSubstr("ymag 0, rule: not 0"));
  EXPECT_THAT(orthographic(1, 1, -1, 10), HasSubstr("znear -1, rule: at least 0"));
  EXPECT_THAT(orthographic(1, 1, 3, 2), HasSubstr("zfar 2, rule: greater than znear, 3"));
  EXPECT_EQ(orthographic(1, 1, 0, 10), "");
}

TEST(GltfLosses, WhatLiesBeyondTheFarPlaneIsSaid) {
  // The square is 5 away.
  const auto warnings = [](double far) {
    return with_camera("perspective", {{"yfov", 1}, {"znear", 1}, {"zfar", far}}).import().warnings;
  };
  EXPECT_THAT(warnings(4), ::testing::ElementsAre(HasSubstr("beyond the far plane of camera 'eye', 4 m")));
  EXPECT_THAT(warnings(5), ::testing::IsEmpty());
}

TEST(GltfLosses, MorphsOfColoursAreSaid) {
  Gltf file;
  const std::vector<float> shift(12, 0.5f);
  file.primitive()["targets"] = Json::array({{{"COLOR_0", file.add<float>(shift, 5126, "VEC3")}}});
  EXPECT_THAT(
      file.import().warnings,
      ::testing::Contains(HasSubstr("colours and texture coordinates of morph targets are not moved")));
}

}  // namespace
}  // namespace talisman::sequences
