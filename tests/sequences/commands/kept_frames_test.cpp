// SPDX-License-Identifier: Apache-2.0
// What a run keeps: pictures that are still what was written, results that outlast a video's failure, and no more memory
// and lines than a long run can have.
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/sequences/commands/peak_memory.h"
#include "tests/sequences/commands/tool.h"

namespace talisman {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kThreeFrames = " --frames 0-2 --size 64x48 --progress none --out ";

class KeptFrames : public Tool {
 protected:
  void SetUp() override {
    Tool::SetUp();
    write("passing.yaml", kPassing);
  }
  /// An ffmpeg that does this behind its list of encoders.
  void write_encoder(const std::string& then) const {
    fs::create_directories(folder_ / "bin");
    write("bin/ffmpeg", "#!/bin/sh\ncase \"$*\" in *-encoders*) exit 0;; esac\n" + then + "\n");
    fs::permissions(folder_ / "bin/ffmpeg", fs::perms::owner_all);
  }
  void expect_same_pictures(const std::string& a, const std::string& b, const std::string& what) const {
    EXPECT_EQ(files_in(a), files_in(b)) << what;
    for (const std::string& name : files_in(a))
      EXPECT_EQ(read(a + "/" + name), read(b + "/" + name)) << what << " " << name;
  }
};

TEST_F(KeptFrames, ArePicturesThatAreStillAsTheyWereWritten) {
  const std::string options = "render passing.yaml" + kThreeFrames;
  ASSERT_EQ(run(options + "whole").exit_code, 0);
  ASSERT_EQ(run(options + "o").exit_code, 0);
  const std::string good = read("whole/frames/0001.png");
  std::string flipped = good;
  flipped[good.size() / 2] = static_cast<char>(flipped[good.size() / 2] ^ 1);
  const std::string damaged[] = {"",
                                 good.substr(0, good.size() / 2),
                                 good.substr(0, good.size() - 1),
                                 flipped,
                                 good + "x",
                                 read("whole/frames/0000.png"),
                                 "not a picture"};
  for (const std::string& bytes : damaged) {
    write("o/frames/0001.png", bytes);
    const Outcome outcome = run(options + "o --resume");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr("kept 2 complete frames")) << bytes.size();
    expect_same_pictures("whole/frames", "o/frames", std::to_string(bytes.size()));
    EXPECT_EQ(read("whole/frames.jsonl"), read("o/frames.jsonl")) << bytes.size();
    EXPECT_EQ(read("whole/summary.json"), read("o/summary.json")) << bytes.size();
  }
}

TEST_F(KeptFrames, ArePicturesOfEveryFormatAndTheOnesBesideThem) {
  const std::pair<const char*, const char*> cases[] = {
      {"--format exr", "frames/0001.exr"},
      {"--format exr-layers", "frames/0001.exr"},
      {"--overlay", "frames/0001.png"},
      {"--separate", "separate/0001-wall.png"},
      {"--separate --format none", "separate/0001-wall-sum.png"}};
  for (const auto& [option, file] : cases) {
    const std::string options = std::string("render passing.yaml ") + option + kThreeFrames;
    ASSERT_EQ(run(options + "whole").exit_code, 0) << option;
    ASSERT_EQ(run(options + "o").exit_code, 0) << option;
    const Outcome all = run(options + "o --resume");
    EXPECT_THAT(all.output, HasSubstr("kept 3 complete frames")) << option << "\n" << all.output;
    const std::string half = read(std::string("o/") + file).substr(0, 100);
    ASSERT_FALSE(half.empty()) << file;
    write(std::string("o/") + file, half);
    const Outcome outcome = run(options + "o --resume");
    EXPECT_THAT(outcome.output, HasSubstr("kept 2 complete frames")) << option << "\n" << outcome.output;
    const std::string folder = std::string(file).substr(0, std::string(file).find('/'));
    expect_same_pictures("whole/" + folder, "o/" + folder, option);
    for (const char* name : {"whole", "o"}) fs::remove_all(folder_ / name);
  }
}

