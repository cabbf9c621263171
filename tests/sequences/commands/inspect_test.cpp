// SPDX-License-Identifier: Apache-2.0
// `talisman inspect`: what is asked of it, and bad input in one line.
#include <string>

#include "tests/sequences/commands/tool.h"

namespace talisman {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

using Inspect = Tool;

TEST_F(Inspect, PartsOfAModelAreListedAndPictured) {
  const Outcome outcome = run("inspect cube.obj --parts");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output,
              AllOf(HasSubstr("1 part, 12 polygons, 1 layer\n"), HasSubstr("2 x 2 x 2 m along x, y and z"),
                    HasSubstr("from (-1, -1, -1) to (1, 1, 1)"), HasSubstr("out/cube-parts.png"),
                    HasSubstr("begin with the id of the model: 'cube/")));
  EXPECT_THAT(outcome.output, Not(HasSubstr("ground"))) << "it is not in the file";
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/cube-parts.png"));
}

TEST_F(Inspect, PartsAsJson) {
  const Outcome outcome = run("inspect carousel --parts --json --out a/b.png 2> /dev/null");
  ASSERT_EQ(outcome.exit_code, 0);
  const nlohmann::json json = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(json["schema"], "talisman.parts/1");
  EXPECT_EQ(json["picture"], "a/b.png");
  EXPECT_GT(json["parts"].size(), 5u);
  for (const nlohmann::json& part : json["parts"]) EXPECT_LT(part["node"], json["nodes"].size());
  EXPECT_TRUE(std::filesystem::exists(folder_ / "a/b.png"));
}

TEST_F(Inspect, BadInputIsOneLine) {
  std::filesystem::create_directories(folder_ / "empty");
  for (const std::string command : {"inspect", "render", "plan", "init", "explain --frame 1"})
    expect_bad_input(command + " empty", {"'empty' is a folder"});
  expect_bad_input("inspect nothing.glb --parts", {"nothing.glb"});
  expect_bad_input("inspect carousal --parts", {"did you mean 'carousel'"});
  expect_bad_input("inspect cube.obj --format tum",
                   {"--format, --joint, --fps and --scale", "must come with --motion"});
  write("letters.tum", "0 0 0 0 0 0 0 1\nnothing\n");
  expect_bad_input("inspect --motion letters.tum",
                   {"letters.tum:2: has 1 words, rule: t tx ty tz qx qy qz qw"});
  expect_bad_input("inspect --motion letters.tum --format tim",
                   {"--format is 'tim', rule: one of tum, euroc"});
  expect_bad_input("inspect cube.obj --parts --order",
                   {"--parts, --cells, --order, --factoring and --motion"});
  expect_bad_input("inspect cube.obj --out a.png", {"--out", "--parts"});
  expect_bad_input("inspect cube.obj --parts --out a.jpg", {"--out is 'a.jpg'", ".png"});
  expect_bad_input("inspect cube.obj --cycles keep", {"--cycles", "--order"});
  expect_bad_input("inspect cube.obj --order --cycles turn", {"--cycles is 'turn'", "merge, keep"});
  expect_bad_input("inspect", {"SEQUENCE", "MODEL", "--profile"});
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out")) << "nothing was written";
}

TEST_F(Inspect, FramesAndLayersThatAreNotThereAreOneLine) {
  expect_bad_input("render cube.obj --frames 470-480", {"--frames", "B <= 479"});
  expect_bad_input("explain cube.obj --frame 480", {"--frame is 480", "at most 479"});
  expect_bad_input("explain cube.obj --frame 3 --layer grond --size 64x48",
                   {"--layer is 'grond'", "did you mean 'ground'"});
  expect_bad_input("render cube.obj --resume --audit 3", {"--audit", "--resume"});
  expect_bad_input("render cube.obj --policy direct --compression 85", {"--compression", "direct"});
}

}  // namespace
}  // namespace talisman
