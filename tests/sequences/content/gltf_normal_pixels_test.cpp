// SPDX-License-Identifier: Apache-2.0
// Normal maps as pixels. A texel of 218, 128, 218 is the normal (0.71, 0.00, 0.71): it leans by 45° towards the
// tangent. Light along -z on the square that faces it is 1; on a surface that leans by 45° it is 0.707, in sRGB 219.
// Light that comes slanted, by 45°, from the side to which a surface leans is 1, from the other side 0, and 219 on
// what does not lean. So light from the right shows which way u grows, light from above which way v shrinks.
#include <cmath>
#include <limits>

#include "tests/sequences/content/gltf_pixels.h"

namespace talisman::tests {
namespace {

const Rgb kOf45 = {219, 219, 219};
const std::string kAlongZ = "[{kind: directional, direction: [0, 0, -1]}]";
const std::string kFromTheRight = "[{kind: directional, direction: [-1, 0, -1]}]";
const std::string kFromTheLeft = "[{kind: directional, direction: [1, 0, -1]}]";
const std::string kFromAbove = "[{kind: directional, direction: [0, -1, -1]}]";
const std::string kFromBelow = "[{kind: directional, direction: [0, 1, -1]}]";

const std::vector<std::uint8_t> kToTangent = {218, 128, 218}, kFromTangent = {37, 128, 218},
                                kToBitangent = {128, 218, 218}, kFlat = {128, 128, 255};

std::vector<std::uint8_t> beside(std::vector<std::uint8_t> left, const std::vector<std::uint8_t>& right) {
  left.insert(left.end(), right.begin(), right.end());
  return left;
}

/// A white square with this normal map, (0, 0) of it at the upper left.
Json& bumpy_square(Gltf& file, const std::vector<std::uint8_t>& texels) {
  attribute(file, "TEXCOORD_0", file.add<float>({0, 1, 1, 1, 1, 0, 0, 0}, 5126, "VEC2"));
  Json material = plain({1, 1, 1, 1});
  material["normalTexture"] = {{"index", picture(file, static_cast<int>(texels.size() / 3), texels)}};
  return look(file, material);
}

void facing_normals(Gltf& file) {
  attribute(file, "NORMAL", file.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 5126, "VEC3"));
}

void tangents(Gltf& file, float x, float y, float sign) {
  facing_normals(file);
  std::vector<float> values;
  for (int i = 0; i < 4; ++i) values.insert(values.end(), {x, y, 0, sign});
  attribute(file, "TANGENT", file.add<float>(values, 5126, "VEC4"));
}

std::function<void(Gltf&)> bumpy(
    const std::vector<std::uint8_t>& texels, const std::function<void(Gltf&)>& change = [](Gltf&) {}) {
  return [=](Gltf& f) {
    bumpy_square(f, texels);
    change(f);
  };
}

/// The whole picture on the left half, and turned over on the right half; they share the vertices between them.
void mirrored_halves(Gltf& file) {
  attribute(file, "POSITION",
            file.add<float>({-1, -1, 0, 0, -1, 0, 0, 1, 0, -1, 1, 0, 1, -1, 0, 1, 1, 0}, 5126, "VEC3"));
  attribute(file, "TEXCOORD_0", file.add<float>({0, 1, 1, 1, 1, 0, 0, 0, 0, 1, 0, 0}, 5126, "VEC2"));
  std::vector<float> normals;
  for (int i = 0; i < 6; ++i) normals.insert(normals.end(), {0, 0, 1});
  attribute(file, "NORMAL", file.add<float>(normals, 5126, "VEC3"));
  file.primitive()["indices"] = file.add<std::uint16_t>({0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2}, 5123, "SCALAR");
}

const float kHalf = std::sqrt(0.5f);

Json turned(double x, double y, double z, double w) { return Json::array({x, y, z, w}); }

const std::vector<PixelCase> kShadingCases = {
    {"FlatMapIsNoMap", bumpy(kFlat), {{32, 32, kWhite}}, 0, {}, kAlongZ},
    {"FlatMapUnderSlantedLight", bumpy(kFlat), {{32, 32, kOf45}}, 0, {}, kFromTheLeft},
    {"Tilted45DegreesGivesTheCosine", bumpy(kToTangent), {{32, 32, kOf45}}, 0, {}, kAlongZ},
    {"TangentIsWhereUGrows", bumpy(kToTangent), {{32, 32, kWhite}}, 0, {}, kFromTheRight},
    {"AwayFromTheLightIsBlack", bumpy(kToTangent), {{32, 32, kBlack}}, 0, {}, kFromTheLeft},
    {"GreenIsUpwards", bumpy(kToBitangent), {{32, 32, kWhite}}, 0, {}, kFromAbove},
    {"GreenIsNotDownwards", bumpy(kToBitangent), {{32, 32, kBlack}}, 0, {}, kFromBelow},
    {"HalfTheScaleHalvesTheSlope",  // 1 / √1.25 = 0.894
     [](Gltf& f) { bumpy_square(f, kToTangent)["normalTexture"]["scale"] = 0.5; },
     {{32, 32, {243, 243, 243}}},
     0,
     {},
     kAlongZ},
    {"NoScaleIsNoMap",
     [](Gltf& f) { bumpy_square(f, kToTangent)["normalTexture"]["scale"] = 0; },
     {{32, 32, kWhite}},
     0,
     {},
     kAlongZ},
    {"NegativeScaleLeansTheOtherWay",
     [](Gltf& f) { bumpy_square(f, kToTangent)["normalTexture"]["scale"] = -1; },
     {{32, 32, kWhite}},
     0,
     {},
     kFromTheLeft},
    {"BumpIsABumpOnBothMirroredHalves",
     bumpy(beside(kFromTangent, kToTangent), mirrored_halves),
     {{16, 32, kBlack}, {26, 32, kWhite}, {37, 32, kBlack}, {47, 32, kWhite}},
     0,
     {},
     kFromTheRight},
    {"UpwardsIsUpwardsOnBothMirroredHalves",
     bumpy(kToBitangent, mirrored_halves),
     {{16, 32, kWhite}, {26, 32, kWhite}, {37, 32, kWhite}, {47, 32, kWhite}},
     0,
     {},
     kFromAbove},
    {"AmbientLightAsksNoNormals", bumpy(kToTangent), {{32, 32, kWhite}}},
    {"UnlitAsksNoNormals",
     [](Gltf& f) { bumpy_square(f, kToTangent)["extensions"]["KHR_materials_unlit"] = Json::object(); },
     {{32, 32, kWhite}},
     0,
     {},
     kAlongZ},
    {"BaseMapHasCoordinatesOfItsOwn",
     [](Gltf& f) {
       Json& m = bumpy_square(f, beside(kToTangent, kFlat));
       attribute(f, "TEXCOORD_1", f.add<float>({0, 1, 1, 1, 1, 0, 0, 0}, 5126, "VEC2"));
       attribute(f, "TEXCOORD_0", f.add<float>({1, 0, 0, 0, 0, 1, 1, 1}, 5126, "VEC2"));
       m["normalTexture"]["texCoord"] = 1;
       base_map(m) = {{"index", four_colors(f)}};
     },
     {{21, 42, {0, 219, 0}}, {42, 42, kRed}, {21, 21, {219, 219, 0}}, {42, 21, kBlue}},
     0,
     {},
     kAlongZ},
};

const std::vector<PixelCase> kSurfaceCases = {
    {"RotatedNodeCarriesItsTangents",
     bumpy(kToTangent, [](Gltf& f) { f.json["nodes"][0]["rotation"] = turned(0, 0, kHalf, kHalf); }),
     {{32, 32, kWhite}},
     0,
     {},
     kFromAbove},
    {"MirroredNodeKeepsBumpsBumps",
     bumpy(kToBitangent,
           [](Gltf& f) {
             f.json["nodes"][0]["scale"] = {-1, 1, 1};
           }),
     {{32, 32, kWhite}},
     0,
     {},
     kFromAbove},
    {"ScaledNodeTurnsTangentsWithTheSurface",  // (1, 1) becomes (2, 1) / √5: (0.894 + 1) / 2 = 0.947
     bumpy(kToTangent,
           [](Gltf& f) {
             tangents(f, kHalf, kHalf, 1);
             f.json["nodes"][0]["scale"] = {2, 1, 1};
           }),
     {{32, 32, {249, 249, 249}}},
     0,
     {},
     kFromTheRight},
    {"TiltedNormalOfAScaledNodeStaysAtRightAngles",
     // The square rises to the right by 45°, and is scaled to rise by 63°: its normal is (-2, 0, 1) / √5, its
     // tangent (1, 0, 2) / √5. A map that leans by 45° makes (-1, 0, 3) / √10 of them: 0.949 along z.
     bumpy(kToTangent,
           [](Gltf& f) {
             attribute(f, "POSITION", f.add<float>({-1, -1, -1, 1, -1, 1, 1, 1, 1, -1, 1, -1}, 5126, "VEC3"));
             f.json["nodes"][0]["scale"] = {0.5, 1, 1};
           }),
     {{32, 32, {249, 249, 249}}},
     0,
     {},
     kAlongZ},
    {"SeenFromBehindABumpIsAHollow",  // -(0.71 (-x) + 0.71 (-z))
     [](Gltf& f) {
       bumpy_square(f, kToTangent)["doubleSided"] = true;
       f.json["nodes"][0]["rotation"] = turned(0, 1, 0, 0);
     },
     {{32, 32, kWhite}},
     0,
     {},
     kFromTheRight},
    {"SeenFromBehindUpwardsIsDownwards",
     [](Gltf& f) {
       bumpy_square(f, kToBitangent)["doubleSided"] = true;
       f.json["nodes"][0]["rotation"] = turned(0, 1, 0, 0);
     },
     {{32, 32, kWhite}},
     0,
     {},
     kFromBelow},
    {"SkinCarriesTangents",
     bumpy(kToTangent,
           [](Gltf& f) {
             skin_on(f, {{"name", "joint"}, {"rotation", turned(0, 0, kHalf, kHalf)}});
           }),
     {{32, 32, kWhite}},
     0,
     {},
     kFromAbove},
};

/// A target that turns the square by 90° in its plane.
void quarter_turn(Gltf& f) {
  facing_normals(f);
  const int target = f.add<float>({2, 0, 0, 0, 2, 0, -2, 0, 0, 0, -2, 0}, 5126, "VEC3");
  f.primitive()["targets"] = Json::array({{{"POSITION", target}}});
}

const std::vector<PixelCase> kTangentCases = {
    {"MorphTargetThatRestsTurnsTangents",
     bumpy(kToTangent,
           [](Gltf& f) {
             quarter_turn(f);
             f.json["meshes"][0]["weights"] = {1};
           }),
     {{32, 32, kWhite}},
     0,
     {},
     kFromAbove},
    {"MorphTargetThatMovesTurnsTangents",
     bumpy(kToTangent,
           [](Gltf& f) {
             quarter_turn(f);
             animate(f, "weights", {0, 0.5, 2}, f.add<float>({0, 1, 1}, 5126, "SCALAR"), "STEP");
           }),
     {{32, 32, kWhite}},
     12,
     {},
     kFromAbove},
    {"MorphTargetHasTangentsOfItsOwn",  // +x and (-1, 1) make +y
     bumpy(kToTangent,
           [](Gltf& f) {
             tangents(f, 1, 0, 1);
             const int target = f.add<float>({-1, 1, 0, -1, 1, 0, -1, 1, 0, -1, 1, 0}, 5126, "VEC3");
             f.primitive()["targets"] = Json::array({{{"TANGENT", target}}});
             f.json["meshes"][0]["weights"] = {1};
           }),
     {{32, 32, kWhite}},
     0,
     {},
     kFromAbove},
    {"TangentsOfTheFileComeFirst",
     bumpy(kToTangent, [](Gltf& f) { tangents(f, 0, 1, 1); }),
     {{32, 32, kWhite}},
     0,
     {},
     kFromAbove},
    {"SignOfTheFileTurnsTheBitangent",
     bumpy(kToBitangent, [](Gltf& f) { tangents(f, 1, 0, -1); }),
     {{32, 32, kWhite}},
     0,
     {},
     kFromBelow},
    {"TangentsWithoutNormalsAreIgnored",
     bumpy(kToTangent,
           [](Gltf& f) {
             tangents(f, 0, 1, 1);
             f.primitive()["attributes"].erase("NORMAL");
           }),
     {{32, 32, kWhite}},
     0,
     {},
     kFromTheRight},
    {"QuantisedTangents",
     bumpy(kToTangent,
           [](Gltf& f) {
             facing_normals(f);
             f.json["extensionsUsed"] = f.json["extensionsRequired"] = {"KHR_mesh_quantization"};
             std::vector<std::int8_t> values;
             for (int i = 0; i < 4; ++i) values.insert(values.end(), {0, 127, 0, 127});
             attribute(f, "TANGENT", f.add<std::int8_t>(values, 5120, "VEC4", true));
           }),
     {{32, 32, kWhite}},
     0,
     {},
     kFromAbove},
    {"TangentsThatAreNoNumbersAreMadeFromCoordinates",
     bumpy(kToTangent, [](Gltf& f) { tangents(f, std::numeric_limits<float>::quiet_NaN(), 1, 1); }),
     {{32, 32, kWhite}},
     0,
     {},
     kFromTheRight},
    {"TurnedTransformTurnsTheBumps",  // u grows downwards
     [](Gltf& f) {
       bumpy_square(f, kToTangent)["normalTexture"]["extensions"]["KHR_texture_transform"] = {
           {"rotation", std::acos(0.0)}};
     },
     {{32, 32, kWhite}},
     0,
     {},
     kFromBelow},
    {"TurnedTransformTurnsTheTangentsOfTheFile",
     [](Gltf& f) {
       bumpy_square(f, kToTangent)["normalTexture"]["extensions"]["KHR_texture_transform"] = {
           {"rotation", std::acos(0.0)}};
       tangents(f, 1, 0, 1);
     },
     {{32, 32, kWhite}},
     0,
     {},
     kFromBelow},
    {"CoordinatesWithoutAreaHaveNoMap",
     bumpy(kToTangent,
           [](Gltf& f) {
             attribute(f, "TEXCOORD_0", f.add<float>({0, 0, 0, 0, 0, 0, 0, 0}, 5126, "VEC2"));
           }),
     {{32, 32, kWhite}},
     0,
     {},
     kAlongZ},
    {"CoordinatesOnALineHaveNoMap",
     bumpy(kToTangent,
           [](Gltf& f) {
             attribute(f, "TEXCOORD_0", f.add<float>({0, 0, 1, 2, 3, 6, .5, 1}, 5126, "VEC2"));
           }),
     {{32, 32, kWhite}},
     0,
     {},
     kAlongZ},
    {"WithoutCoordinatesThereIsNoMap",
     bumpy(kToTangent, [](Gltf& f) { f.primitive()["attributes"].erase("TEXCOORD_0"); }),
     {{32, 32, kWhite}},
     0,
     {},
     kAlongZ},
};

class GltfNormalPixels : public ::testing::TestWithParam<PixelCase> {};

TEST_P(GltfNormalPixels, AreThoseOfTheSpecification) { expect_pixels(GetParam()); }

INSTANTIATE_TEST_SUITE_P(Shading, GltfNormalPixels, ::testing::ValuesIn(kShadingCases),
                         [](const auto& one) { return one.param.name; });
INSTANTIATE_TEST_SUITE_P(Surface, GltfNormalPixels, ::testing::ValuesIn(kSurfaceCases),
                         [](const auto& one) { return one.param.name; });
INSTANTIATE_TEST_SUITE_P(Tangent, GltfNormalPixels, ::testing::ValuesIn(kTangentCases),
                         [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace talisman::tests
