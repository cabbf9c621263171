// SPDX-License-Identifier: Apache-2.0
// Input that once ended in an abort, a library's words or a result nobody asked for: each is refused in one line, with exit
// code 2, and before anything is touched.
#include <filesystem>
#include <map>
#include <string>

#include "tests/sequences/commands/tool.h"

namespace talisman {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kThreeSmall = " --frames 0-2 --size 64x48 --progress none";

class RefusedInput : public Tool {
 protected:
  void SetUp() override {
    Tool::SetUp();
    write("passing.yaml", kPassing);
  }
  /// Of all files below a folder, by path; folders have none.
  std::map<std::string, std::string> contents(const std::string& name) const {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / name)) {
      const std::string below = entry.path().lexically_relative(folder_).string();
      all[below] = entry.is_regular_file() ? read(below) : "";
    }
    return all;
  }
};

/// kPassing with one line that says something else.
std::string with(const std::string& from, const std::string& to, const std::string& text) {
  std::string changed = text;
  const std::size_t at = changed.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return changed.replace(at, from.size(), to);
}

TEST_F(RefusedInput, WhatSpeaksOfSpritesNeedsThem) {
  for (const std::string option : {"--separate", "--overlay", "--audit 2", "--late-chunks on",
                                   "--format exr-layers", "--compression 85"})
    expect_bad_input("render passing.yaml --policy direct " + option + kThreeSmall + " --out o",
                     {option.substr(0, option.find(' ')), "needs sprites, but --policy is direct"});
  expect_bad_input("audit passing.yaml --policy direct" + kThreeSmall + " --out o",
                   {"audit needs sprites, but --policy is direct"});
  EXPECT_FALSE(fs::exists(folder_ / "o"));
}

// 1e-308: its times were infinite, and the run aborted.
TEST_F(RefusedInput, NumbersBeyondTheRangeOfTheFormat) {
  struct Case {
    const char *from, *to, *place;
  };
  const Case cases[] = {
      {"fps: 1\n", "fps: 1e-308\n", "bad.yaml:2: fps is '1e-308'"},
      {"fps: 1\n", "fps: 1e-10\n", "bad.yaml:2: fps is '1e-10'"},
      {"near_m: 1,", "near_m: 1e-300,", "near_m is '1e-300'"},
      {"far_m: 100,", "far_m: 1e300,", "far_m is '1e300'"},
      {"box: [1, 4, 4]", "box: [1, 1e200, 4]", "box[1] is '1e200'"},
      {"box: [1, 4, 4]", "box: [1, 1e-200, 4]", "is a list of 3"},
      {"sphere: 2", "sphere: 1e-310", "sphere is '1e-310'"},
      {"t: 10,", "t: 1e308,", "'1e308'"},
      {"position: [2, 1, 12]", "position: [2, 1, 1e39]", "position[2] is '1e39'"},
      {"color: [0.3, 0.3, 0.3]", "color: [0.3, 1e38, 0.3]", "color[1] is '1e38'"},
      {"layers:\n", "regulator: {geometric_px: 1e308}\nlayers:\n", "geometric_px is '1e308'"},
      {"layers:\n", "placement: {resolution_scale: 1e-200}\nlayers:\n", "resolution_scale is '1e-200'"}};
  for (const Case& c : cases) {
    write("bad.yaml", with(c.from, c.to, kPassing));
    expect_bad_input("plan bad.yaml" + kThreeSmall + " --out o", {"bad.yaml:", c.place, "rule: "});
  }
  EXPECT_FALSE(fs::exists(folder_ / "o"));
  for (const std::string option : {"--exposure 1e-308", "--turntable 1e-308", "--expected-reuse 1e-308",
                                   "--resolution 1e-308", "--threads 2147483647", "--threads 1025"})
    expect_bad_input("render cube.obj " + option + " --size 64x48 --out o",
                     {option.substr(0, option.find(' '))});
}

