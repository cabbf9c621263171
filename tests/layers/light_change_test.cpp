// SPDX-License-Identifier: Apache-2.0
#include "layers/light_change.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "layers/animation.h"
#include "layers/effects.h"
#include "tests/support/scenes.h"

namespace talisman::layers {
namespace {

using ::testing::HasSubstr;

/// A cube under an ambient light and a sun; nothing moves yet.
struct LitCube {
  Scene scene = tests::cube_scene();
  LitCube& spin(int node) {
    scene.tracks.push_back({node, SpinTrack{{0, 1, 0}, 1}});
    return *this;
  }
  int add_node(int parent = -1) {
    scene.nodes.emplace_back();
    scene.nodes.back().parent = parent;
    return static_cast<int>(scene.nodes.size()) - 1;
  }
  Material& material() { return scene.materials[scene.parts[0].material]; }
  int cube() const { return scene.parts[0].node; }
  Light& sun() {
    for (Light& light : scene.lights)
      if (light.kind == Light::Kind::Directional) return light;
    return scene.lights.front();
  }
  LightChange change() const {
    return light_change_of(scene, factor(scene, tests::one_layer_per_part(scene)).layers[0],
                           moving_carriers(scene));
  }
};

TEST(LightChange, NothingChangesAtRest) {
  const LightChange change = LitCube().change();
  EXPECT_FALSE(change.possible());
  EXPECT_THAT(std::string(change.why_not), HasSubstr("no light moves"));
  EXPECT_EQ(change.why, "");
}

TEST(LightChange, LayerThatTurnsUnderAFixedSunChanges) {
  LitCube lit;
  const LightChange change = lit.spin(lit.cube()).change();
  EXPECT_TRUE(change.possible());
  EXPECT_THAT(change.why, HasSubstr("part 'cube' and light"));
}

TEST(LightChange, LightThatMovesChangesALayerAtRest) {
  LitCube lit;
  lit.sun().node = lit.add_node();
  EXPECT_FALSE(lit.change().possible());
  EXPECT_TRUE(lit.spin(lit.sun().node).change().possible());
}

// A lamp mounted on what it lights moves with it.
TEST(LightChange, LightCarriedByTheLayerDoesNotChange) {
  LitCube lit;
  lit.sun().node = lit.add_node(lit.cube());
  EXPECT_FALSE(lit.spin(lit.cube()).change().possible());
}

TEST(LightChange, UnlitLayersAndAmbientLightNeverChange) {
  LitCube unlit;
  unlit.spin(unlit.cube()).material().unlit = true;
  EXPECT_EQ(unlit.change().why_not, "no part of the layer is lit");
  LitCube dark;
  dark.spin(dark.cube()).scene.lights.clear();
  EXPECT_EQ(dark.change().why_not, "the scene has no light");
  LitCube flat;
  flat.spin(flat.cube()).sun().kind = Light::Kind::Ambient;
  EXPECT_EQ(flat.change().why_not, "the only light is ambient");
}

TEST(LightChange, HighlightsChangeWithTheEye) {
  LitCube lit;
  lit.scene.cameras[0].node = lit.add_node();
  lit.spin(lit.scene.cameras[0].node);
  EXPECT_FALSE(lit.change().possible());
  lit.material().specular = {0.5f, 0.5f, 0.5f};
  EXPECT_TRUE(lit.change().possible());
  EXPECT_THAT(lit.change().why, HasSubstr("eye"));
}

TEST(LightChange, SkinnedLayersDeformUnderTheLight) {
  const Scene scene = tests::skinned_bar_scene();
  const auto layers = factor(scene, tests::one_layer_per_part(scene)).layers;
  EXPECT_TRUE(light_change_of(scene, layers[0], moving_carriers(scene)).possible());
}

TEST(Effects, ColorWarpIsCalledForByTheLayersWhoseLightChanges) {
  const Scene scene = tests::moving_scene();  // ground at rest; cube and moon turn under the sun
  const auto layers = factor(scene, tests::one_layer_per_part(scene)).layers;
  for (const EffectCall& call : effects_called_for(scene, layers)) {
    if (call.effect != Effect::ColorWarp) continue;
    EXPECT_TRUE(call.called);
    EXPECT_EQ(call.layers, (std::vector<int>{1, 2}));
  }
  const Scene rest = tests::cube_scene();
  const auto table = effects_called_for(rest, factor(rest, tests::one_layer_per_part(rest)).layers);
  const auto row = std::find_if(table.begin(), table.end(),
                                [](const EffectCall& call) { return call.effect == Effect::ColorWarp; });
  ASSERT_NE(row, table.end());
  EXPECT_FALSE(row->called);
  EXPECT_NE(row->why, "");
}

}  // namespace
}  // namespace talisman::layers
