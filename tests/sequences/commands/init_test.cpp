// SPDX-License-Identifier: Apache-2.0
// `talisman init`: a sequence that shows, bit by bit, what the bare model shows; and refusals of one line.
#include <string>

#include "tests/sequences/commands/tool.h"
#include "tests/sequences/import/gltf_builder.h"

namespace talisman {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class Init : public Tool {
 protected:
  /// Renders both and expects the same frames and the same decisions.
  void expect_same_pictures(const std::string& model, const std::string& options = "",
                            const std::string& frames = "0-5") const {
    const Outcome made = run_shell("( '" + tool() + "' init '" + model + "' " + options + " > s.yaml )");
    ASSERT_EQ(made.exit_code, 0) << made.output;
    const std::string how = " --size 96x64 --progress none --strict --frames " + frames;
    const Outcome bare = run("render '" + model + "' --out bare " + options + how),
                  ours = run("render s.yaml --out ours" + how);
    ASSERT_EQ(bare.exit_code, 0) << bare.output;
    ASSERT_EQ(ours.exit_code, 0) << ours.output << read("s.yaml");
    EXPECT_EQ(frame_hashes("ours"), frame_hashes("bare")) << read("s.yaml");
    EXPECT_EQ(read("ours/decisions.jsonl"), read("bare/decisions.jsonl"));
  }
};

/// Two arms that turn against each other below a body that moves, and a square at rest.
tests::Gltf moving_arms() {
  tests::Gltf file;
  file.json["nodes"] = tests::Json::array({{{"name", "square"}, {"mesh", 0}},
                                           {{"name", "body*"}, {"mesh", 0}, {"children", {2, 3}}},
                                           {{"name", "arm: left"}, {"mesh", 0}, {"translation", {2, 0, 0.5}}},
                                           {{"name", "arm"}, {"mesh", 0}, {"translation", {-2, 0, 0.25}}}});
  file.json["scenes"][0]["nodes"] = {0, 1};
  const int times = file.add<float>({0, 1, 2}, 5126, "SCALAR"),
            places = file.add<float>({0, 0, 0, 0.3f, 0.1f, 1, 0, 0, 0}, 5126, "VEC3"),
            others = file.add<float>({2, 0, 0.5f, 2, 0.7f, 0.5f, 2, 0, 0.5f}, 5126, "VEC3");
  file.json["animations"] = tests::Json::array(
      {{{"samplers", {{{"input", times}, {"output", places}}, {{"input", times}, {"output", others}}}},
        {"channels",
         {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}},
          {{"sampler", 1}, {"target", {{"node", 2}, {"path", "translation"}}}}}}}});
  return file;
}

TEST_F(Init, ModelWithoutNodesIsShownAsItIsShownBare) {
  expect_same_pictures("cube.obj");
  EXPECT_THAT(read("s.yaml"),
              AllOf(HasSubstr("file: cube.obj"), HasSubstr("disc: "), HasSubstr("turntable: 20")));
}

TEST_F(Init, OptionsAboutContentBecomeKeys) {
  expect_same_pictures("cube.obj", "--turntable 3 --exposure 2.5", "0-3");
  EXPECT_THAT(read("s.yaml"), AllOf(HasSubstr("turntable: 3 "), HasSubstr("exposure: 2.5 ")));
  expect_same_pictures("cube.obj", "--no-stage", "0-1");
  EXPECT_THAT(read("s.yaml"), AllOf(Not(HasSubstr("disc: ")), HasSubstr("background: [0, 0, 0]")));
}

TEST_F(Init, MovingPartsAreLayersAndNamesWithSignsAreQuoted) {
  write("two arms.gltf", moving_arms().text());
  expect_same_pictures("two arms.gltf", "", "20-26");
  EXPECT_THAT(read("s.yaml"), AllOf(HasSubstr("file: \"two arms.gltf\""), HasSubstr("id: two_arms"),
                                    HasSubstr("name: \"arm: left\""), HasSubstr("frames: 48")));
}