TEST_F(RefusedInput, TextThatIsEmpty) {
  for (const std::string option :
       {"--out", "--policy", "--format", "--frames", "--warp", "--assets", "--decisions"})
    expect_bad_input("render passing.yaml " + option + " ''", {option, "rule: not empty"});
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(RefusedInput, ASecondDocument) {
  write("two.yaml", std::string(kPassing) + "---\n" + kPassing);
  expect_bad_input("plan two.yaml" + kThreeSmall,
                   {"two.yaml:", "a second document, rule: one YAML document in a file"});
}

// The results of an earlier run were gone when the library's exception came.
TEST_F(RefusedInput, NamesThatAreNotUtf8AreWrittenAsIfTheyWereLatin1) {
  ASSERT_EQ(run("plan passing.yaml" + kThreeSmall + " --out o").exit_code, 0);
  write("p\xff.yaml", kPassing);
  const std::string cube = kCube;
  write("c\xfc.obj", cube.substr(0, cube.find("f 5")) + "g b\xfcro\n" + cube.substr(cube.find("f 5")));
  for (const std::string file : {"p\xff.yaml", "c\xfc.obj"}) {
    const Outcome outcome = run("render '" + file + "'" + kThreeSmall + " --out o --force");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    EXPECT_TRUE(nlohmann::json::accept(read("o/run.json"))) << file;
    EXPECT_EQ(run("inspect '" + file + "' --json").exit_code, 0) << file;
    EXPECT_EQ(run("inspect '" + file + "' --parts --json").exit_code, 0) << file;
    EXPECT_EQ(run("export o --csv --sqlite --trace").exit_code, 0) << file;
  }
  EXPECT_THAT(read("o/decisions.jsonl"), HasSubstr("b\xc3\xbcro"));
  EXPECT_THAT(read("o/run.json"), HasSubstr("c\xc3\xbc.obj"));
}

TEST_F(RefusedInput, FoldersWhereFilesBelongAndFilesWhereFoldersDo) {
  const std::string options = "render passing.yaml" + kThreeSmall + " --out o";
  for (const std::string place :
       {"run.json", "decisions.jsonl", "decisions.jsonl.partial", "frames.jsonl.partial.new", "timing.jsonl",
        "summary.json", "what-if.json", "report.html", "video.mp4", "frames/0001.png"}) {
    ASSERT_EQ(run(options).exit_code, 0);
    fs::remove(folder_ / "o" / place);
    fs::create_directories(folder_ / "o" / place / "mine");
    const auto before = contents("o");
    for (const char* how : {"", " --resume", " --force"})
      expect_bad_input(options + how, {"o/" + place + ": is a folder, rule: "});
    EXPECT_EQ(contents("o"), before) << place;
    fs::remove_all(folder_ / "o");
  }
  for (const std::string place : {"o", "o/frames"}) {
    fs::create_directories(folder_ / "o");
    fs::remove_all(folder_ / place);
    write(place, "a file");
    expect_bad_input(options, {place + ": is no folder, rule: "});
    fs::remove_all(folder_ / "o");
  }
  expect_bad_input("plan passing.yaml" + kThreeSmall + " --out passing.yaml/o",
                   {"passing.yaml/o: stands below a file"});
}

// A pipe has no end: who opened it waited for ever.
TEST_F(RefusedInput, PipesWhereFilesBelong) {
  fs::create_directories(folder_ / "o");
  for (const std::string place : {"run.json", "frames.jsonl.partial.new"}) {
    ASSERT_EQ(run_shell("mkfifo o/" + place).exit_code, 0);
    expect_bad_input("plan passing.yaml" + kThreeSmall + " --out o", {"o/" + place + ": is no file"});
    fs::remove(folder_ / "o" / place);
  }
}

TEST_F(RefusedInput, PicturesAreNotReplacedByARunThatDrawsNone) {
  ASSERT_EQ(run("render passing.yaml" + kThreeSmall + " --out o").exit_code, 0);
  const auto before = contents("o");
  expect_bad_input("plan passing.yaml" + kThreeSmall + " --out o", {"o/run.json", "holds pictures"});
  expect_bad_input("audit passing.yaml" + kThreeSmall + " --out o",
                   {"o/run.json", "holds pictures", "--force"});
  expect_bad_input("render passing.yaml --format none" + kThreeSmall + " --out o",
                   {"o/run.json", "holds pictures"});
  EXPECT_EQ(contents("o"), before);
  EXPECT_EQ(run("render passing.yaml --format none --force" + kThreeSmall + " --out o").exit_code, 0);
}

/// Files of a run that somebody else has written into.
TEST_F(RefusedInput, ResultsThatWereEditedAreSaidToBe) {
  ASSERT_EQ(run("render passing.yaml" + kThreeSmall + " --out o").exit_code, 0);
  const auto good = contents("o");
  const std::string edits[] = {
      "",
      "5",
      "[]",
      "{\"schema\":5}",
      "{\"schema\":\"talisman.run/2\",\"kind\":{}}",
      "{\"schema\":\"talisman.run/2\",\"settings\":{},\"version\":[],\"decisions\":7}",
      "\xff\xfe",
      "{\"schema\":null,\"layers\":7}"};
  for (const std::string file : {"run.json", "summary.json", "decisions.jsonl", "frames.jsonl"})
    for (const std::string& edit : edits) {
      write("o/" + file, edit);
      for (const std::string command :
           {"report o", "export o --csv --trace", "diff o o", "explain o --frame 1",
            "render passing.yaml --frames 0-2 --size 64x48 --progress none --resume --out o"}) {
        const Outcome outcome = run(command);
        EXPECT_THAT(outcome.exit_code, ::testing::AnyOf(0, 2, 3))
            << command << " " << file << " " << edit << "\n"
            << outcome.output;
        EXPECT_THAT(outcome.output, Not(HasSubstr("json.exception")))
            << command << " " << file << " " << edit;
        EXPECT_THAT(outcome.output, Not(HasSubstr("basic_filebuf"))) << command << " " << file;
      }
      write("o/" + file, good.at("o/" + file));
    }
}

/// What has no bound was written as 1e+30, which a mean takes for a number.
TEST_F(RefusedInput, WhatHasNoBoundIsNull) {
  write(
      "through.yaml",
      "frames: 40\nfps: 10\ndisplay: [96, 72]\n"
      "shapes:\n  - {id: wall, box: [4, 4, 4]}\n  - {id: ball, sphere: 2, flight: [{t: 0, position: [5, 0, "
      "40], target: [-100, 0, 0]},"
      " {t: 1, position: [-5, 0, -60], target: [-100, 0, 0]}, {t: 2, position: [5, 0, 40], target: [-100, 0, "
      "0]},"
      " {t: 3, position: [-5, 0, -30], target: [-100, 0, 0]}]}\n"
      "camera: {fov_deg: 60, near_m: 0.01, far_m: 1000, flight: [{t: 0, position: [0, 0, 12], target: [0, 0, "
      "0]},"
      " {t: 2, position: [0, 0, 0], target: [0, 0, -1]}, {t: 4, position: [0, 0, -12], target: [0, 0, 1]}]}\n"
      "layers:\n  - {name: wall, parts: [wall]}\n  - {name: ball, parts: [ball]}\n");
  ASSERT_EQ(run("plan through.yaml --policy direct --progress none --out o").exit_code, 0);
  bool is_null = false;
  for (const std::string& line : lines("o/decisions.jsonl")) {
    const nlohmann::json json = nlohmann::json::parse(line);
    if (!json["fiducials"].is_object()) continue;
    if (json["fiducials"]["warp_geometric_px"].is_null()) {
      is_null = true;
      EXPECT_NE(json["fiducials"]["fit"], "ok") << line;
    }
  }
  EXPECT_TRUE(is_null) << "the case is none";
  for (const char* file : {"decisions.jsonl", "frames.jsonl", "summary.json"})
    EXPECT_THAT(read(std::string("o/") + file), Not(HasSubstr("e+30"))) << file;
}

}  // namespace
}  // namespace talisman
