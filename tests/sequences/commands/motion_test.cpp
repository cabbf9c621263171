// SPDX-License-Identifier: Apache-2.0
// `talisman motion`: groups, words and what a plan would draw.
#include "tests/sequences/commands/tool.h"

namespace talisman {
namespace {

using ::testing::HasSubstr;

class Motion : public Tool {
 protected:
  void SetUp() override {
    Tool::SetUp();
    // A wheel of two parts that turns, a box that stands, and one that jumps once, at frame 5 of 12.
    write("wheel.yaml",
          "frames: 12\nfps: 10\ndisplay: [160, 120]\nshapes:\n"
          "  - {id: hub, sphere: 0.5, spin: {axis: [0, 0, 1], deg_per_s: 90}}\n"
          "  - {id: spoke, box: [2, 0.1, 0.1], carried_by: hub}\n"
          "  - {id: still, box: [1, 1, 1], position: [-2, 0, 0]}\n"
          "camera: {fov_deg: 45, near_m: 1, far_m: 50, position: [0, 0, 10], look_at: [0, 0, 0]}\n"
          "layers: [{name: all, parts: [\"*\"]}]\n");
  }
};

TEST_F(Motion, PartsThatMoveAsOneAreAGroup) {
  const Outcome outcome = run("motion wheel.yaml --lookahead 8 --geometric-px 0.1 --json 2> /dev/null");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const nlohmann::json json = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(json["schema"], "talisman.motion/1");
  ASSERT_EQ(json["groups"].size(), 2u);
  EXPECT_EQ(json["groups"][0]["parts"].size(), 2u);
  const nlohmann::json& still = json["groups"][1]["parts"][0];
  EXPECT_EQ(still["words"], (std::vector<std::string>{"#.......", "#..."}));
  EXPECT_EQ(still["runs"], 2);
  EXPECT_EQ(still["draws"], 2);
  EXPECT_EQ(json["groups"][0]["parts"][1]["words"][0], "########");
  EXPECT_EQ(json["buffers"], 4);
}

TEST_F(Motion, TextAndCsvSayTheSame) {
  const Outcome text = run("motion wheel.yaml --lookahead 4 --tree-k 4 --geometric-px 0.1");
  ASSERT_EQ(text.exit_code, 0) << text.output;
  EXPECT_THAT(text.output, HasSubstr("slices of 4 (tree-k 4), delta 0.1 px, 3 parts in 2 groups"));
  EXPECT_THAT(text.output, HasSubstr("#...|#...|#..."));
  EXPECT_THAT(text.output, HasSubstr("joins a slice     4 each frame, 4 by copies, 3 in place"));
  const Outcome csv = run("motion wheel.yaml --lookahead 4 --tree-k 4 --geometric-px 0.1 --csv 2> /dev/null");
  EXPECT_THAT(csv.output, HasSubstr("part,group,primitive,first_frame,word,runs,draws\n"));
  EXPECT_THAT(csv.output, HasSubstr("\"still\",1,block,8,#...,1,1\n"));
}

TEST_F(Motion, TheLayersOfAModelReadBack) {
  const Outcome outcome = run("motion wheel.yaml --yaml 2> /dev/null");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("hub"));
  std::string file = read("wheel.yaml");
  file.erase(file.find("layers:"));
  write("again.yaml", file + outcome.output.substr(outcome.output.find("layers:")));
  const Outcome plan = run("plan again.yaml --progress none");
  EXPECT_EQ(plan.exit_code, 0) << plan.output;
}

TEST_F(Motion, BadInputIsOneLine) {
  expect_bad_input("motion", {"SEQUENCE"});
  expect_bad_input("motion carousal", {"did you mean 'carousel'"});
  expect_bad_input("motion wheel.yaml --lookahead 12", {"lookahead is 12", "power of tree_k 2"});
  expect_bad_input("motion wheel.yaml --lookahead 8192", {"1 to 4096"});
  expect_bad_input("motion wheel.yaml --tree-k 1", {"tree_k is 1", "at least 2"});
  expect_bad_input("motion wheel.yaml --geometric-px -1", {"--geometric-px", "at least 0"});
  expect_bad_input("motion wheel.yaml --geometric-px inf", {"inf"});
  expect_bad_input("motion wheel.yaml --motion-norm max", {"--motion-norm is 'max'", "axis, euclid"});
  expect_bad_input("motion wheel.yaml --json --csv", {"--json, --csv and --yaml"});
  expect_bad_input("motion wheel.yaml --size 10", {"--size is '10'"});
}

}  // namespace
}  // namespace talisman
