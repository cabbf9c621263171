// SPDX-License-Identifier: Apache-2.0
// The files that a run leaves: whole files are compared, byte by byte, however the run was made; other runs are not
// mixed into them; and what a killed run left goes away.
#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "sequences/files/folder_lock.h"
#include "tests/sequences/commands/tool.h"

namespace talisman {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;

constexpr const char* kResults[] = {"decisions.jsonl", "frames.jsonl", "summary.json"};

class RunFiles : public Tool {
 protected:
  void SetUp() override {
    Tool::SetUp();
    write("passing.yaml", kPassing);
  }
  void expect_same_results(const std::string& a, const std::string& b) const {
    for (const char* name : kResults) {
      EXPECT_FALSE(read(a + "/" + name).empty()) << a << "/" << name;
      EXPECT_EQ(read(a + "/" + name), read(b + "/" + name)) << b << "/" << name;
    }
    EXPECT_EQ(files_in(a), files_in(b));
    EXPECT_EQ(files_in(a + "/frames"), files_in(b + "/frames"));
    for (const std::string& frame : files_in(a + "/frames"))
      EXPECT_EQ(read(a + "/frames/" + frame), read(b + "/frames/" + frame)) << b << " " << frame;
  }
};

TEST_F(RunFiles, AreTheSameForAnyNumberOfThreads) {
  const std::string options =
      "render passing.yaml --frames 0-14 --size 160x120 --compression 85 --quality --progress none --out ";
  ASSERT_EQ(run(options + "one --threads 1").exit_code, 0);
  for (const std::string threads : {"2", "3"}) {
    ASSERT_EQ(run(options + threads + " --threads " + threads).exit_code, 0);
    expect_same_results("one", threads);
  }
}

TEST_F(RunFiles, OfAPlanAreTheSameEveryTime) {
  const std::string options = "plan passing.yaml --policy lookahead --progress none --out ";
  ASSERT_EQ(run(options + "a --threads 1").exit_code, 0);
  ASSERT_EQ(run(options + "b").exit_code, 0);
  for (const char* name : {"decisions.jsonl", "frames.jsonl", "summary.json", "run.json"})
    EXPECT_EQ(read(std::string("a/") + name), read(std::string("b/") + name)) << name;
}

TEST_F(RunFiles, OfARunThatWasKilledAndResumedAreThoseOfAWholeOne) {
  const std::string options = "render passing.yaml --compression 60 --progress none --out ";
  ASSERT_EQ(run(options + "whole").exit_code, 0);
  run_and_signal(options + "cut", "cut/frames/0008.png", SIGKILL);
  ASSERT_FALSE(fs::exists(folder_ / "cut/summary.json")) << "the run was meant to be killed before its end";
  const Outcome resumed = run(options + "cut --resume");
  ASSERT_EQ(resumed.exit_code, 0) << resumed.output;
  expect_same_results("whole", "cut");
}

TEST_F(RunFiles, OfARunWhoseMiddleIsDrawnAgainAreThoseOfAWholeOne) {
  const std::string options = "render passing.yaml --frames 0-11 --size 160x120 --progress none --out ";
  ASSERT_EQ(run(options + "whole").exit_code, 0);
  ASSERT_EQ(run(options + "holes").exit_code, 0);
  for (const char* frame : {"0003.png", "0004.png", "0009.png"}) fs::remove(folder_ / "holes/frames" / frame);
  const Outcome resumed = run(options + "holes --resume");
  ASSERT_EQ(resumed.exit_code, 0) << resumed.output;
  EXPECT_THAT(resumed.output, HasSubstr("kept 9 complete frames"));
  expect_same_results("whole", "holes");
}

TEST_F(RunFiles, OfARangeHaveTheLinesOfTheFullRun) {
  const std::string options = "render passing.yaml --size 160x120 --compression 85 --progress none --out ";
  ASSERT_EQ(run(options + "all").exit_code, 0);
  ASSERT_EQ(run(options + "part --frames 13-22").exit_code, 0);
  const std::vector<std::string> all = lines("all/frames.jsonl");
  EXPECT_THAT(lines("part/frames.jsonl"), ElementsAreArray(all.begin() + 13, all.begin() + 23));
  std::vector<std::string> decisions;
  for (const std::string& line : lines("all/decisions.jsonl"))
    if (const int frame = nlohmann::json::parse(line)["frame"]; frame >= 13 && frame <= 22)
      decisions.push_back(line);
  EXPECT_EQ(lines("part/decisions.jsonl"), decisions);
}

TEST_F(RunFiles, TimesAreInAFileOfTheirOwn) {
  const std::string options = "render cube.obj --frames 0-3 --size 64x48 --progress none --threads 2 --out o";
  ASSERT_EQ(run(options).exit_code, 0);
  fs::remove(folder_ / "o/frames/0002.png");
  ASSERT_EQ(run(options + " --resume").exit_code, 0);
  std::map<std::string, int> kinds;
  std::multiset<int> frames;
  for (const std::string& line : lines("o/timing.jsonl")) {
    const nlohmann::json json = nlohmann::json::parse(line);
    ++kinds[json["schema"]];
    if (json["schema"] == "talisman.process/1") {
      EXPECT_EQ(json["threads"], 2);
    }
    if (json["schema"] == "talisman.timing/1") frames.insert(json["frame"].get<int>());
  }
  EXPECT_EQ(frames, (std::multiset<int>{0, 1, 2, 3}));
  EXPECT_EQ(kinds, (std::map<std::string, int>{
                       {"talisman.process/1", 2}, {"talisman.timing/1", 4}, {"talisman.timing_total/1", 1}}));
  for (const char* name : kResults)
    for (const char* time :
         {"plan_ms", "render_ms", "composite_ms", "io_ms", "sort_ms", "wall", "_us_", "threads"})
      EXPECT_EQ(read(std::string("o/") + name).find(time), std::string::npos) << name << " " << time;
}

TEST_F(RunFiles, LeftByAKilledRunGoAndOthersStay) {
  const std::string options = "render cube.obj --frames 0-2 --size 64x48 --progress none --out o";
  ASSERT_EQ(run(options).exit_code, 0);
  // No process has started at that tick yet.
  const std::set<std::string> stay = {".hidden.png", ".tmp-notes"};
  for (const std::string& name : stay) write("o/frames/" + name, "mine");
  for (const char* folder : {"o/", "o/frames/"})
    write(std::string(folder) + ".tmp-1-99999999999999-0-0001.png", "half");
  write("o/decisions.jsonl.partial", "half");
  write("o/frames.jsonl.partial.new", "half");
  ASSERT_EQ(run(options).exit_code, 0);
  EXPECT_EQ(files_in("o/frames"),
            (std::set<std::string>{".hidden.png", ".tmp-notes", "0000.png", "0001.png", "0002.png"}));
  EXPECT_EQ(files_in("o"), (std::set<std::string>{"changes.jsonl", "decisions.jsonl", "frames",
                                                  "frames.jsonl", "report.html", "run.json", "summary.json",
                                                  "timing.jsonl", "what-if.json"}));
}

/// What a user gets who plans with those thresholds.
TEST_F(RunFiles, WhatIfIsWhatPlansWithTheOtherThresholdsSay) {
  const std::string options =
      "carousel --frames 0-14 --size 160x120 --progress none --no-report --geometric-px ";
  ASSERT_EQ(
      run("render carousel --frames 0-14 --size 160x120 --progress none --geometric-px 1 --out o").exit_code,
      0);
  const auto what_if = nlohmann::json::parse(read("o/what-if.json")).at("plans");
  ASSERT_EQ(what_if.size(), 3u);
  const char* thresholds[] = {"0.5", "1", "2"};
  std::set<std::int64_t> polygons;
  for (std::size_t k = 0; k < 3; ++k) {
    ASSERT_EQ(run("plan " + options + thresholds[k] + " --out p").exit_code, 0);
    const auto summary = nlohmann::json::parse(read("p/summary.json"));
    for (const char* key :
         {"mean_update_rate", "polygons_rendered", "pixels_rendered", "modelled_drawing_ms"})
      EXPECT_EQ(what_if[k].at(key), summary.at(key)) << key << " at " << thresholds[k] << " px";
    polygons.insert(summary.at("polygons_rendered").get<std::int64_t>());
  }
  EXPECT_EQ(polygons.size(), 3u) << "the thresholds make no difference here";
}

TEST_F(RunFiles, OfAnotherRunAreNotContinued) {
  const std::string options = "render passing.yaml --frames 0-3 --size 64x48 --progress none --out o";
  ASSERT_EQ(run(options + " --photometric 0.1").exit_code, 0);
  const std::pair<const char*, const char*> others[] = {
      {"--photometric 0.2", "photometric was 0.1, is 0.2"},
      {"--photometric 0.1 --light-angle-deg 3", "light_angle_rad was 0.0, is 0.05"},
      {"--photometric 0.1 --color-warp off", "color_warp was true, is false"},
      {"--photometric 0.1 --turned-px 7", "turned_px was 0.0, is 7.0"},
      {"--photometric 0.1 --separate", "separate was false, is true"},
      {"--photometric 0.1 --geometric-px 8", "geometric_px was 4.0, is 8.0"},
      {"--photometric 0.1 --shading flat", "shading was \"phong\", is \"flat\""},
      {"--photometric 0.1 --overlay", "overlay was false, is true"},
      {"--photometric 0.1 --format exr", "format was \"png\", is \"exr\""}};
  for (const auto& [other, difference] : others)
    expect_bad_input(options + " --resume " + other,
                     {"o/run.json", difference, "--resume must continue with the same options"});
  EXPECT_EQ(run(options + " --resume --photometric 0.1 --threads 1").exit_code, 0);
}

TEST_F(RunFiles, OfEditedContentAreNotContinued) {
  const std::string options = " --frames 0-3 --size 64x48 --progress none --resume --out ";
  ASSERT_EQ(run("render passing.yaml" + options + "y").exit_code, 0);
  ASSERT_EQ(run("render cube.obj" + options + "m").exit_code, 0);
  write("passing.yaml", kPassing + std::string("# a comment\n"));
  expect_bad_input("render passing.yaml" + options + "y",
                   {"y/run.json", "content file passing.yaml has changed"});
  write("passing.yaml", kPassing + std::string("placement: {max_sprite_px: 64}\n"));
  expect_bad_input("render passing.yaml" + options + "y", {"max_sprite_px was 4096, is 64"});
  write("cube.obj", kCube + std::string("v 9 9 9\n"));
  expect_bad_input("render cube.obj" + options + "m", {"m/run.json", "content file cube.obj has changed"});
}

TEST_F(RunFiles, OfAPlanDoNotGoBetweenPictures) {
  const std::string options = " cube.obj --frames 0-3 --size 64x48 --progress none --out o";
  ASSERT_EQ(run("render" + options).exit_code, 0);
  expect_bad_input("plan" + options, {"o/run.json", "holds pictures", "a folder of its own"});
  EXPECT_EQ(files_in("o/frames").size(), 4u);
  EXPECT_EQ(nlohmann::json::parse(read("o/run.json"))["kind"], "render");
}

// The folder of a plan may become that of a render; pictures in it that are not ours stay.
TEST_F(RunFiles, OfAPlanGiveWayToThoseOfARender) {
  const std::string options = " cube.obj --frames 0-3 --size 64x48 --progress none --out o";
  ASSERT_EQ(run("plan" + options).exit_code, 0);
  EXPECT_EQ(nlohmann::json::parse(read("o/run.json"))["kind"], "plan");
  fs::create_directories(folder_ / "o/frames");
  write("o/frames/0099.png", "of somebody else");
  ASSERT_EQ(run("render --resume" + options).exit_code, 0);
  EXPECT_EQ(files_in("o/frames").size(), 5u);
  EXPECT_EQ(nlohmann::json::parse(read("o/run.json"))["kind"], "render");
}

// Two runs into one folder would write over each other: the second ends at once, and the first never knows.
TEST_F(RunFiles, FolderOfAnotherRunIsLeftAlone) {
  ASSERT_EQ(run("plan passing.yaml --progress none --out shared").exit_code, 0);
  const std::string before = read("shared/decisions.jsonl");
  const sequences::FolderLock other(path("shared"));
  const Outcome refused = run("plan passing.yaml --progress none --geometric-px 9 --out shared");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.output, ::testing::HasSubstr("shared is being written by another run (process "));
  EXPECT_EQ(read("shared/decisions.jsonl"), before);
}

}  // namespace
}  // namespace talisman
