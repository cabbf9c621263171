// SPDX-License-Identifier: Apache-2.0
// Two runs side by side: `compare` makes them and must count what each alone counts; `diff` reads their folders.
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "tests/sequences/commands/tool.h"

namespace talisman {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

using Json = nlohmann::ordered_json;

class TwoRuns : public Tool {
 protected:
  void SetUp() override {
    Tool::SetUp();
    write("passing.yaml", kPassing);
  }
  void expect_success(const std::string& arguments) const {
    const Outcome outcome = run(arguments);
    ASSERT_EQ(outcome.exit_code, 0) << arguments << "\n" << outcome.output;
  }
  /// A run of "passing.yaml" into the folder.
  void make(const std::string& command, const std::string& folder, const std::string& options) const {
    expect_success(command + " passing.yaml --size 96x72 --progress none --out " + folder + " " + options);
  }
};

// --- compare

TEST_F(TwoRuns, ComparedOnesCountWhatEachAloneCountsToTheByte) {
  expect_success(
      "compare passing.yaml threshold:1 budget:ms=0.05,choice=best hold:3 lookahead:4,geometric_px=2 --size "
      "96x72 "
      "--frames 2-13 --progress none --no-video --out c");
  const std::vector<std::pair<std::string, std::string>> alone = {
      {"reference", "--policy reference"},
      {"threshold-1", "--policy threshold --geometric-px 1"},
      {"budget-ms-0.05-choice-best", "--policy budget --budget-ms 0.05 --choice best"},
      {"hold-3", "--policy hold --hold 3"},
      {"lookahead-4-geometric-px-2", "--policy lookahead --lookahead 4 --geometric-px 2"}};
  for (const auto& [name, options] : alone) {
    make("render", "r", "--frames 2-13 --format none --force " + options);
    EXPECT_EQ(read("c/runs/" + name + ".frames.jsonl"), read("r/frames.jsonl")) << name;
    EXPECT_EQ(read("c/runs/" + name + ".summary.json"), read("r/summary.json")) << name;
  }
  EXPECT_EQ(files_in("c/runs").size(), 2 * alone.size());
}

TEST_F(TwoRuns, ErrorsOfComparedOnesAreThoseOfTheirPictures) {
  expect_success("compare passing.yaml threshold:3 --size 96x72 --frames 0-9 --progress none --out c");
  make("render", "t", "--frames 0-9 --policy threshold --geometric-px 3");
  make("render", "f", "--frames 0-9 --policy reference");
  const Outcome outcome = run("diff --json t/frames f/frames");
  const Json diff = Json::parse(outcome.output),
             compared = Json::parse(read("c/compare.json"))["settings"][1];
  for (const char* metric : {"psnr_db", "flip", "ssim"}) {
    EXPECT_EQ(compared[std::string("mean_") + metric].dump(), diff["mean"][metric].dump()) << metric;
    EXPECT_EQ(compared[std::string("worst_") + metric].dump(), diff["worst"][metric].dump()) << metric;
  }
  EXPECT_EQ(files_in("c/frames").size(), 10u);
  EXPECT_TRUE(std::filesystem::exists(path("c/video.mp4")));
  EXPECT_THAT(read("c/compare.csv"), AllOf(HasSubstr("\"reference\","), HasSubstr("\"threshold:3\",")));
}

TEST_F(TwoRuns, AnotherComparisonLeavesNothingOfTheFirst) {
  expect_success("compare passing.yaml threshold:3 --size 32x24 --frames 0-5 --progress none --out c");
  expect_success("compare passing.yaml hold:2 --size 32x24 --frames 0-2 --progress none --out c");
  EXPECT_EQ(files_in("c/frames").size(), 3u);
  EXPECT_EQ(files_in("c/runs").count("threshold-3.summary.json"), 0u);
  make("plan", "p", "--frames 0-3");
  expect_bad_input("compare passing.yaml hold:2 --progress none --out p",
                   {"--out is 'p', which holds a run"});
}

TEST_F(TwoRuns, ComparisonThatIsStoppedKeepsItsTables) {
  const Outcome outcome =
      run_and_signal("compare passing.yaml threshold:1 hold:3 --size 1200x900 --progress none --out c",
                     "c/frames/0001.png", SIGINT);
  EXPECT_EQ(outcome.exit_code, 3) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("error: stopped after "));
  const Json report = Json::parse(read("c/compare.json"));
  EXPECT_FALSE(report["complete"].get<bool>());
  EXPECT_EQ(report["settings"].size(), 3u);
  EXPECT_EQ(report["settings"][0]["frames"].get<int>(), report["last_frame"].get<int>() + 1);
}