TEST_F(KeptFrames, AVideoThatCannotBeMadeIsSaidBeforeAnythingIsTouched) {
  const std::string options = "render passing.yaml --video" + kThreeFrames + "o";
  const Outcome missing = run(options, "env PATH=/nonexistent");
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.output, HasSubstr("ffmpeg cannot be started"));
  EXPECT_FALSE(fs::exists(folder_ / "o"));
  fs::create_directories(folder_ / "bin");
  write("bin/ffmpeg", "#!/bin/sh\nexit 3\n");
  fs::permissions(folder_ / "bin/ffmpeg", fs::perms::owner_all);
  EXPECT_EQ(run(options, "env PATH=\"$PWD/bin:$PATH\"").exit_code, 1);
  EXPECT_FALSE(fs::exists(folder_ / "o"));
  const Outcome compared =
      run("compare passing.yaml threshold:1 hold:3" + kThreeFrames + "c", "env PATH=/nonexistent");
  EXPECT_EQ(compared.exit_code, 1) << compared.output;
  EXPECT_FALSE(fs::exists(folder_ / "c"));
}

TEST_F(KeptFrames, OutlastAVideoThatFails) {
  const std::string options = "render passing.yaml --video" + kThreeFrames + "o";
  for (const std::string then : {"kill -9 $$", "exit 1", "exit 0"}) {
    write_encoder(then);
    const Outcome killed = run(options, "env PATH=\"$PWD/bin:$PATH\"");
    EXPECT_EQ(killed.exit_code, 3) << then << killed.output;
    EXPECT_THAT(killed.output, AllOf(HasSubstr("o/video.mp4"), HasSubstr("--resume makes the video")));
    EXPECT_EQ(files_in("o/frames").size(), 3u);
    EXPECT_TRUE(nlohmann::json::accept(read("o/summary.json"))) << then;
    EXPECT_FALSE(fs::exists(folder_ / "o/video.mp4")) << then;
    const Outcome resumed = run(options + " --resume");
    EXPECT_EQ(resumed.exit_code, 0) << resumed.output;
    EXPECT_THAT(resumed.output, HasSubstr("kept 3 complete frames"));
    EXPECT_GT(fs::file_size(folder_ / "o/video.mp4"), 500u);
    fs::remove_all(folder_ / "o");
  }
}

TEST_F(KeptFrames, OfExperimentsWithoutAPlotterAreNotEvenMeasured) {
  for (const std::string command : {"accuracy --solvers --inputs 2", "warps", "reproduce --only LS97:22",
                                    "tune passing.yaml --psnr 30 --frames 0-2 --size 64x48"}) {
    const Outcome outcome = run(command + " --out o", "env PATH=/nonexistent");
    EXPECT_EQ(outcome.exit_code, 1) << command << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr("gnuplot cannot be started")) << command;
    EXPECT_FALSE(fs::exists(folder_ / "o")) << command;
  }
}

// Every frame left 2 kB in memory: a gigabyte and more for a million.
TEST_F(KeptFrames, OfALongPlanTakeTheMemoryOfAShortOne) {
  if (kIsSanitized) GTEST_SKIP() << "freed memory is kept for a while by the sanitizer";
  for (const auto& [name, frames] : {std::pair{"short.yaml", "1000"}, {"long.yaml", "20000"}}) {
    std::string text = kPassing;
    text.replace(text.find("frames: 40\nfps: 1"), 17, std::string("frames: ") + frames + "\nfps: 30");
    write(name, text);
  }
  for (const std::string policy :
       {"reference", "direct", "threshold", "hold", "interpolate", "lookahead", "predictive", "budget"}) {
    const auto plan = [&](const std::string& name) {
      std::vector<std::string> words{"plan",      path(name),    "--policy", policy,    "--size",
                                     "64x48",     "--decisions", "changed",  "--quiet", "--no-report",
                                     "--threads", "1",           "--out",    path("o")};
      if (policy == "budget") words.push_back("--budget-ms=1");
      return tests::peak_memory_kB(tool(), words);
    };
    const long few = plan("short.yaml"), many = plan("long.yaml");
    EXPECT_LT(static_cast<double>(many), 1.05 * static_cast<double>(few)) << policy;
  }
}

