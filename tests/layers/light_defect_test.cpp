// SPDX-License-Identifier: Apache-2.0
// The rules of lights, shadows and second textures: what breaks one is named.
#include <gmock/gmock.h>

#include "layers/scene.h"

namespace talisman::layers {
namespace {

using ::testing::HasSubstr;

Scene lit_scene() {
  Scene scene;
  scene.lights.resize(1);
  scene.lights[0].name = "lamp";
  scene.lights[0].kind = Light::Kind::Spot;
  scene.materials.resize(1);
  return scene;
}

TEST(FirstDefect, DefaultsOfLightsAndMaterialsHaveNone) { EXPECT_EQ(first_defect(lit_scene()), ""); }

TEST(FirstDefect, ConesMustLieInsideEachOther) {
  Scene scene = lit_scene();
  scene.lights[0].inner_cone_rad = 0.7;  // wider than the outer one
  EXPECT_THAT(first_defect(scene), HasSubstr("inner cone angle"));
  scene = lit_scene();
  scene.lights[0].outer_cone_rad = 1.6;  // beyond a half sphere
  EXPECT_THAT(first_defect(scene), HasSubstr("outer cone angle"));
  scene = lit_scene();
  scene.lights[0].direction = {0, 0, 0};
  EXPECT_THAT(first_defect(scene), HasSubstr("direction is zero"));
}

TEST(FirstDefect, ShadowOptionsHaveRanges) {
  const auto defect_after = [](auto change) {
    Scene scene = lit_scene();
    change(scene.lights[0]);
    return first_defect(scene);
  };
  EXPECT_THAT(defect_after([](Light& l) { l.shadow.resolution_px = -1; }), HasSubstr("shadow resolution"));
  EXPECT_THAT(defect_after([](Light& l) { l.shadow.resolution_px = 8193; }), HasSubstr("shadow resolution"));
  EXPECT_THAT(defect_after([](Light& l) { l.shadow.pcf_radius = 9; }), HasSubstr("filter radius"));
  EXPECT_THAT(defect_after([](Light& l) { l.shadow.bias_texels = std::nanf(""); }), HasSubstr("shadow bias"));
  EXPECT_THAT(defect_after([](Light& l) { l.shadow.slope_bias = -1; }), HasSubstr("slope bias"));
  EXPECT_THAT(defect_after([](Light& l) {
                l.kind = Light::Kind::Ambient;
                l.casts_shadow = true;
              }),
              HasSubstr("ambient light casts a shadow"));
}

TEST(FirstDefect, FewLightsMayCastShadows) {
  Scene scene = lit_scene();
  scene.lights[0].casts_shadow = true;
  scene.lights.resize(kMaxShadowLights, scene.lights[0]);
  EXPECT_EQ(first_defect(scene), "");
  scene.lights.push_back(scene.lights[0]);
  EXPECT_THAT(first_defect(scene), HasSubstr("5 lights cast shadows"));
}

TEST(FirstDefect, SecondTexturesAndReflectivity) {
  Scene scene = lit_scene();
  scene.materials[0].texture2 = 0;  // there is none
  EXPECT_THAT(first_defect(scene), HasSubstr("second texture"));
  scene = lit_scene();
  scene.materials[0].texture_blend.y = 1.5f;
  EXPECT_THAT(first_defect(scene), HasSubstr("texture blend 2"));
  scene = lit_scene();
  scene.materials[0].reflectivity = -0.1f;
  EXPECT_THAT(first_defect(scene), HasSubstr("reflectivity"));
}

}  // namespace
}  // namespace talisman::layers
