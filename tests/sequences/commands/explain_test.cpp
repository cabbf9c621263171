// SPDX-License-Identifier: Apache-2.0
// Why was it drawn in this frame? What is said is what decisions.jsonl says, and what is promised is what a plan shows.
#include <map>
#include <string>

#include "tests/sequences/commands/tool.h"

namespace talisman {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::ordered_json;

class Explain : public Tool {
 protected:
  void SetUp() override {
    Tool::SetUp();
    write("passing.yaml", kPassing);
  }

  /// The decisions of a plan about one layer, by frame.
  std::map<int, Json> decisions(const std::string& options, const std::string& layer) const {
    const Outcome planned = run("plan passing.yaml --out p --force --progress none " + options);
    EXPECT_EQ(planned.exit_code, 0) << planned.output;
    std::map<int, Json> of_layer;
    for (const std::string& line : lines("p/decisions.jsonl"))
      if (const Json json = Json::parse(line); json["layer"] == layer) of_layer[json["frame"]] = json;
    return of_layer;
  }
  static int first_frame(const std::map<int, Json>& decisions, const std::string& reason) {
    for (const auto& [frame, json] : decisions)
      if (json["reason"].get<std::string>().rfind(reason, 0) == 0) return frame;
    return -1;
  }
  std::string explained(int frame, const std::string& options) const {
    const Outcome outcome = run("explain passing.yaml --frame " + std::to_string(frame) + " " + options);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    return outcome.output;
  }
};

TEST_F(Explain, SaysWhatTheDecisionSaysToTheDigit) {
  const auto ball = decisions("--geometric-px 2", "ball");
  const int frame = first_frame(ball, "geometric");
  ASSERT_GE(frame, 0);
  const Json& line = ball.at(frame);
  const std::string text = explained(frame, "--geometric-px 2 --layer ball");
  EXPECT_THAT(text, HasSubstr(line["reason"].get<std::string>()));
  for (const char* number : {"warp_geometric_px", "magnification", "minification", "anisotropy"})
    EXPECT_THAT(text, HasSubstr(line["fiducials"][number].dump())) << number;
  EXPECT_THAT(text, HasSubstr("beyond 2.0"));
  EXPECT_EQ(files_in("out/passing-explain").size(), 1u);
  // The same from the folder, which has no pictures.
  const Outcome of_folder = run("explain p --frame " + std::to_string(frame) + " --layer ball");
  EXPECT_EQ(of_folder.exit_code, 0) << of_folder.output;
  EXPECT_THAT(of_folder.output, HasSubstr(line["fiducials"]["warp_geometric_px"].dump()));
  EXPECT_THAT(of_folder.output, Not(HasSubstr(".png")));
}

TEST_F(Explain, RendersBeforeAndAfterAreThoseOfThePlan) {
  const auto ball = decisions("--geometric-px 2", "ball");
  const int frame = first_frame(ball, "geometric");
  int before = -1, after = -1;
  for (const auto& [k, json] : ball) {
    if (json["decision"] != "rerender") continue;
    if (k < frame) before = k;
    if (k > frame && after < 0) after = k;
  }
  ASSERT_TRUE(before >= 0 && after > frame);
  const std::string text = explained(frame, "--geometric-px 2 --layer ball");
  EXPECT_THAT(text, HasSubstr("drawn before     frame " + std::to_string(before) + "\n"));
  EXPECT_THAT(text, HasSubstr("drawn next       frame " + std::to_string(after) + "\n"));
}

TEST_F(Explain, ThresholdAtWhichItIsKeptIsProved) {
  const auto ball = decisions("--geometric-px 2", "ball");
  const int frame = first_frame(ball, "geometric");
  EXPECT_THAT(explained(frame, "--geometric-px 2 --layer ball"),
              HasSubstr("on (planned: kept at 1 % looser, drawn at 1 % stricter)"));
  // What is kept says when it would have been drawn.
  int kept = -1;
  for (const auto& [k, json] : decisions("--geometric-px 40", "ball"))
    if (json["decision"] == "reuse" && json["geometric_px"] > 0.1) kept = k;
  ASSERT_GE(kept, 0);
  EXPECT_THAT(explained(kept, "--geometric-px 40 --layer ball"),
              HasSubstr("threshold        drawn below geometric_px "));
}

TEST_F(Explain, MergedLayersNameTheSpriteTheyAreIn) {
  const auto ball = decisions("--geometric-px 2", "ball");
  const int frame = first_frame(ball, "merged into ");
  ASSERT_GE(frame, 0);
  const std::string text = explained(frame, "--geometric-px 2 --layer ball");
  const std::size_t at = text.find("--layer '");
  ASSERT_NE(at, std::string::npos) << text;
  const std::string merged = text.substr(at + 9, text.find('\'', at + 9) - at - 9);
  EXPECT_THAT(explained(frame, "--geometric-px 2 --layer '" + merged + "'"),
              HasSubstr("layer '" + merged + "': "));
}

TEST_F(Explain, EveryLayerOfEveryFewFramesIsExplained) {
  const auto plan = run("plan passing.yaml --out p --progress none");
  ASSERT_EQ(plan.exit_code, 0);
  int explained_layers = 0;
  for (const std::string& text : lines("p/decisions.jsonl")) {
    const Json line = Json::parse(text);
    if (line["frame"].get<int>() % 13 != 0) continue;
    ++explained_layers;
    const std::string layer = line["layer"];
    EXPECT_THAT(explained(line["frame"], "--layer '" + layer + "'"), HasSubstr("layer '" + layer + "': "))
        << text;
  }
  EXPECT_GT(explained_layers, 10);
}

TEST_F(Explain, WithoutALayerItIsALineEach) {
  const std::string text = explained(3, "");
  for (const char* layer : {"wall ", "ball ", "wall/", "shadow map of lamp"})
    EXPECT_THAT(text, HasSubstr(layer));
  EXPECT_TRUE(files_in("out").empty());
}

TEST_F(Explain, BadInputIsOneLine) {
  expect_bad_input("explain passing.yaml", {"--frame", "required"});
  expect_bad_input("explain passing.yaml --frame 40", {"--frame is 40", "at most 39"});
  expect_bad_input("explain passing.yaml --frame -1", {"--frame is -1", "at least 0"});
  expect_bad_input("explain passing.yaml --frame 3 --layer bal", {"'bal'", "did you mean 'ball'"});
  run_shell("mkdir empty");
  expect_bad_input("explain empty --frame 3", {"'empty' is a folder"});
  run_shell("mkdir odd && echo '{}' > odd/decisions.jsonl");
  for (const char* text : {"[1]", "{\"version\": 2, \"settings\": {}}", "{\"settings\": 3}"}) {
    write("odd/run.json", text);
    expect_bad_input("explain odd --frame 3", {"odd: "});
  }
  ASSERT_EQ(run("plan passing.yaml --out p --frames 0-9 --progress none").exit_code, 0);
  expect_bad_input("explain p --frame 10", {"no frame 10", "the last one is 9"});
  expect_bad_input("explain p --frame 3 --geometric-px 2", {"--geometric-px", "p is one already"});
  run_shell("sed -i 's/\"version\": \"[^\"]*\"/\"version\": \"0.0.1\"/' p/run.json");
  expect_bad_input("explain p --frame 3", {"version 0.0.1"});
  run_shell("echo '{' >> p/decisions.jsonl");
  expect_bad_input("explain p --frame 3", {"p"});
}

TEST_F(Explain, PoliciesWithoutThresholdsSayWhatDecides) {
  EXPECT_THAT(explained(5, "--policy hold --layer ball"),
              HasSubstr("threshold        no threshold decides about it in this frame"));
  EXPECT_THAT(explained(2, "--policy reference --layer ball"), HasSubstr("policy: reference"));
}

}  // namespace
}  // namespace talisman
