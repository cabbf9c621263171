// SPDX-License-Identifier: Apache-2.0
// What if a layer were split? What is said is what a sequence that is written so by hand does.
#include <string>

#include "tests/sequences/commands/tool.h"

namespace talisman {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::ordered_json;

constexpr const char* kScene = R"(
frames: 12
display: [96, 72]
shapes:
  - {id: floor, plane: [6, 6], position: [0, -1, 0], color: "#6f8f57"}
  - {id: still, box: [1, 1, 1], position: [-1.2, 0, 0]}
  - {id: turns, box: [1, 1, 0.2], position: [1.2, 0, 0], spin: {axis: [0, 1, 0], deg_per_s: 90}}
  - {id: rises, sphere: 0.6, flight: [{t: 0, position: [0, 0, 1]}, {t: 0.5, position: [0, 1, 1]}]}
camera: {fov_deg: 45, near_m: 0.5, far_m: 50, position: [0, 1, 6], look_at: [0, 0, 0]}
lights: [{kind: ambient, intensity: 1}]
regulator: {policy: threshold, geometric_px: 1}
)";

class Split : public Tool {
 protected:
  void SetUp() override {
    Tool::SetUp();
    write("whole.yaml", std::string(kScene) +
                            "layers: [{name: floor, parts: [floor], group: background}, "
                            "{name: bodies, parts: [still, turns, rises]}]\n");
  }
  /// "renders" of the layers in the summary of a plan.
  int renders(const std::string& sequence) const {
    const Outcome planned = run("plan " + sequence + " --out p --force --progress none");
    EXPECT_EQ(planned.exit_code, 0) << planned.output;
    int sum = 0;
    const Json summary = Json::parse(read("p/summary.json"));
    for (const Json& layer : summary["layers"]) sum += layer["renders"].get<int>();
    return sum;
  }
  std::string row_of(const std::string& text, const std::string& name) const {
    const std::size_t at = text.find("\n" + name);
    return at == std::string::npos ? "" : text.substr(at + 1, text.find('\n', at + 1) - at - 1);
  }
};

TEST_F(Split, SaysWhatTheSequenceWithLayersOfItsPartsDoes) {
  write("apart.yaml",
        std::string(kScene) +
            "layers: [{name: floor, parts: [floor], group: background}, {name: still, parts: [still]}, "
            "{name: turns, parts: [turns]}, {name: rises, parts: [rises]}]\n");
  const Outcome outcome = run("plan whole.yaml --split bodies");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const std::string row = row_of(outcome.output, "renders");
  EXPECT_THAT(row, HasSubstr(" " + std::to_string(renders("whole.yaml")) + " ")) << outcome.output;
  EXPECT_THAT(row, HasSubstr(" " + std::to_string(renders("apart.yaml")) + " ")) << outcome.output;
  // What stands still is drawn once, as by hand: 12 triangles of a box.
  EXPECT_THAT(row_of(outcome.output, "  still"), ::testing::ContainsRegex("still +12 +1 +0\\."))
      << outcome.output;
  EXPECT_TRUE(files_in("out").empty());
}

// The author's order holds for every piece: two bodies that meet are not merged.
TEST_F(Split, PairsOfTheOrderHoldForThePieces) {
  const std::string meeting = R"(
frames: 4
display: [96, 72]
shapes:
  - {id: wall, box: [1, 1, 1]}
  - {id: ball, sphere: 1.2, position: [0.3, 0, 0.3]}
  - {id: far, box: [1, 1, 1], position: [5, 0, -9]}
camera: {position: [0, 0, 6], look_at: [0, 0, 0]}
lights: [{kind: ambient}]
)";
  write("free.yaml", meeting + "layers: [{name: ball, parts: [ball]}, {name: scene, parts: [wall, far]}]\n");
  write("ordered.yaml", meeting +
                            "layers: [{name: ball, parts: [ball]}, {name: scene, parts: [wall, far]}]\n"
                            "order: [{behind: scene, front: ball}]\n");
  const Outcome free = run("plan free.yaml --split scene"), ordered = run("plan ordered.yaml --split scene");
  EXPECT_THAT(row_of(free.output, "  wall"), ::testing::ContainsRegex("wall +12 +1 +1 ")) << free.output;
  EXPECT_THAT(row_of(ordered.output, "  wall"), ::testing::ContainsRegex("wall +12 +1  ")) << ordered.output;
}

TEST_F(Split, WhatCannotBeSplitIsRefused) {
  expect_bad_input("plan whole.yaml --split boddies", {"whole.yaml", "'boddies'", "did you mean 'bodies'"});
  expect_bad_input("plan whole.yaml --split floor", {"whole.yaml", "'floor' has 1 part", "rule: 2 to 64"});
  expect_bad_input("plan whole.yaml --split bodies --out x", {"--out", "--split"});
  EXPECT_THAT(run("render --help").output, Not(HasSubstr("--split")));
}

}  // namespace
}  // namespace talisman