TEST_F(KeptFrames, DecisionsMayBeLeftOutAndWhoNeedsThemSaysSo) {
  const std::string options = "render passing.yaml --frames 0-19 --size 64x48 --progress none --out ";
  ASSERT_EQ(run(options + "all").exit_code, 0);
  ASSERT_EQ(run(options + "changed --decisions changed").exit_code, 0);
  ASSERT_EQ(run(options + "none --decisions none").exit_code, 0);
  for (const std::string& out : {std::string("changed"), std::string("none")}) {
    EXPECT_EQ(read("all/summary.json"), read(out + "/summary.json"));
    EXPECT_EQ(read("all/frames.jsonl"), read(out + "/frames.jsonl"));
    for (const std::string& command :
         {"report " + out, "export --trace " + out, "explain " + out + " --frame 3", "diff all " + out})
      expect_bad_input(command, {"--decisions " + out, "needs all"});
    EXPECT_EQ(run("export --csv --sqlite " + out).exit_code, 0);
  }
  EXPECT_FALSE(fs::exists(folder_ / "none/decisions.jsonl"));
  EXPECT_FALSE(fs::exists(folder_ / "none/decisions.csv"));
  // By hand: of each layer the lines where it is drawn, or where its decision is not that of the frame before.
  std::map<std::string, std::string> before;
  std::vector<std::string> expected;
  int frame = 0;
  std::map<std::string, std::string> now;
  for (const std::string& line : lines("all/decisions.jsonl")) {
    const auto json = nlohmann::json::parse(line);
    if (json["frame"] != frame) {
      frame = json["frame"];
      before = now;
      now.clear();
    }
    const std::string layer = json["layer"], decision = json["decision"];
    now[layer] = decision;
    if (decision == "rerender" || !before.contains(layer) || before[layer] != decision)
      expected.push_back(line);
  }
  EXPECT_EQ(lines("changed/decisions.jsonl"), expected);
  EXPECT_LT(expected.size(), lines("all/decisions.jsonl").size());
  // Continued, they are the same again.
  fs::remove(folder_ / "changed/frames/0007.png");
  const std::string whole = read("changed/decisions.jsonl");
  EXPECT_EQ(run(options + "changed --decisions changed --resume").exit_code, 0);
  EXPECT_EQ(read("changed/decisions.jsonl"), whole);
  expect_bad_input(options + "changed --resume", {"decisions was \"changed\""});
}

// --- Readers of models

TEST_F(KeptFrames, OfModelsThatTakeTooMuchAreNone) {
  if (kIsSanitized) GTEST_SKIP() << "a sanitizer needs more address space than the limit allows";
  write("big.mtl", "newmtl m\nmap_Kd big.ppm\n");
  write("big.obj",
        "mtllib big.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n");
  write("big.ppm", "P6\n16384 16384\n255\n");  // 1.9 GB, of which not a byte is there
  const std::string plan = "plan big.obj --no-cache" + kThreeFrames + "o ";
  expect_bad_input(plan + "--import-memory-mb 1500", {"big.obj: texture '", "big.ppm' of 16384",
                                                      "1793 MB to decode", "--import-memory-mb raises that"});
  expect_bad_input(plan + "--import-limit-s 0", {"--import-limit-s is 0", "from 1 to"});
  expect_bad_input(plan + "--import-memory-mb 63", {"--import-memory-mb is 63", "from 64 to"});
  EXPECT_FALSE(fs::exists(folder_ / "o"));
  std::string many = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (int k = 0; k < 400000; ++k) many += "v 0.5 1 2\nf 1 2 " + std::to_string(4 + k) + "\n";
  write("many.obj", many);
  expect_bad_input("plan many.obj --no-cache --import-memory-mb 64" + kThreeFrames + "o",
                   {"many.obj: ", "--import-memory-mb"});
}

TEST_F(KeptFrames, OfAModelThatTakesTooLongAreNone) {
  std::string name = "f";
  write("slow.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
  std::string polygon = "v 0 0 0\n";
  for (int k = 0; k < 30000; ++k) {
    polygon += "v " + std::to_string(k) + " " + std::to_string((k * 7919) % 10007) + " 0\n";
    name += " " + std::to_string(k + 2);
  }
  write("slow.obj", polygon + name + "\n");  // one face of 30,000 corners that cross each other
  const Outcome outcome = run("plan slow.obj --no-cache --import-limit-s 1" + kThreeFrames + "o");
  if (outcome.exit_code == 0) GTEST_SKIP() << "read within a second";
  EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
  EXPECT_THAT(outcome.output,
              AllOf(HasSubstr("slow.obj"), HasSubstr("limit of 1 s of processor time (--import-limit-s)")));
}

}  // namespace
}  // namespace talisman
