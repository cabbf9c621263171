// SPDX-License-Identifier: Apache-2.0
// --latency-ms and --predict as settings of a run: planned as rendered, in parts, interrupted, refused where they mean nothing.
#include <fstream>

#include "tests/sequences/commands/tool.h"

namespace talisman {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A camera that flies past two boxes, one of which moves, with a display that hangs on it.
constexpr const char* kFlight =
    "frames: 24\nfps: 30\ndisplay: [96, 72]\n"
    "shapes:\n  - {id: head, box: [0.02, 0.02, 0.02], flight: [{t: 0, position: [-2, 1, 6], target: [0, 0.5, "
    "0]}, "
    "{t: 0.4, position: [0, 1.2, 5], target: [1, 0.5, 0]}, {t: 1, position: [2, 1, 6], target: [0, 0, 0]}]}\n"
    "  - {id: dial, box: [0.1, 0.05, 0.01], carried_by: head, position: [0.3, 0.2, -1]}\n"
    "  - {id: near, box: [1, 1, 1], position: [0.5, 0.5, 1]}\n"
    "  - {id: far, box: [2, 3, 1], flight: [{t: 0, position: [-2, 1, -4], target: [-2, 1, -9]}, "
    "{t: 1, position: [1, 1, -4], target: [1, 1, -9]}]}\n"
    "  - {id: floor, plane: [20, 20], segments: 4}\n"
    "camera: {carried_by: head, position: [0, 0, -0.05], fov_deg: 60, near_m: 0.05, far_m: 60}\n"
    "layers:\n  - {name: floor, parts: [floor], group: background}\n  - {name: head, parts: [head]}\n"
    "  - {name: near, parts: [near]}\n  - {name: far, parts: [far]}\n"
    "  - {name: dial, parts: [dial], group: foreground}\n";

class LateRuns : public Tool {
 protected:
  void SetUp() override {
    Tool::SetUp();
    write("flight.yaml", kFlight);
  }
  void ok(const std::string& arguments) const {
    const Outcome outcome = run(arguments + " --quiet --no-report");
    EXPECT_EQ(outcome.exit_code, 0) << arguments << "\n" << outcome.output;
  }
  std::vector<double> of_layer(const std::string& out, const std::string& layer, const char* column) const {
    std::vector<double> values;
    for (const std::string& line : lines(out + "/decisions.jsonl")) {
      const auto row = nlohmann::json::parse(line);
      if (row["layer"] == layer && row.contains(column) && row[column].is_number())
        values.push_back(row[column]);
    }
    return values;
  }
  static double largest(const std::vector<double>& values) {
    return values.empty() ? -1 : *std::max_element(values.begin(), values.end());
  }
};

TEST_F(LateRuns, ArePlannedAsTheyAreRendered) {
  const std::string late = " flight.yaml --latency-ms 40,10 --predict kalman";
  ok("plan" + late + " --out plan");
  ok("render" + late + " --out render");
  EXPECT_EQ(read("plan/decisions.jsonl"), read("render/decisions.jsonl"));
  const auto summary = nlohmann::json::parse(read("render/summary.json"));
  EXPECT_GT(summary["latency"]["drawn_turn_max_deg"], 0);
  EXPECT_LT(summary["latency"]["shown_turn_mean_deg"], summary["latency"]["drawn_turn_mean_deg"]);
  const auto frame = nlohmann::json::parse(lines("render/frames.jsonl")[12]);
  EXPECT_GT(frame["latency"]["true_px"], 0);
}

TEST_F(LateRuns, WithoutTheOptionHaveNoneOfIt) {
  ok("render flight.yaml --out plain");
  ok("render flight.yaml --latency-ms 0 --out zero");
  ok("render flight.yaml --latency-ms 50 --predict known --out known");
  for (const char* file : {"decisions.jsonl", "frames.jsonl"}) {
    EXPECT_EQ(read(std::string("plain/") + file), read(std::string("zero/") + file));
    EXPECT_EQ(read(std::string("plain/") + file), read(std::string("known/") + file));
  }
  EXPECT_THAT(read("plain/summary.json"), Not(HasSubstr("\"latency\"")));
  EXPECT_THAT(read("plain/decisions.jsonl"), Not(HasSubstr("true_px")));
}

/// The nearer to now what is known, the less is off; a last warp mends; the display that hangs on the head stays.
TEST_F(LateRuns, AreOffByWhatIsOld) {
  ok("plan flight.yaml --policy reference --latency-ms 50 --out held");
  ok("plan flight.yaml --policy reference --latency-ms 50 --predict linear --out linear");
  ok("plan flight.yaml --policy reference --latency-ms 50,0 --out warped");
  const double held = largest(of_layer("held", "near", "true_px"));
  EXPECT_GT(held, 2);
  EXPECT_LT(largest(of_layer("linear", "near", "true_px")), held / 1.5);
  EXPECT_LT(largest(of_layer("warped", "near", "true_px")), held / 3);
  for (const char* out : {"held", "linear", "warped"})
    EXPECT_LT(largest(of_layer(out, "dial", "true_px")), 1e-6) << out;
}

TEST_F(LateRuns, InPartsAreTheBytesOfOneRun) {
  for (const std::string policy : {"threshold", "lookahead", "direct"}) {
    const std::string words =
        "render flight.yaml --policy " + policy + " --latency-ms 40,10 --predict linear --out ";
    ok(words + "one-" + policy);
    for (const char* shard : {"1/3", "0/3", "2/3"}) ok(words + "many-" + policy + " --shard " + shard);
    EXPECT_EQ(run("merge many-" + policy + " --quiet").exit_code, 0);
    for (const char* file : {"decisions.jsonl", "frames.jsonl", "summary.json", "frames/0017.png"})
      EXPECT_EQ(read("one-" + policy + "/" + file), read("many-" + policy + "/" + file))
          << policy << " " << file;
    ok(words + "some-" + policy + " --frames 10-17");
    EXPECT_EQ(read("one-" + policy + "/frames/0017.png"), read("some-" + policy + "/frames/0017.png"));
  }
}

TEST_F(LateRuns, GoOnWhereTheyWereStopped) {
  const std::string words =
      "render flight.yaml --latency-ms 40,10 --predict kalman --quiet --no-report --out ";
  ok(words + "whole");
  run_and_signal(words + "stopped", "stopped/frames/0005.png", SIGTERM);
  ok(words + "stopped --resume");
  EXPECT_EQ(frame_hashes("whole"), frame_hashes("stopped"));
  expect_bad_input("render flight.yaml --latency-ms 40,20 --predict kalman --resume --out whole",
                   {"latency_warp_ms was 10.0, is 20.0"});
}

TEST_F(LateRuns, AreSettingsOfASequenceToo) {
  write("late.yaml", std::string(kFlight) +
                         "regulator: {latency_ms: 40, latency_warp_ms: 10, latency_predict: kalman, "
                         "kalman_turn_deg: 0.1}\n");
  ok("plan late.yaml --out file");
  const auto settings = nlohmann::json::parse(read("file/run.json"));
  EXPECT_EQ(nlohmann::json::parse(lines("file/frames.jsonl")[9]).contains("latency"), true);
  ok("plan late.yaml --latency-ms 0 --out none");
  EXPECT_EQ(nlohmann::json::parse(lines("none/frames.jsonl")[9]).contains("latency"), false);
  write("wrong.yaml", std::string(kFlight) + "regulator: {latency_ms: 10, latency_warp_ms: 20}\n");
  expect_bad_input("plan wrong.yaml", {"wrong.yaml:", "latency_warp_ms at most latency_ms"});
  write("wrong.yaml", std::string(kFlight) + "regulator: {kalman_jerk_m: 0}\n");
  expect_bad_input("plan wrong.yaml", {"wrong.yaml:", "kalman_jerk_m"});
}

TEST_F(LateRuns, WhatMeansNothingIsRefused) {
  expect_bad_input("plan flight.yaml --latency-ms soon",
                   {"--latency-ms is 'soon', must be RENDER or RENDER,WARP"});
  expect_bad_input("plan flight.yaml --latency-ms 20,", {"--latency-ms is '20,'"});
  expect_bad_input("plan flight.yaml --latency-ms 20,5,1", {"--latency-ms is '20,5,1'"});
  expect_bad_input("plan flight.yaml --latency-ms -1", {"latency_ms is -1, must be from 0 to 1000"});
  expect_bad_input("plan flight.yaml --latency-ms nan", {"--latency-ms is 'nan'"});
  expect_bad_input("plan flight.yaml --latency-ms 1e9", {"must be from 0 to 1000"});
  expect_bad_input("plan flight.yaml --latency-ms 20,30", {"latency_warp_ms is 30", "which is 20"});
  expect_bad_input("plan flight.yaml --predict held",
                   {"--predict is 'held'", "must be lookahead", "--latency-ms"});
  expect_bad_input("plan flight.yaml --latency-ms 0 --predict kalman", {"--predict is 'kalman'"});
  expect_bad_input("plan flight.yaml --latency-ms 20 --predict psychic",
                   {"--predict is 'psychic'", "known, held"});
}

}  // namespace
}  // namespace talisman
