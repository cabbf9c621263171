// SPDX-License-Identifier: Apache-2.0
// What is against the rules of glTF 2.0 is refused with the value and the rule.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/sequences/import/gltf_builder.h"

namespace talisman::sequences {
namespace {

using ::testing::HasSubstr;
using tests::Gltf;

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
