// SPDX-License-Identifier: Apache-2.0
#include "tests/sequences/content/gltf_pixels.h"

namespace talisman::tests {
namespace {

const std::vector<PixelCase> kAccessorCases = {
    {"PositionsFloat", red, kSquare},
    {"PositionsByte",
     [](Gltf& f) {
       red(f);
       attribute(f, "POSITION", f.add<std::int8_t>({-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}, 5120, "VEC3"));
     },
     kSquare},
    {"PositionsNormalizedShort",
     [](Gltf& f) {
       red(f);
       attribute(f, "POSITION",
                 f.add<std::int16_t>({-32767, -32767, 0, 32767, -32767, 0, 32767, 32767, 0, -32767, 32767, 0},
                                     5122, "VEC3", true));
     },
     kSquare},
    {"PositionsUnsignedShortMovedByTheNode",
     [](Gltf& f) {
       red(f);
       attribute(f, "POSITION", f.add<std::uint16_t>({0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0}, 5123, "VEC3"));
       f.json["nodes"][0]["translation"] = {-1, -1, 0};
     },
     kSquare},
    {"PositionsUnsignedByteScaledByTheNode",
     [](Gltf& f) {
       red(f);
       attribute(f, "POSITION",
                 f.add<std::uint8_t>({0, 0, 0, 200, 0, 0, 200, 200, 0, 0, 200, 0}, 5121, "VEC3"));
       f.json["nodes"][0]["translation"] = {-1, -1, 0};
       f.json["nodes"][0]["scale"] = {0.01, 0.01, 1};
     },
     kSquare},
    {"PositionsBeginInsideTheirView",
     [](Gltf& f) {
       red(f);
       std::vector<float> v = {9, 9, 9};
       v.insert(v.end(), kCornersOfSquare);
       const int a = attribute(f, "POSITION", f.add<float>(v, 5126, "VEC3"));
       f.json["accessors"][a]["byteOffset"] = 12, f.json["accessors"][a]["count"] = 4;
     },
     kSquare},
    {"SparseCornerMoves",  // the upper right corner goes to the middle: the upper right half is empty
     [](Gltf& f) {
       red(f);
       const int i = f.view<std::uint16_t>({2}), v = f.view<float>({0, 0, 0});
       f.json["accessors"][0]["sparse"] = {{"count", 1},
                                           {"indices", {{"bufferView", i}, {"componentType", 5123}}},
                                           {"values", {{"bufferView", v}}}};
     },
     {{48, 15, kBlack}, {36, 16, kBlack}, {15, 48, kRed}, {30, 40, kRed}}},
    {"IndicesByte",
     [](Gltf& f) {
       red(f), f.primitive()["indices"] = f.add<std::uint8_t>({0, 1, 2, 0, 2, 3}, 5121, "SCALAR");
     },
     kSquare},
    {"IndicesWord",
     [](Gltf& f) {
       red(f), f.primitive()["indices"] = f.add<std::uint32_t>({0, 1, 2, 0, 2, 3}, 5125, "SCALAR");
     },
     kSquare},
    {"IndicesAbsent",  // the first three corners: the lower right half
     [](Gltf& f) { red(f), f.primitive().erase("indices"); },
     {{45, 45, kRed}, {18, 18, kBlack}}},
    {"CoordinatesNormalizedShort",
     [](Gltf& f) {
       textured_square(f, four_colors(f));
       attribute(f, "TEXCOORD_0",
                 f.add<std::uint16_t>({0, 65535, 65535, 65535, 65535, 0, 0, 0}, 5123, "VEC2", true));
     },
     kFourColors},
    {"CoordinatesNormalizedByte",
     [](Gltf& f) {
       textured_square(f, four_colors(f));
       attribute(f, "TEXCOORD_0", f.add<std::uint8_t>({0, 255, 255, 255, 255, 0, 0, 0}, 5121, "VEC2", true));
     },
     kFourColors},
};

const auto grey = [](Gltf& f) { look(f, plain({1, 1, 1, 1})); };
const std::vector<PixelCase> kPrimitiveCases = {
    {"ColorsFloat",
     [](Gltf& f) {
       grey(f);
       attribute(f, "COLOR_0", f.add<float>({0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0}, 5126, "VEC3"));
     },
     {{32, 32, kGreen}}},
    {"ColorsAreLinear",
     [](Gltf& f) {
       grey(f);
       attribute(f, "COLOR_0",
                 f.add<float>({.5, .25, .2, .5, .25, .2, .5, .25, .2, .5, .25, .2}, 5126, "VEC3"));
     },
     {{32, 32, {188, 137, 124}}}},
    {"ColorsNormalizedShort",
     [](Gltf& f) {
       grey(f);
       attribute(
           f, "COLOR_0",
           f.add<std::uint16_t>({0, 0, 65535, 0, 0, 65535, 0, 0, 65535, 0, 0, 65535}, 5123, "VEC3", true));
     },
     {{32, 32, kBlue}}},
    {"ColorsTimesFactor",
     [](Gltf& f) {
       look(f, plain({0.5, 1, 1, 1}));
       attribute(f, "COLOR_0", f.add<float>({1, .5, 0, 1, .5, 0, 1, .5, 0, 1, .5, 0}, 5126, "VEC3"));
     },
     {{32, 32, {188, 188, 0}}}},
    {"Strip",
     [](Gltf& f) {
       red(f);
       f.primitive()["mode"] = 5;
       f.primitive()["indices"] = f.add<std::uint8_t>({0, 1, 3, 2}, 5121, "SCALAR");
     },
     kSquare},
    {"Fan", [](Gltf& f) { red(f), f.primitive()["mode"] = 6, f.primitive().erase("indices"); }, kSquare},
    {"TwoPrimitivesTwoMaterials",
     [](Gltf& f) {
       red(f);
       Json upper = f.primitive();
       upper["indices"] = f.add<std::uint8_t>({0, 2, 3}, 5121, "SCALAR");
       f.primitive()["indices"] = f.add<std::uint8_t>({0, 1, 2}, 5121, "SCALAR");
       f.json["materials"].push_back(plain({0, 0, 1, 1}));
       upper["material"] = 1;
       f.json["meshes"][0]["primitives"].push_back(upper);
     },
     {{45, 45, kRed}, {18, 18, kBlue}}},
    {"BackFacesAreCulled",
     [](Gltf& f) {
       red(f), f.json["nodes"][0]["rotation"] = {0, 1, 0, 0};
     },
     {{32, 32, kBlack}}},
    {"BackFacesOfDoubleSidedAreNot",
     [](Gltf& f) {
       look(f, plain({1, 0, 0, 1}))["doubleSided"] = true;
       f.json["nodes"][0]["rotation"] = {0, 1, 0, 0};
     },
     kSquare},
    {"MirroredNodeTurnsItsFaces",
     [](Gltf& f) {
       red(f), f.json["nodes"][0]["scale"] = {-1, 1, 1};
     },
     kSquare},
    {"MirroredTwiceToo",
     [](Gltf& f) {
       red(f), f.json["nodes"][0]["scale"] = {-1, -1, 1};
     },
     kSquare},
};

const std::vector<PixelCase> kNodeCases = {
    {"Translation",
     [](Gltf& f) {
       red(f), f.json["nodes"][0]["translation"] = {1, 0, 0};
     },
     {{42, 32, kRed}, {21, 32, kBlack}}},
    {"Scale",
     [](Gltf& f) {
       red(f), f.json["nodes"][0]["scale"] = {0.25, 1, 1};
     },
     {{32, 14, kRed}, {42, 32, kBlack}}},
    {"RotationOfXyzw",  // 45° about z: corners on the axes, 1.41 away
     [](Gltf& f) {
       red(f), f.json["nodes"][0]["rotation"] = {0, 0, 0.38268343, 0.92387953};
     },
     {{32, 4, kRed}, {12, 12, kBlack}}},
    {"ScaleBeforeRotationBeforeTranslation",  // a lying bar becomes a standing one, then moves right
     [](Gltf& f) {
       red(f);
       Json& n = f.json["nodes"][0];
       n["scale"] = {1, 0.25, 1}, n["rotation"] = {0, 0, 0.70710678, 0.70710678},
       n["translation"] = {0.5, 0, 0};
     },
     {{42, 14, kRed}, {42, 50, kRed}, {21, 32, kBlack}, {52, 32, kBlack}}},
    {"MatrixByColumns",
     [](Gltf& f) { red(f), f.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1}; },
     {{42, 32, kRed}, {21, 32, kBlack}}},
    {"MatrixThatShears",  // x += y: the upper edge from 0 to 2, the lower one from -2 to 0
     [](Gltf& f) { red(f), f.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; },
     {{48, 14, kRed}, {20, 14, kBlack}, {16, 50, kRed}, {44, 50, kBlack}}},
    {"MatrixThatFlattens",
     [](Gltf& f) { red(f), f.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}; },
     kSquare},
    {"ChildOfAScaledNode",
     [](Gltf& f) {
       red(f);
       f.json["nodes"][0]["translation"] = {2, 0, 0};
       f.json["nodes"].push_back({{"children", {0}}, {"scale", {0.5, 0.5, 1}}});
       f.json["scenes"][0]["nodes"] = {1};
     },
     {{53, 32, kRed}, {32, 32, kBlack}, {40, 32, kBlack}}},
    {"NodeOfNoSceneIsNotDrawn",
     [](Gltf& f) {
       red(f);
       f.json["nodes"][0]["scale"] = {0.25, 0.25, 1};
       f.json["nodes"].push_back({{"mesh", 0}});
     },
     {{32, 32, kRed}, {14, 14, kBlack}}},
    {"ChosenScene",
     [](Gltf& f) {
       red(f);
       f.json["nodes"].push_back({{"mesh", 0}, {"translation", {1, 0, 0}}});
       f.json["scenes"].push_back({{"nodes", {1}}});
       f.json["scene"] = 1;
     },
     {{42, 32, kRed}, {21, 32, kBlack}}},
    {"WithoutScenesAllRootsAreDrawn", [](Gltf& f) { red(f), f.json.erase("scenes"), f.json.erase("scene"); },
     kSquare},
    {"OneMeshOnTwoNodes",
     [](Gltf& f) {
       red(f);
       f.json["nodes"][0]["scale"] = {0.25, 0.25, 1};
       f.json["nodes"][0]["translation"] = {-0.5, 0, 0};
       second_node(f, {{"mesh", 0}, {"scale", {0.25, 0.25, 1}}, {"translation", {0.5, 0, 0}}});
     },
     {{21, 32, kRed}, {42, 32, kRed}, {32, 32, kBlack}}},
    {"NearerHidesFarther",
     [](Gltf& f) {
       red(f);
       Json mesh = f.json["meshes"][0];
       f.json["materials"].push_back(plain({0, 1, 0, 1}));
       mesh["primitives"][0]["material"] = 1;
       f.json["meshes"].push_back(mesh);
       second_node(f, {{"mesh", 1}, {"translation", {0, 0, 0.5}}, {"scale", {0.25, 0.25, 1}}});
     },
     {{32, 32, kGreen}, {14, 14, kRed}}},
};

