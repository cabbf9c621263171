// SPDX-License-Identifier: Apache-2.0
// Words of policy predictive and of frames that last, as the tool takes and refuses them.
#include <cstdio>
#include <sstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/sequences/commands/tool.h"

namespace talisman {
namespace {

class PredictiveWords : public Tool {
 protected:
  void SetUp() override {
    Tool::SetUp();
    write("swarm.yaml",
          "name: swarm\nframes: 14\nfps: 30\ndisplay: [80, 60]\n"
          "swarm: {count: 30, shape: block, cube: 8, moving: 40, translation: 0.6, seed: 3}\n"
          "camera: {position: [0, 0, 14], look_at: [0, 0, 0]}\n");
  }
};

TEST_F(PredictiveWords, FramesThatLastAreOfTwoPolicies) {
  expect_bad_input("render swarm.yaml --accumulate 0", {"--accumulate is 0", "must be 1 to 256"});
  expect_bad_input("render swarm.yaml --policy direct --accumulate 257", {"--accumulate is 257", "1 to 256"});
  expect_bad_input("render swarm.yaml --accumulate 8",
                   {"--accumulate is 8", "'threshold'", "direct or predictive"});
  expect_bad_input("render swarm.yaml --policy predictive --lookahead 16 --accumulate many",
                   {"--accumulate"});
}

TEST_F(PredictiveWords, FramesThatLastCanBePlannedToo) {
  expect_bad_input("plan swarm.yaml --accumulate 8", {"--accumulate is 8", "direct or predictive"});
  const Outcome outcome =
      run("plan swarm.yaml --policy predictive --lookahead 16 --accumulate 4 --progress none");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
}

TEST_F(PredictiveWords, IntervalsAndSlicesAreOfPolicyPredictive) {
  expect_bad_input("plan swarm.yaml --intervals data", {"--intervals is no option of policy threshold"});
  expect_bad_input("plan swarm.yaml --adaptive on", {"--adaptive is no option of policy threshold"});
  expect_bad_input("plan swarm.yaml --policy predictive --intervals free",
                   {"--intervals is 'free'", "fixed, data"});
  expect_bad_input("plan swarm.yaml --policy predictive --adaptive perhaps", {"--adaptive is 'perhaps'"});
  expect_bad_input("plan swarm.yaml --policy predictive --lookahead 256 --intervals data",
                   {"lookahead is 256", "at most 128 where intervals is data"});
  write("bad.yaml", read("swarm.yaml") + "regulator: {policy: predictive, intervals: 3}\n");
  expect_bad_input("plan bad.yaml", {"bad.yaml:7", "intervals"});
}

TEST_F(PredictiveWords, EdgesThatAJoinMayDarkenAreSaidWithTheirShare) {
  const std::string render = "render swarm.yaml --no-report --format none --force ";
  const Outcome many = run(render + "--policy predictive --out many --samples 16");
  EXPECT_EQ(many.exit_code, 0);
  std::int64_t edges = 0, frames = 0;
  std::istringstream lines(read("many/frames.jsonl"));
  for (std::string line; std::getline(lines, line); ++frames)
    edges += nlohmann::json::parse(line).at("predictive").at("edge_pixels").get<std::int64_t>();
  EXPECT_GT(edges, 0);
  char share[32];
  std::snprintf(share, sizeof share, "%.2f %%", 100.0 * static_cast<double>(edges) / (80.0 * 60 * frames));
  EXPECT_THAT(many.output, testing::HasSubstr("warning: " + std::string(share) +
                                              " of the pixels shown are covered in part"));
  for (const std::string& words :
       {render + "--policy predictive --out one --samples 1", render + "--out direct --policy direct"})
    EXPECT_THAT(run(words).output, testing::Not(testing::HasSubstr("covered in part"))) << words;
  EXPECT_THAT(run("plan swarm.yaml --policy predictive --no-report").output,
              testing::Not(testing::HasSubstr("covered in part")));
}

// Where plans are dropped a frame's slice follows from those before it: it is the same in a part of the run.
TEST_F(PredictiveWords, PartsOfARunAreThoseOfTheWholeWhateverIsExpected) {
  for (const std::string words :
       {"--adaptive on", "--predict linear --geometric-px 0.4",
        "--adaptive on --predict linear --intervals data", "--accumulate 3 --samples 1 --geometric-px 0"}) {
    const std::string render =
        "render swarm.yaml --policy predictive --lookahead 8 --progress none --no-report --force " + words +
        " ";
    ASSERT_EQ(run(render + "--out whole").exit_code, 0) << words;
    ASSERT_EQ(run(render + "--out part --frames 9-11").exit_code, 0) << words;
    ASSERT_EQ(run(render + "--out one --threads 1").exit_code, 0) << words;
    const std::vector<std::string> whole = frame_hashes("whole");
    ASSERT_EQ(whole.size(), 14u);
    EXPECT_EQ(frame_hashes("part"), std::vector<std::string>(whole.begin() + 9, whole.begin() + 12)) << words;
    EXPECT_EQ(frame_hashes("one"), whole) << words;
  }
}

TEST_F(PredictiveWords, SurprisesAreCountedAndSaid) {
  const Outcome outcome =
      run("plan swarm.yaml --policy predictive --lookahead 8 --adaptive on --progress none --out p");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, ::testing::HasSubstr("the plan was dropped, and the frame drawn whole"));
  EXPECT_THAT(read("p/decisions.jsonl"), ::testing::HasSubstr("surprise, the plan is dropped"));
  const auto summary = nlohmann::json::parse(read("p/summary.json"));
  EXPECT_GT(summary["predictive"]["surprises"], 0);
  const Outcome calm = run("plan swarm.yaml --policy predictive --lookahead 8 --progress none --out q");
  EXPECT_THAT(calm.output, ::testing::Not(::testing::HasSubstr("surprise")));
}

}  // namespace
}  // namespace talisman