TEST_F(Init, CamerasAndLightsOfTheFileAreItsOwn) {
  tests::Gltf file = moving_arms();
  const auto eye = [&](const char* name, int camera, double z, int parent) {
    file.json["nodes"].push_back({{"name", name}, {"camera", camera}, {"translation", {0.5, 0.25, z}}});
    const int node = static_cast<int>(file.json["nodes"].size()) - 1;
    if (parent < 0)
      file.json["scenes"][0]["nodes"].push_back(node);
    else
      file.json["nodes"][parent]["children"].push_back(node);
  };
  eye("riding", 0, 6, 1);  // with the body
  eye("still", 1, 9, -1);
  file.json["cameras"] = tests::Json::array(
      {{{"name", "near"}, {"type", "perspective"}, {"perspective", {{"yfov", 0.9}, {"znear", 0.25}}}},
       {{"name", "far"}, {"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.25}}}}});
  file.json["extensionsUsed"] = {"KHR_lights_punctual"};
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = tests::Json::array(
      {{{"type", "point"}, {"intensity", 700}, {"range", 30}}, {{"type", "directional"}, {"intensity", 20}}});
  for (const int light : {0, 1})
    file.json["nodes"].push_back({{"name", "lamp" + std::to_string(light)},
                                  {"translation", {1, 2, 3}},
                                  {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}});
  for (const int node : {6, 7}) file.json["scenes"][0]["nodes"].push_back(node);
  write("lit.gltf", file.text());
  expect_same_pictures("lit.gltf", "", "18-22");
  EXPECT_THAT(read("s.yaml"), AllOf(HasSubstr("model: lit"), HasSubstr("named: "), HasSubstr("lights: true"),
                                    HasSubstr("Others in the file: ")));
}

TEST_F(Init, LayerOfTheModelMayBeCalledGround) {
  tests::Gltf file;
  file.json["nodes"][0]["name"] = "ground";
  write("field.gltf", file.text());
  expect_same_pictures("field.gltf", "", "0-2");
  EXPECT_THAT(read("s.yaml"), HasSubstr("name: \"ground'\""));
}

// docs/sequence-format.md has a sequence to copy; it must run as it stands there, without a warning.
TEST_F(Init, CompleteSequenceOfTheDocsRunsAsItIs) {
  std::ifstream in(std::string(TALISMAN_SOURCE_DIR) + "/docs/sequence-format.md");
  const std::string page(std::istreambuf_iterator<char>(in), {});
  const std::size_t from = page.find("# mill.yaml\n"), to = page.find("```\n", from);
  ASSERT_NE(from, std::string::npos);
  write("mill.yaml", page.substr(from, to - from));
  const Outcome outcome = run("render mill.yaml --strict --frames 0-23 --size 160x120 --progress none");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output,
              AllOf(Not(HasSubstr("warning")), HasSubstr("  balloon "), HasSubstr("  sails ")));
}

TEST_F(Init, WhatIsNoModelIsRefusedInOneLine) {
  expect_bad_input("init nothing.glb", {"'nothing.glb' is not there", "a model"});
  expect_bad_input("init carousel", {"'carousel' is a sequence already"});
  write("a.yaml", "frames: 1\nshapes: [{id: a, box: [1, 1, 1]}]\n");
  expect_bad_input("init a.yaml", {"'a.yaml' is a sequence already"});
  expect_bad_input("init .", {"'.' is a folder"});
  write("noise.glb", std::string("\x01\xfe\x20\x7f", 4));
  expect_bad_input("init noise.glb", {"noise.glb"});
  expect_bad_input("init", {"model"});
  expect_bad_input("init cube.obj --turntable 0", {"--turntable"});
  expect_bad_input("init cube.obj --policy hold", {"'--policy' is no option of init"});
}

}  // namespace
}  // namespace talisman
