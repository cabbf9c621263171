// SPDX-License-Identifier: Apache-2.0
// What `talisman tune` promises must be what a run with its lines in the file measures.
#include <algorithm>
#include <cmath>
#include <string>

#include "tests/sequences/commands/tool.h"

namespace talisman {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Json = nlohmann::ordered_json;

/// A body that passes before a wall and one that turns: they want different thresholds.
constexpr const char* kShapes =
    "frames: 12\nfps: 6\ndisplay: [120, 90]\n"
    "shapes:\n  - {id: wall, box: [8, 4, 0.5], color: [0.6, 0.5, 0.4], position: [0, 0, -6]}\n"
    "  - {id: ball, sphere: 1, color: [0.8, 0.2, 0.1], flight: [{t: 0, position: [3, 0, 0], target: [-100, "
    "0, "
    "0]}, {t: 2, position: [-3, 1, 1], target: [-100, 0, 0]}]}\n"
    "  - {id: box, box: [1, 1, 1], color: [0.1, 0.4, 0.7], position: [0, -1.5, 2], spin: {axis: [0, 1, 0], "
    "deg_per_s: 40}}\n"
    "camera: {fov_deg: 60, near_m: 1, far_m: 100, flight: [{t: 0, position: [2, 1, 9], target: [0, 0, 0]}, "
    "{t: "
    "2, position: [-1, 1, 8], target: [0, 0, 0]}]}\n"
    "lights:\n  - {kind: ambient, color: [0.3, 0.3, 0.3]}\n"
    "  - {kind: directional, color: [0.7, 0.7, 0.7], direction: [-1, -1, -1]}\n";

class Tune : public Tool {
 protected:
  void SetUp() override {
    Tool::SetUp();
    write("bodies.yaml", with_layers(""));
  }
  /// The file, `regulator` before its layers; `answer` says what the layers prefer.
  static std::string with_layers(const std::string& regulator, const Json& answer = {}) {
    std::string text = kShapes + regulator + "layers:\n";
    for (const std::string name : {"wall", "ball", "box"}) {
      text += "  - name: " + name + "\n    parts: [" + name + "]\n";
      for (const Json& layer : answer.is_null() ? Json::array() : answer["layers"])
        if (layer["layer"] == name)
          text +=
              "    preferences: {importance: {geometric: " + layer["importance_geometric"].dump() + "}}\n";
    }
    return text;
  }
  Json tuned(const std::string& options, int exit_code = 0) const {
    const Outcome outcome = run("tune bodies.yaml --progress none --out t " + options);
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.output;
    return Json::parse(read("t/tune.json"));
  }
  /// The quality against reference of every frame, of the file with the lines that were printed.
  std::vector<double> pasted(const Json& answer, const char* metric) const {
    const std::string yaml = answer["yaml"];
    write("pasted.yaml", with_layers(yaml.substr(0, yaml.find("layers:")), answer));
    const Outcome outcome = run("render pasted.yaml --quality --format none --progress none --out p --force");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    std::vector<double> values;
    for (const std::string& line : lines("p/frames.jsonl")) {
      const Json value = Json::parse(line)["quality"]["reuse"][metric];
      values.push_back(value.is_null() ? HUGE_VAL : value.get<double>());
    }
    return values;
  }
};

TEST_F(Tune, WhatIsPastedHoldsThePromiseToTheDigit) {
  const Json report = tuned("--flip 0.012");
  for (const char* which : {"one_for_all", "per_layer"}) {
    const Json& answer = report[which];
    if (answer.is_null()) continue;
    const std::vector<double> flip = pasted(answer, "flip");
    ASSERT_EQ(flip.size(), 12u);
    EXPECT_DOUBLE_EQ(*std::max_element(flip.begin(), flip.end()), answer["worst_flip"].get<double>())
        << which;
    EXPECT_LE(answer["worst_flip"], 0.012);
    EXPECT_EQ(answer["frames_drawn"], 12);
    // The plan's cost is that of the run, too.
    double ms = 0;
    for (const std::string& line : lines("p/frames.jsonl"))
      ms += Json::parse(line)["modelled_drawing_ms"].get<double>();
    EXPECT_NEAR(ms / 12, answer["mean_ms"].get<double>(), 1e-12);
  }
  EXPECT_LE(report["frames_drawn"], 120);
}

TEST_F(Tune, ThresholdsOfLayersAreCheaperAndHold) {
  const Json report = tuned("--psnr 36 --mean");
  ASSERT_FALSE(report["per_layer"].is_null());
  EXPECT_LT(report["per_layer"]["cost_share"], report["one_for_all"]["cost_share"]);
  ASSERT_FALSE(report["per_layer"]["layers"].empty());
  const std::vector<double> psnr = pasted(report["per_layer"], "psnr_db");
  double squared = 0;
  for (const double db : psnr) squared += std::pow(10, -db / 10) / 12;
  EXPECT_NEAR(-10 * std::log10(squared), report["per_layer"]["mean_psnr_db"].get<double>(), 1e-9);
  EXPECT_GE(report["per_layer"]["mean_psnr_db"], 36);
}

TEST_F(Tune, BudgetIsThatOfTheWorstFrameAndTheFinestThresholdWithinIt) {
  const Json report = tuned("--budget-ms 0.1 --frames 1-11");
  const double found = report["one_for_all"]["geometric_px"];
  EXPECT_LE(report["one_for_all"]["worst_ms"], 0.1);
  for (const Json& point : report["curve"])
    EXPECT_TRUE(point["geometric_px"] >= found || point["worst_ms"] > 0.1) << point.dump();
}

TEST_F(Tune, WhatCannotBeReachedIsSaidWithTheNearest) {
  const Outcome outcome = run("tune bodies.yaml --budget-ms 0.001 --progress none --out t");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("Not reached; nearest: "), HasSubstr("no threshold holds it"),
                                    HasSubstr("--frames 1-11 leaves it out")));
  EXPECT_FALSE(Json::parse(read("t/tune.json"))["one_for_all"]["holds"].get<bool>());
}

