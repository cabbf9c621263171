// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/default_view.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "chunker/render.h"
#include "sequences/content/sequence.h"
#include "sequences/pipeline/make_pipeline.h"
#include "sequences/pipeline/step.h"
#include "tests/sequences/temporary_folder.h"
#include "tests/support/scenes.h"

namespace talisman::sequences {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using tests::TemporaryFolder;

/// A post 2 high and 0.2 wide, which throws a shadow.
constexpr const char* kPost =
    "v -.1 0 -.1\nv .1 0 -.1\nv .1 2 -.1\nv -.1 2 -.1\nv -.1 0 .1\nv .1 0 .1\nv .1 2 .1\nv -.1 2 .1\n"
    "f 5 6 7 8\nf 2 1 4 3\nf 6 2 3 7\nf 1 5 8 4\nf 8 7 3 4\nf 1 2 6 5\n";

std::vector<std::uint8_t> first_picture(const Sequence& sequence) {
  Settings settings;
  settings.view.display_px = {128, 128};
  settings.fps = sequence.fps;
  settings.frames = sequence.frames;
  const Pipeline pipeline = make_pipeline(*sequence.scene, sequence.layers, settings);
  const chunker::PreparedScene prepared(*sequence.scene, settings.render);
  PipelineState state(pipeline);
  return chunker::srgb_bytes(step(pipeline, state, 0, &prepared).picture);
}

TEST(ModelView, TurnsOnceIn20SecondsOrAsAsked) {
  const TemporaryFolder folder;
  const std::string model = folder.write("post.obj", kPost);
  EXPECT_EQ(load_sequence(model).frames, 480);
  EXPECT_EQ(load_sequence(model, {.turntable_s = 2.0}).frames, 48);
  const Sequence quick = load_sequence(model, {.turntable_s = 2.0});
  const auto first = quick.scene->at(0).camera.world_from_camera,
             half = quick.scene->at(1).camera.world_from_camera;
  EXPECT_NEAR(first[3].x, -half[3].x, 1e-9);  // on the other side
  EXPECT_NEAR(first[3].z, -half[3].z, 1e-9);
}

TEST(ModelView, GroundIsSeenByItsShadowAlone) {
  const TemporaryFolder folder;
  const std::vector<std::uint8_t> rgb = first_picture(load_sequence(folder.write("post.obj", kPost)));
  // The backdrop is (128 / 255)² in linear light, 137 in sRGB; where the key light's 0.65 · 0.85 / |(-0.4, -0.85,
  // -0.35)| of 1.041 is missing, 0.2522 · (0.48 / 1.041) = 0.1161 is left, 95 in sRGB.
  int backdrop = 0, shadow = 0, between = 0;
  for (std::size_t i = 0; i < rgb.size(); i += 3) {
    backdrop += rgb[i] == 137;
    shadow += rgb[i] >= 93 && rgb[i] <= 97;
    between += rgb[i] == 136 || rgb[i] == 138;
  }
  EXPECT_GT(backdrop, 128 * 128 / 2);
  EXPECT_GT(shadow, 30);
  // Where the rim cuts a pixel ground and backdrop add up to within one code value.
  EXPECT_LT(between, 200) << "the ground's rim shows";
}

TEST(ModelView, WithoutAStageThereIsTheModelAlone) {
  const TemporaryFolder folder;
  const Sequence bare = load_sequence(folder.write("post.obj", kPost), {.stage = false});
  EXPECT_EQ(bare.layers.layers.size(), 1u);
  EXPECT_EQ(bare.scene->background, layers::vec3(0));
  EXPECT_EQ(first_picture(bare)[0], 0);
}

// What no lamp of the file reaches is black: before black it would not be seen.
TEST(ModelView, LampsWithoutACameraStandBeforeTheBackdropOnNoGround) {
  layers::Scene scene;
  scene.nodes.resize(1);
  scene.meshes = {talisman::tests::cube_mesh()};
  scene.materials.resize(1);
  scene.parts.push_back({"cube", 0, 0, 0, -1});
  scene.lights.resize(1);
  std::vector<layers::LayerSpec> specs;
  add_model_view(scene, specs, {.exposure_lx = 4});
  EXPECT_NEAR(scene.background.x, 128.0 / 255 * 128 / 255, 1e-6);
  EXPECT_EQ(scene.parts.size(), 1u);
  EXPECT_EQ(scene.lights.size(), 1u);
  EXPECT_TRUE(specs.empty());
}

TEST(ModelView, ExposureOfASequenceDividesItsLights) {
  const TemporaryFolder folder;
  const std::string text =
      "frames: 1\nshapes: [{id: b, box: [1, 1, 1]}]\nlights: [{kind: ambient, color: [1, 1, 1], intensity: "
      "3}]\n";
  const std::string file = folder.write("b.yaml", text + "exposure: 2\n");
  EXPECT_FLOAT_EQ(load_sequence(file).scene->lights[0].color.x, 1.5f);
  EXPECT_FLOAT_EQ(load_sequence(file, {.exposure_lx = 6.0}).scene->lights[0].color.x, 0.5f);
  EXPECT_THAT(tests::message_of([&] { load_sequence(folder.write("c.yaml", text + "exposure: 0\n")); }),
              HasSubstr("exposure is '0'"));
}

TEST(ModelView, TurntableOfASequenceIsItsOrbit) {
  const TemporaryFolder folder;
  const Sequence slow =
      load_sequence(folder.write("b.yaml", "frames: 1\nturntable: 40\nshapes: [{id: b, box: [1, 1, 1]}]\n"));
  const auto first = slow.scene->at(0).camera.world_from_camera,
             half = slow.scene->at(20).camera.world_from_camera;
  EXPECT_NEAR(first[3].z, -half[3].z, 1e-9);
  EXPECT_GT(std::abs(first[3].z), 1e-3);
}

}  // namespace
}  // namespace talisman::sequences