const std::vector<Pixel> right = {{42, 32, kRed}, {21, 32, kBlack}};
const std::vector<PixelCase> kMotionCases = {
    {"MorphByTheMesh", [](Gltf& f) { red(f), morph_to_the_right(f), f.json["meshes"][0]["weights"] = {1}; },
     right},
    {"MorphByTheNodeGoesFirst",
     [](Gltf& f) {
       red(f), morph_to_the_right(f);
       f.json["meshes"][0]["weights"] = {0};
       f.json["nodes"][0]["weights"] = {1};
     },
     right},
    {"MorphWithoutWeightsRests", [](Gltf& f) { red(f), morph_to_the_right(f); }, kSquare},
    {"MorphAnimated",
     [](Gltf& f) {
       red(f), morph_to_the_right(f);
       animate(f, "weights", {0, 1, 2}, f.add<float>({0, 1, 1}, 5126, "SCALAR"), "LINEAR");
     },
     right, 10},
    {"SkinFollowsItsJoint",
     [](Gltf& f) {
       red(f), skin_on(f, {{"translation", {1, 0, 0}}});
     },
     right},
    {"SkinIgnoresItsOwnNode",
     [](Gltf& f) {
       red(f), skin_on(f, {{"translation", {1, 0, 0}}});
       f.json["nodes"][0]["translation"] = {-5, 0, 0};
     },
     right},
    {"SkinWithAnInverseBindMatrix",  // the joint's own place is taken off again
     [](Gltf& f) {
       red(f), skin_on(f, {{"translation", {1, 0, 0}}});
       f.json["skins"][0]["inverseBindMatrices"] =
           f.add<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1}, 5126, "MAT4");
     },
     kSquare},
    {"StepHolds",
     [](Gltf& f) {
       red(f);
       animate(f, "translation", {0, 1, 2}, f.add<float>({1, 0, 0, 9, 0, 0, 9, 0, 0}, 5126, "VEC3"), "STEP");
     },
     right, 9},
    {"LinearIsHalfWayAtHalfTime",
     [](Gltf& f) {
       red(f);
       animate(f, "translation", {0, 1, 2}, f.add<float>({0, 0, 0, 2, 0, 0, 2, 0, 0}, 5126, "VEC3"),
               "LINEAR");
     },
     right, 5},
    // Values 0 and 2, slopes 0 and 0: 3t² − 2t³ of the way, 1 at half time; 0.896 at 0.4 with slopes of 1 would not be.
    {"CubicSplineEases",
     [](Gltf& f) {
       red(f);
       animate(f, "translation", {0, 1},
               f.add<float>({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0}, 5126, "VEC3"),
               "CUBICSPLINE");
     },
     right, 5},
    {"RotationTurnsEvenly",  // 45° after half of a quarter turn
     [](Gltf& f) {
       red(f);
       animate(f, "rotation", {0, 1, 2},
               f.add<float>({0, 0, 0, 1, 0, 0, .70710678f, .70710678f, 0, 0, .70710678f, .70710678f}, 5126,
                            "VEC4"),
               "LINEAR");
     },
     {{32, 4, kRed}, {12, 12, kBlack}},
     5},
    {"ScaleAnimated",
     [](Gltf& f) {
       red(f);
       animate(f, "scale", {0, 1, 2}, f.add<float>({1, 1, 1, .25, 1, 1, .25, 1, 1}, 5126, "VEC3"), "LINEAR");
     },
     {{32, 14, kRed}, {42, 32, kBlack}},
     10},
};

class GltfGeometryPixels : public ::testing::TestWithParam<PixelCase> {};

TEST_P(GltfGeometryPixels, AreThoseOfTheSpecification) { expect_pixels(GetParam()); }

INSTANTIATE_TEST_SUITE_P(Accessor, GltfGeometryPixels, ::testing::ValuesIn(kAccessorCases),
                         [](const auto& one) { return one.param.name; });
INSTANTIATE_TEST_SUITE_P(Primitive, GltfGeometryPixels, ::testing::ValuesIn(kPrimitiveCases),
                         [](const auto& one) { return one.param.name; });
INSTANTIATE_TEST_SUITE_P(Node, GltfGeometryPixels, ::testing::ValuesIn(kNodeCases),
                         [](const auto& one) { return one.param.name; });
INSTANTIATE_TEST_SUITE_P(Motion, GltfGeometryPixels, ::testing::ValuesIn(kMotionCases),
                         [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace talisman::tests
