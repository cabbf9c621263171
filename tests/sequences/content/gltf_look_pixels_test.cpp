// SPDX-License-Identifier: Apache-2.0
#include "tests/sequences/content/gltf_pixels.h"

namespace talisman::tests {
namespace {

const auto wrapped = [](int mode) {
  return [mode](Gltf& f) {
    textured_square(f, four_colors(f));
    f.json["samplers"][0]["wrapS"] = f.json["samplers"][0]["wrapT"] = mode;
    attribute(f, "TEXCOORD_0", f.add<float>({0, 2, 2, 2, 2, 0, 0, 0}, 5126, "VEC2"));
  };
};
const auto moved = [](const Json& transform) {
  return [transform](Gltf& f) {
    base_map(textured_square(f, four_colors(f)))["extensions"]["KHR_texture_transform"] = transform;
  };
};
const std::vector<PixelCase> kTextureCases = {
    {"UpperLeftIsTheOrigin", [](Gltf& f) { textured_square(f, four_colors(f)); }, kFourColors},
    // Twice along each side: quarters are 10.7 pixels wide.
    {"WrapRepeats",
     wrapped(10497),
     {{16, 16, kRed}, {26, 16, kGreen}, {37, 16, kRed}, {48, 48, kYellow}, {16, 37, kRed}}},
    {"WrapClamps",
     wrapped(33071),
     {{16, 16, kRed}, {26, 16, kGreen}, {37, 16, kGreen}, {48, 48, kYellow}, {16, 37, kBlue}}},
    {"WrapMirrors",
     wrapped(33648),
     {{16, 16, kRed}, {26, 16, kGreen}, {37, 16, kGreen}, {48, 16, kRed}, {48, 48, kRed}}},
    {"FactorTimesTexture",
     [](Gltf& f) {
       textured_square(f, picture(f, 1, {255, 255, 255}))["pbrMetallicRoughness"]["baseColorFactor"] = {
           1, 0.5, 0.25, 1};
     },
     {{32, 32, {255, 188, 137}}}},
    {"BytesAreSrgb",
     [](Gltf& f) {
       textured_square(f, picture(f, 1, {200, 100, 50}));
     },
     {{32, 32, {200, 100, 50}}}},
    {"SecondSetOfCoordinates",
     [](Gltf& f) {
       base_map(textured_square(f, four_colors(f)))["texCoord"] = 1;
       attribute(f, "TEXCOORD_1",
                 f.add<float>({0, .25, .25, .25, .25, 0, 0, 0}, 5126, "VEC2"));  // the red quarter
     },
     {{21, 21, kRed}, {42, 42, kRed}}},
    {"TransformMoves", moved({{"offset", {0.5, 0}}}), {{21, 21, kGreen}, {42, 21, kRed}, {21, 42, kYellow}}},
    {"TransformScales", moved({{"scale", {0.5, 0.5}}}), {{21, 21, kRed}, {42, 42, kRed}}},
    // u' = cos u + sin v, v' = -sin u + cos v: by 90° (0.25, 0.25) looks at (0.25, -0.25), the lower left.
    {"TransformTurns",
     moved({{"rotation", 1.57079633}}),
     {{21, 21, kBlue}, {42, 21, kRed}, {21, 42, kYellow}, {42, 42, kGreen}}},
    {"TransformChoosesTheSet",
     [](Gltf& f) {
       base_map(textured_square(f, four_colors(f)))["extensions"]["KHR_texture_transform"] = {
           {"texCoord", 1}};
       attribute(f, "TEXCOORD_1", f.add<float>({.75, 1, 1, 1, 1, .75, .75, .75}, 5126, "VEC2"));
     },
     {{21, 21, kYellow}, {42, 42, kYellow}}},
    {"DataUri",
     [](Gltf& f) {
       textured_square(f, four_colors(f));
       f.json["images"][0] = {{"uri", "data:image/x-ppm;base64," +
                                          tests::base64("P6\n1 1\n255\n\xff\xff" + std::string(1, '\0'))}};
     },
     {{32, 32, kYellow}}},
    {"MissingTextureLeavesTheFactor",
     [](Gltf& f) {
       textured_square(f, four_colors(f))["pbrMetallicRoughness"]["baseColorFactor"] = {0, 0, 1, 1};
       f.json["images"][0] = {{"uri", "nowhere.png"}};
     },
     {{32, 32, kBlue}}},
};

const auto alpha = [](const char* mode, double value) {
  return [mode, value](Gltf& f) { look(f, plain({1, 0, 0, value}))["alphaMode"] = mode; };
};
const auto glowing = [](const Json& emission, double strength) {
  return [emission, strength](Gltf& f) {
    Json& m = look(f, plain({0, 0, 0, 1}));
    m["emissiveFactor"] = emission;
    m["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", strength}};
  };
};
const std::vector<PixelCase> kMaterialCases = {
    {"OpaqueHasNoAlpha", alpha("OPAQUE", 0.25), kSquare},
    {"MaskFromTheCutoffOnIsOpaque", alpha("MASK", 0.5), kSquare},
    {"MaskWithACutoffOfZeroIsOpaque",
     [](Gltf& f) {
       Json& material = look(f, plain({1, 0, 0, 0.25}));
       material["alphaMode"] = "MASK";
       material["alphaCutoff"] = 0;
       attribute(f, "COLOR_0",
                 f.add<float>({1, 1, 1, .3, 1, 1, 1, .3, 1, 1, 1, .3, 1, 1, 1, .3}, 5126, "VEC4"));
     },
     kSquare},
    {"MaskBelowTheCutoffIsNotThere", alpha("MASK", 0.49), {{32, 32, kBlack}}},
    {"BlendIsOver", alpha("BLEND", 0.5), {{32, 32, {188, 0, 0}}, {8, 32, kBlack}}},
    {"BlendByVertices",
     [](Gltf& f) {
       look(f, plain({1, 0, 0, 1}))["alphaMode"] = "BLEND";
       attribute(f, "COLOR_0",
                 f.add<float>({1, 1, 1, .25, 1, 1, 1, .25, 1, 1, 1, .25, 1, 1, 1, .25}, 5126, "VEC4"));
     },
     {{32, 32, {137, 0, 0}}}},
    {"EmissionNeedsNoLight", glowing({0, 1, 0}, 1), {{32, 32, kGreen}}, 0, "[0, 0, 0]"},
    {"EmissionIsLinear", glowing({0.5, 0.25, 0}, 1), {{32, 32, {188, 137, 0}}}, 0, "[0, 0, 0]"},
    {"EmissionTimesStrength", glowing({0.125, 0.25, 0}, 2), {{32, 32, {137, 188, 0}}}, 0, "[0, 0, 0]"},
    {"EmissionAddsToTheBase",
     [](Gltf& f) {
       look(f, plain({1, 0, 0, 1}))["emissiveFactor"] = {0, 0, 1};
     },
     {{32, 32, {255, 0, 255}}}},
    {"EmissiveTexture",
     [](Gltf& f) {
       Json& m = textured_square(f, four_colors(f));
       m = plain({0, 0, 0, 1});
       m["emissiveFactor"] = {1, 1, 1};
       m["emissiveTexture"] = {{"index", 0}};
     },
     kFourColors, 0, "[0, 0, 0]"},
    {"UnlitInTheDark",
     [](Gltf& f) {
       look(f, plain({1, 0.5, 0, 1}))["extensions"]["KHR_materials_unlit"] = Json::object();
     },
     {{32, 32, {255, 188, 0}}},
     0,
     "[0, 0, 0]"},
    {"LitInTheDarkIsBlack", red, {{32, 32, kBlack}}, 0, "[0, 0, 0]"},
    {"HalfLightIsHalf",
     [](Gltf& f) {
       look(f, plain({1, 0.5, 0, 1}));
     },
     {{32, 32, {188, 137, 0}}},
     0,
     "[0.5, 0.5, 0.5]"},
    {"SpecularGlossinessHasADiffuseColour",
     [](Gltf& f) {
       look(f, {{"extensions",
                 {{"KHR_materials_pbrSpecularGlossiness",
                   {{"diffuseFactor", {0, 1, 0.5, 1}}, {"specularFactor", {0, 0, 0}}}}}}});
     },
     {{32, 32, {0, 255, 188}}}},
    {"MetalKeeps45Hundredths",  // 0.45 in linear light is 179
     [](Gltf& f) {
       look(f, {{"pbrMetallicRoughness", {{"baseColorFactor", {1, 0, 0, 1}}}}});
     },
     {{32, 32, {179, 0, 0}}}},
    {"WithoutAMaterialTheDefaultIsAWhiteMetal", [](Gltf&) {}, {{32, 32, {179, 179, 179}}}},
};

class GltfLookPixels : public ::testing::TestWithParam<PixelCase> {};

TEST_P(GltfLookPixels, AreThoseOfTheSpecification) { expect_pixels(GetParam()); }

INSTANTIATE_TEST_SUITE_P(Texture, GltfLookPixels, ::testing::ValuesIn(kTextureCases),
                         [](const auto& one) { return one.param.name; });
INSTANTIATE_TEST_SUITE_P(Material, GltfLookPixels, ::testing::ValuesIn(kMaterialCases),
                         [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace talisman::tests
