// SPDX-License-Identifier: Apache-2.0
// What the command line says about content and about the folder of results.
#include "tests/sequences/commands/tool.h"

namespace talisman {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

using RunContent = Tool;

constexpr const char* kShort = " --frames 0-1 --size 64x48 --progress none ";

TEST_F(RunContent, FolderOfOtherFilesIsTakenOnlyByForce) {
  std::filesystem::create_directories(path("photos"));
  write("photos/holiday.png", "not ours");
  expect_bad_input(std::string("render cube.obj") + kShort + "--out photos",
                   {"photos", "holds files that are not of a run", "--force"});
  EXPECT_EQ(files_in("photos"), std::set<std::string>{"holiday.png"});
  EXPECT_EQ(run(std::string("render cube.obj --force") + kShort + "--out photos").exit_code, 0);
  EXPECT_EQ(read("photos/holiday.png"), "not ours");
  // Now it is a folder of ours.
  EXPECT_EQ(run(std::string("render cube.obj") + kShort + "--out photos").exit_code, 0);
}

TEST_F(RunContent, EmptyFolderNeedsNoForce) {
  std::filesystem::create_directories(path("o"));
  EXPECT_EQ(run(std::string("render cube.obj") + kShort + "--out o").exit_code, 0);
}

TEST_F(RunContent, SpriteThatHadToStaySmallIsSaid) {
  write(
      "near.yaml",
      "frames: 1\ndisplay: [256, 256]\nshapes: [{id: wall, box: [4, 4, 1]}]\nplacement: {max_sprite_px: 64}\n"
      "camera: {fov_deg: 60, near_m: 0.1, far_m: 100, position: [0, 0, 3]}\n");
  const Outcome capped = run("render near.yaml --progress none --out o");
  EXPECT_EQ(capped.exit_code, 0);
  EXPECT_THAT(capped.output, HasSubstr("warning: layer 'wall': its sprite would have more than 64 texels"));
  EXPECT_THAT(run("render cube.obj --progress none --out p --frames 0").output,
              Not(HasSubstr("texels on a side")));
}

TEST_F(RunContent, BadValuesNameOptionValueAndRule) {
  const std::string render = "render cube.obj --progress none ";
  expect_bad_input(render + "--exposure 0", {"--exposure is 0", "above 0"});
  expect_bad_input(render + "--turntable -3", {"--turntable is -3", "above 0"});
  expect_bad_input(render + "--assets nowhere", {"--assets is 'nowhere', must be a folder that is there"});
}

TEST_F(RunContent, ThatChangeThePictureBelongToTheRun) {
  const std::string render = std::string("render cube.obj") + kShort + "--out o ";
  ASSERT_EQ(run(render + "--exposure 2").exit_code, 0);
  EXPECT_EQ(run(render + "--exposure 2 --resume").exit_code, 0);
  expect_bad_input(render + "--exposure 3 --resume", {"exposure was 2.0, is 3.0"});
  expect_bad_input(render + "--resume", {"exposure was 2.0, is absent"});
}

TEST_F(RunContent, ExposureOverridesThatOfTheFile) {
  write("lamp.gltf", R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_lights_punctual"],
"extensions":{"KHR_lights_punctual":{"lights":[{"type":"directional","intensity":5}]}},
"scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0},{"extensions":{"KHR_lights_punctual":{"light":0}}}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":2,"indices":{"bufferView":0,
"componentType":5121},"values":{"bufferView":1}}}],
"bufferViews":[{"buffer":0,"byteLength":2},{"buffer":0,"byteOffset":4,"byteLength":24}],
"buffers":[{"byteLength":28,"uri":"data:;base64,AQIAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAA=="}]})");
  EXPECT_THAT(run("inspect lamp.gltf").output, HasSubstr("the largest illuminance, 5 lx, is shown as 1"));
  const Outcome asked = run("inspect lamp.gltf --exposure 10");
  EXPECT_EQ(asked.exit_code, 0) << asked.output;
  EXPECT_THAT(asked.output, HasSubstr("10 lx, takes the place of the file's"));
}

}  // namespace
}  // namespace talisman
