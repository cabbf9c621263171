// SPDX-License-Identifier: Apache-2.0
// Files that say nonsense of a surface or of light, whose right reading is worked out by hand.
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/sequences/import/gltf_builder.h"

namespace talisman::sequences {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using tests::Gltf;
using tests::Json;

// Black without a word, if its direction were left to chance: a square that faces +z.
TEST(GltfNormals, WithoutADirectionAreThoseOfTheTrianglesAndItIsSaid) {
  Gltf file;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  file.primitive()["attributes"]["NORMAL"] =
      file.add<float>({0, 0, 0, 0, 0, 2, nan, 0, 0, 1e-20f, 0, 0}, 5126, "VEC3");
  const ImportedModel model = file.import();
  for (const layers::vec3& normal : model.scene.meshes.at(0).normals)
    EXPECT_EQ(normal, layers::vec3(0, 0, 1));
  EXPECT_THAT(model.warnings,
              Contains(HasSubstr("normals without a direction are those of their triangles")));
}

// 100 cd at 2 m before the square are 25 lx; the spot beside it, a hundred times as strong, lights nothing.
TEST(GltfExposure, IsNotThatOfASpotWhoseConeMissesAll) {
  for (const bool misses : {true, false}) {
    Gltf file;
    file.json["extensionsUsed"] = {"KHR_lights_punctual"};
    const Json spot = {{"type", "spot"}, {"intensity", 10000}, {"spot", {{"outerConeAngle", 0.2}}}};
    file.json["extensions"]["KHR_lights_punctual"]["lights"] =
        Json::array({{{"type", "point"}, {"intensity", 100}}, spot});
    const auto lamp = [](int light, std::vector<double> at, std::vector<double> turn) {
      return Json{{"translation", at},
                  {"rotation", turn},
                  {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}};
    };
    file.json["nodes"].push_back(lamp(0, {0, 0, 2}, {0, 0, 0, 1}));
    // Shines along -z, or turned by half a turn, away from the square.
    file.json["nodes"].push_back(
        lamp(1, {0, 0, 2}, misses ? std::vector<double>{1, 0, 0, 0} : std::vector<double>{0, 0, 0, 1}));
    file.json["scenes"][0]["nodes"] = {0, 1, 2};
    EXPECT_NEAR(file.import().exposure_lx, misses ? 25 : 2500, 1e-3) << misses;
  }
}

}  // namespace
}  // namespace talisman::sequences