TEST_F(TwoRuns, SettingsThatMakeNoSenseAreRefusedByName) {
  const std::string compare = "compare passing.yaml --progress none ";
  expect_bad_input(compare + "tresh:1", {"'tresh:1': policy is 'tresh', must be one of direct"});
  expect_bad_input(compare + "threshold:geo=1",
                   {"'threshold:geo=1': key is 'geo', must be one of geometric-px"});
  expect_bad_input(compare + "threshold:frames=1", {"key is 'frames'"});
  expect_bad_input(compare + "hold:3,geometric_px=2",
                   {"'hold:3,geometric_px=2': ", "--geometric-px is no option of policy hold"});
  expect_bad_input(compare + "hold:x", {"'hold:x': ", "a whole number"});
  expect_bad_input(compare + "hold:0", {"'hold:0': ", "hold_frames is 0"});
  expect_bad_input(compare + "threshold:nan", {"'threshold:nan': ", "a finite number"});
  expect_bad_input(compare + "threshold:", {"a value is missing"});
  expect_bad_input(compare + "threshold:1,2", {"'2' is a bare value, must be KEY=VALUE behind the first"});
  expect_bad_input(compare + "direct:1", {"'1' is a bare value, must be KEY=VALUE with policy direct"});
  expect_bad_input(compare + "budget", {"'budget': --policy is 'budget', must come with"});
  expect_bad_input(compare + "hold:3 hold:3", {"'hold:3' is given twice"});
  expect_bad_input(compare + "reference", {"'reference' is what all are compared with"});
  expect_bad_input(compare + "hold:3 --frames 9-99", {"--frames is '9-99'"});
  EXPECT_FALSE(std::filesystem::exists(path("out")));
}

// --- diff

TEST_F(TwoRuns, DiffOfPlansSaysWhatIsDifferentWithoutPictures) {
  make("plan", "a", "--geometric-px 1");
  make("plan", "b", "--geometric-px 40");
  const Outcome outcome = run("diff a b");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("geometric_px"), HasSubstr("polygons_rendered"),
                                    HasSubstr("ball"), HasSubstr("no pictures were compared: a has none")));
  const Json runs = Json::parse(run("diff --json a b").output)["runs"];
  ASSERT_EQ(runs["settings"].size(), 1u);
  EXPECT_EQ(runs["settings"][0]["name"], "geometric_px");
  EXPECT_EQ(runs["settings"][0]["a"], "1.0");
  EXPECT_EQ(runs["settings"][0]["b"], "40.0");
  // The same, counted from the lines by themselves.
  const std::vector<std::string> a = lines("a/decisions.jsonl"), b = lines("b/decisions.jsonl");
  std::map<std::string, std::string> of_a, of_b;
  std::set<std::string> places;
  const auto sort_in = [&places](const std::vector<std::string>& all,
                                 std::map<std::string, std::string>& into) {
    for (const std::string& line : all) {
      const Json json = Json::parse(line);
      const std::string place = json["frame"].dump() + " " + json["layer"].dump();
      into[place] = json["decision"].get<std::string>();
      places.insert(place);
    }
  };
  sort_in(a, of_a), sort_in(b, of_b);
  std::size_t different = 0;
  for (const std::string& place : places) different += of_a[place] != of_b[place];
  EXPECT_GT(different, 0u);
  EXPECT_EQ(runs["decided_otherwise"].size(), different);
  EXPECT_EQ(runs["decisions"], places.size());
  // What each layer cost in renders is that of its own summary.
  const Json summary = Json::parse(read("b/summary.json"));
  for (const Json& layer : summary["layers"])
    for (const Json& row : runs["layers"])
      EXPECT_TRUE(row["layer"] != layer["name"] || row["renders_b"] == layer["renders"]) << row.dump();
}

TEST_F(TwoRuns, DiffOfARunWithItselfIsNothing) {
  make("render", "a", "--frames 0-5");
  const Outcome outcome = run("diff a a");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("settings and content are the same"), HasSubstr("identical"),
                                    HasSubstr("0 of "), HasSubstr("decisions of 6 frames differ")));
}

TEST_F(TwoRuns, DiffSaysWhyItIsPartial) {
  make("render", "a", "--frames 0-5");
  make("render", "b", "--frames 2-9");
  const Outcome outcome = run("diff a b");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.output,
              HasSubstr("error: 2 frames are in a only, 4 frames are in b only: the others were compared\n"));
  make("plan", "p", "--frames 0-5"), make("plan", "q", "--frames 0-6");
  const Outcome plans = run("diff p q");
  EXPECT_EQ(plans.exit_code, 3);
  EXPECT_THAT(plans.output, HasSubstr("error: 1 frame is in q only: the others were compared\n"));
  make("plan", "z", "--frames 8-9");
  expect_bad_input("diff p z", {"no frame in common with z"});
}

TEST_F(TwoRuns, DiffRefusesWhatIsNoRunOfThisVersion) {
  make("plan", "a", "--frames 0-3");
  make("plan", "b", "--frames 0-3");
  std::string other = read("b/run.json");
  const std::string version = Json::parse(other)["version"];
  for (std::size_t at; (at = other.find("\"" + version + "\"")) != std::string::npos;)
    other.replace(at, version.size() + 2, "\"0.0.7\"");
  write("b/run.json", other);
  expect_bad_input("diff a b", {"b: holds a run of version 0.0.7, must be of " + version});
  expect_bad_input("diff b a", {"b: holds a run of version 0.0.7"});
  write("b/run.json", "[]");
  expect_bad_input("diff a b", {"b: holds no run"});
  std::filesystem::create_directory(path("empty"));
  expect_bad_input("diff a empty", {"no frames, rule: "});
  make("plan", "c", "--frames 0-3");
  write("c/decisions.jsonl", read("c/decisions.jsonl") + "{\"frame\": 3\n");
  expect_bad_input("diff a c", {"c/decisions.jsonl: line ", " is no decision"});
  make("plan", "d", "--frames 0-3");
  write("d/summary.json", "{}");
  expect_bad_input("diff d a", {"d/summary.json: is no summary"});
  make("plan", "e", "--frames 0-3");
  expect_bad_input("diff a e --map m", {"--map needs pictures"});
}

}  // namespace
}  // namespace talisman