TEST_F(Tune, FlawlessIsReachedByReusingWhatIsIdentical) {
  EXPECT_EQ(tuned("--flip 0")["one_for_all"]["worst_flip"], 0);
}

TEST_F(Tune, BytesDoNotDependOnThreads) {
  tuned("--flip 0.02 --threads 1");
  const std::string one = read("t/tune.json"), csv = read("t/tune.csv");
  tuned("--flip 0.02 --threads 3");
  EXPECT_EQ(read("t/tune.json"), one);
  EXPECT_EQ(read("t/tune.csv"), csv);
  EXPECT_EQ(files_in("t"), (std::set<std::string>{"tune.csv", "tune.html", "tune.json", "tune-curve.csv",
                                                  "tune-curve.svg"}));
}

TEST_F(Tune, WhatWasFoundStaysWhenItIsStopped) {
  const Outcome outcome = run_and_signal(
      "tune bodies.yaml --flip 0.012 --size 1200x900 --progress none --out t", "t/truth", SIGINT);
  EXPECT_EQ(outcome.exit_code, 3) << outcome.output;
  EXPECT_FALSE(Json::parse(read("t/tune.json"))["complete"].get<bool>());
  EXPECT_FALSE(std::filesystem::exists(path("t/truth")));
}

TEST_F(Tune, GoalsThatMakeNoSenseAreRefused) {
  expect_bad_input("tune bodies.yaml", {"--flip, --psnr and --budget-ms: 0 given, must be one of them"});
  expect_bad_input("tune bodies.yaml --flip 0.1 --psnr 40", {"2 given, must be one of them"});
  expect_bad_input("tune bodies.yaml --flip 1.5", {"--flip is 1.5, must be from 0 to 1"});
  expect_bad_input("tune bodies.yaml --flip nan", {"--flip", "'nan'", "a finite number"});
  expect_bad_input("tune bodies.yaml --psnr 0", {"--psnr is 0, must be above 0"});
  expect_bad_input("tune bodies.yaml --budget-ms -1", {"--budget-ms is -1, must be above 0"});
  expect_bad_input("tune bodies.yaml --flip 0.1 --policy budget", {"--policy", "budget"});
  expect_bad_input("tune bodies.yaml --flip 0.1 --policy hold",
                   {"--policy is 'hold', must be threshold, lookahead or oracle"});
  expect_bad_input("tune bodies.yaml --flip 0.1 --frames 3-99", {"--frames is '3-99'"});
  expect_bad_input("tune bodies.yaml --flip 0.1 --progress loud", {"--progress is 'loud'"});
  EXPECT_FALSE(std::filesystem::exists(path("out")));
}

TEST_F(Tune, AWeightHalvesTheThresholdAndIsExplained) {
  write("weighted.yaml", with_layers("regulator: {geometric_px: 2}\n",
                                     {{"layers", {{{"layer", "ball"}, {"importance_geometric", 4}}}}}));
  const Outcome planned = run("plan weighted.yaml --progress none --out w");
  ASSERT_EQ(planned.exit_code, 0) << planned.output;
  int frame = -1;
  for (const std::string& line : lines("w/decisions.jsonl")) {
    const Json json = Json::parse(line);
    const double px = json["fiducials"].is_null() ? 0 : json["fiducials"].value("warp_geometric_px", 0.0);
    if (json["layer"] != "ball" || !(px > 0)) continue;
    EXPECT_EQ(json["decision"], px > 0.5 ? "rerender" : "reuse") << line;
    if (px > 0.5) frame = json["frame"];
  }
  ASSERT_GE(frame, 0);
  const std::string command = "explain weighted.yaml --layer ball --frame " + std::to_string(frame);
  EXPECT_THAT(run(command).output, AllOf(HasSubstr("> 0.5 px"), HasSubstr("beyond 0.5"),
                                         HasSubstr("(planned: kept at 1 % looser, drawn at 1 % stricter)")));
}

}  // namespace
}  // namespace talisman
