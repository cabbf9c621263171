// SPDX-License-Identifier: Apache-2.0
// The tool as a user meets it: exit codes, one clear error line, no half-written results, runs that can be
// continued.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "tests/sequences/commands/tool.h"

namespace talisman {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(Tool, RendersABareModel) {
  const Outcome outcome = run("render cube.obj --out o --frames 0-4 --size 64x48 --progress none");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_EQ(files_in("o/frames"),
            (std::set<std::string>{"0000.png", "0001.png", "0002.png", "0003.png", "0004.png"}));
  const nlohmann::json summary = nlohmann::json::parse(read("o/summary.json"));
  EXPECT_EQ(summary["frames"], 5);
  ASSERT_EQ(summary["layers"].size(), 4u) << "the cube, the ground, the key light on it and its shadow map";
  EXPECT_EQ(summary["layers"][0]["polygons"], 12);
  EXPECT_THAT(read("o/summary.json"), Not(HasSubstr("nan")));
}

TEST_F(Tool, PlanMakesTheDecisionsOfRender) {
  ASSERT_EQ(run("render cube.obj --out r --frames 0-19 --size 64x48 --progress none --format none").exit_code,
            0);
  ASSERT_EQ(run("plan cube.obj --out p --frames 0-19 --size 64x48 --progress none").exit_code, 0);
  EXPECT_EQ(read("p/decisions.jsonl"), read("r/decisions.jsonl"));
  EXPECT_FALSE(fs::exists(folder_ / "p/frames")) << "a plan draws nothing";
}

TEST_F(Tool, FramesOfARangeAreThoseOfTheFullRun) {
  ASSERT_EQ(run("render cube.obj --out all --frames 0-19 --size 64x48 --progress none").exit_code, 0);
  ASSERT_EQ(run("render cube.obj --out part --frames 13-15 --size 64x48 --progress none").exit_code, 0);
  for (const char* frame : {"0013.png", "0014.png", "0015.png"})
    EXPECT_EQ(read(std::string("part/frames/") + frame), read(std::string("all/frames/") + frame)) << frame;
  EXPECT_EQ(files_in("part/frames").size(), 3u);
}

TEST_F(Tool, FramesOfARangeUnderLookaheadAreThoseOfTheFullRun) {
  // The runs end with the sequence, not with the range that was asked for.
  for (const std::string policy : {"lookahead --lookahead 6", "oracle"}) {
    const std::string options =
        "render cube.obj --size 64x48 --geometric-px 1 --progress none --policy " + policy;
    ASSERT_EQ(run(options + " --out all --frames 0-24").exit_code, 0);
    ASSERT_EQ(run(options + " --out part --frames 13-15").exit_code, 0);
    for (const char* frame : {"0013.png", "0014.png", "0015.png"})
      EXPECT_EQ(read(std::string("part/frames/") + frame), read(std::string("all/frames/") + frame))
          << policy << " " << frame;
  }
}

TEST_F(Tool, KilledRunContinuesWithTheSameBytes) {
  const std::string options = "render cube.obj --frames 0-59 --size 640x480 --progress none --out ";
  ASSERT_EQ(run(options + "whole").exit_code, 0);
  // SIGKILL in the middle: nothing can be tidied up.
  run_and_signal(options + "cut", "cut/frames/0005.png", SIGKILL);
  EXPECT_FALSE(fs::exists(folder_ / "cut/summary.json")) << "the run was meant to be killed before its end";
  EXPECT_LT(files_in("cut/frames").size(), 60u);
  const Outcome resumed = run(options + "cut --resume");
  ASSERT_EQ(resumed.exit_code, 0) << resumed.output;
  EXPECT_THAT(resumed.output, HasSubstr("complete frames of an earlier run"));
  EXPECT_EQ(frame_hashes("cut"), frame_hashes("whole"));
  EXPECT_EQ(read("cut/decisions.jsonl"), read("whole/decisions.jsonl"));
  for (const std::string& frame : files_in("whole/frames"))
    EXPECT_EQ(read("cut/frames/" + frame), read("whole/frames/" + frame));
  EXPECT_EQ(files_in("cut/frames"), files_in("whole/frames")) << "no temporary file stays";
}

TEST_F(Tool, RunKilledWhileLayersAreMergedContinuesWithTheSameBytes) {
  // Aggregates come and go before, at and after the frame of the kill, and the resumed run must know their
  // sprites and ids though it draws none of the frames that made them.
  write("passing.yaml", kPassing);
  const std::string options = "render passing.yaml --progress none --out ";
  ASSERT_EQ(run(options + "whole").exit_code, 0);
  run_and_signal(options + "cut", "cut/frames/0006.png", SIGKILL);
  EXPECT_FALSE(fs::exists(folder_ / "cut/summary.json")) << "the run was meant to be killed before its end";
  const Outcome resumed = run(options + "cut --resume");
  ASSERT_EQ(resumed.exit_code, 0) << resumed.output;
  EXPECT_THAT(resumed.output, HasSubstr("complete frames of an earlier run"));
  EXPECT_EQ(frame_hashes("cut"), frame_hashes("whole"));
  EXPECT_EQ(read("cut/decisions.jsonl"), read("whole/decisions.jsonl"));
  EXPECT_THAT(read("cut/decisions.jsonl"),
              AllOf(HasSubstr("merged into wall+ball"), HasSubstr("split from wall+ball")));
  for (const std::string& frame : files_in("whole/frames"))
    EXPECT_EQ(read("cut/frames/" + frame), read("whole/frames/" + frame)) << frame;
  EXPECT_EQ(files_in("cut/frames"), files_in("whole/frames"));
}

TEST_F(Tool, InterruptedRunSaysSoAndExitsWithThree) {
  const Outcome outcome = run_and_signal(
      "render cube.obj --frames 0-59 --size 640x480 --progress none --out o", "o/frames/0002.png", SIGINT);
  EXPECT_EQ(outcome.exit_code, 3) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("--resume"));
  EXPECT_FALSE(fs::exists(folder_ / "o/summary.json"));
}

TEST_F(Tool, ResumeWithOtherOptionsIsRefused) {
  const std::string options = "render cube.obj --frames 0-3 --size 64x48 --progress none --out o";
  ASSERT_EQ(run(options).exit_code, 0);
  expect_bad_input(options + " --geometric-px 8 --resume", {"geometric_px was", "is 8"});
}

TEST_F(Tool, BadArgumentsExitWithTwoAndNameOptionValueAndRule) {
  expect_bad_input("render nothing.obj", {"nothing.obj"});
  expect_bad_input("render no_such_sequence", {"no_such_sequence"});
  expect_bad_input("render cube.obj --policy often", {"--policy", "often", "threshold"});
  expect_bad_input("render cube.obj --geometric-px -1", {"geometric_px", "-1", "at least 0"});
  expect_bad_input("render cube.obj --geometric-px nan", {"--geometric-px", "nan", "a finite number"});
  expect_bad_input("render cube.obj --warp bend", {"--warp", "bend"});
  expect_bad_input("render cube.obj --size 0x100", {"--size", "0x100"});
  expect_bad_input("render cube.obj --size -5x100", {"--size"});
  expect_bad_input("render cube.obj --size 64", {"--size", "WxH"});
  expect_bad_input("render cube.obj --frames 5-2", {"--frames", "5-2"});
  expect_bad_input("render cube.obj --frames 0-999999", {"--frames", "0 <= A <= B"});
  expect_bad_input("render cube.obj --hold 0", {"hold_frames", "at least 1"});
  expect_bad_input("render cube.obj --lookahead -1", {"lookahead_frames", "-1", "at least 0"});
  expect_bad_input("render cube.obj --policy budget", {"--policy", "--budget-polygons", "--budget-pixels"});
  expect_bad_input("render cube.obj --budget-polygons -5", {"budget_polygons", "-5", "at least 0"});
  expect_bad_input("render cube.obj --budget-chunks -5", {"budget_chunks", "-5", "at least 0"});
  expect_bad_input("render cube.obj --budget-ms nan", {"--budget-ms", "nan", "a finite number"});
  expect_bad_input("render cube.obj --min-resolution 2", {"min_resolution", "2", "at most 1"});
  expect_bad_input("plan cube.obj --budget-gap", {"--budget-gap", "threshold", "must be budget"});
  expect_bad_input("plan cube.obj --predict crystal", {"--predict", "crystal", "known, held, linear"});
  expect_bad_input("plan cube.obj --predict linear --policy oracle",
                   {"--predict", "oracle", "must be lookahead"});
  expect_bad_input("render cube.obj --cutoff-px nan", {"--cutoff-px", "nan", "a finite number"});
  expect_bad_input("render cube.obj --format gif", {"--format", "gif", "png"});
  expect_bad_input("render cube.obj --format none --video", {"--video"});
  expect_bad_input("render cube.obj --threads -1", {"--threads"});
  expect_bad_input("render cube.obj --no-such-option", {"no-such-option"});
}

// The carousel stands in for any sequence: it needs no package, and no reader of models.
TEST_F(Tool, BadCompressionExitsWithTwoAndNamesOptionValueAndRule) {
  expect_bad_input("render carousel --compression 101",
                   {"--compression is 101", "from 1 to 100, or 0 for none"});
  expect_bad_input("render carousel --compression -1", {"--compression is -1", "from 1 to 100"});
  expect_bad_input("render carousel --compression 2.5", {"--compression", "2.5"});
  expect_bad_input("render carousel --compression high", {"--compression", "high"});
  expect_bad_input("render carousel --compression", {"--compression", "required"});
  expect_bad_input("render carousel --compression 85 --policy direct",
                   {"--compression needs sprites", "direct"});
  expect_bad_input("plan carousel --compression 85", {"--compression"});  // a plan keeps no sprites
  EXPECT_FALSE(fs::exists(folder_ / "out")) << "nothing was begun";
}

TEST_F(Tool, BadBudgetsExitWithTwoAndNameOptionValueAndRule) {
  expect_bad_input("plan carousel --policy budget --budget-polygons few", {"--budget-polygons", "few"});
  expect_bad_input("plan carousel --policy budget --budget-pixels 1.5", {"--budget-pixels", "1.5"});
  expect_bad_input("plan carousel --policy budget --budget-chunks", {"--budget-chunks", "required"});
  expect_bad_input("plan carousel --policy budget --budget-pixels -1", {"budget_pixels", "-1", "at least 0"});
  expect_bad_input("plan carousel --policy budget --budget-ms soon", {"--budget-ms", "soon"});
  expect_bad_input("plan carousel --min-resolution 0", {"min_resolution", "0", "above 0"});
  expect_bad_input("plan carousel --budget-gap=often", {"--budget-gap", "often"});
}

TEST_F(Tool, BadPredictionsExitWithTwoAndNameOptionValueAndRule) {
  expect_bad_input("plan carousel --policy lookahead --predict 1",
                   {"--predict is '1'", "known, held, linear"});
  for (const std::string policy : {"threshold", "budget --budget-pixels 9"})
    expect_bad_input("plan carousel --predict linear --policy " + policy,
                     {"--predict is 'linear'", policy.substr(0, policy.find(' ')), "must be lookahead"});
}

TEST_F(Tool, SeparateTakesNoValueAndOnlyRenderHasIt) {
  expect_bad_input("render carousel --separate=floor", {"--separate", "floor"});
  expect_bad_input("plan carousel --separate", {"--separate"});
}

TEST_F(Tool, SeparateOfAModelWithoutShadeLayersWritesNoPicture) {
  const Outcome outcome =
      run("render cube.obj --no-stage --separate --out o --frames 0-1 --size 64x48 --progress none");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_TRUE(files_in("o/separate").empty());
}

TEST_F(Tool, BadModelsAndSequencesExitWithTwo) {
  write("empty.obj", "");
  expect_bad_input("render empty.obj", {"empty.obj"});
  write("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  expect_bad_input("render nan.obj", {"nan.obj"});
  write("cut.glb", "glTF\x02");
  expect_bad_input("render cut.glb", {"cut.glb"});
  write("bad.yaml", "name: bad\nframes: 0\n");
  expect_bad_input("render bad.yaml", {"bad.yaml:2", "frames"});
  write("typo.yaml", "name: typo\nframez: 10\n");
  expect_bad_input("render typo.yaml", {"typo.yaml:2", "framez"});
}

TEST_F(Tool, OutputFolderThatCannotBeMadeIsOneClearLine) {
  write("file", "in the way");
  expect_bad_input("render cube.obj --frames 0 --progress none --out file/sub",
                   {"file/sub: stands below a file"});
}

TEST_F(Tool, DiskThatFillsUpLeavesNoHalfFile) {
  // A file-size limit stands in for a full disk: the first picture does not fit into 2 blocks of 512 bytes.
  const Outcome outcome = run("render cube.obj --frames 0-3 --size 640x480 --progress none --out o",
                              "trap '' XFSZ; ulimit -f 2;");
  EXPECT_EQ(outcome.exit_code, 1) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("error: "));
  EXPECT_EQ(files_in("o/frames").size(), 0u) << "neither a final name nor a temporary one";
  EXPECT_FALSE(fs::exists(folder_ / "o/summary.json"));
}

TEST_F(Tool, HelpExitsWithZeroAndNamesTheCommands) {
  const Outcome outcome = run("--help");
  EXPECT_EQ(outcome.exit_code, 0);
  for (const char* command : {"render", "plan", "inspect", "diff"})
    EXPECT_THAT(outcome.output, HasSubstr(command));
  EXPECT_EQ(run("").exit_code, 2) << "no command";
}

TEST_F(Tool, InspectPrintsTheEffectTable) {
  const Outcome outcome = run("inspect cube.obj --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const nlohmann::json json = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(json["layers"][0]["polygons"], 12);
  EXPECT_EQ(json["effects"]["texture"]["called"], false);
  EXPECT_EQ(json["effects"]["texture"]["why"], "no material has a texture");
}

// A file in the working directory that has the name of a sequence, as the output of another program may.
TEST_F(Tool, ASequenceIsFoundByNameBesideAFileOfThatName) {
  write("carousel", "no sequence");
  EXPECT_EQ(run("inspect carousel").exit_code, 0);
  expect_bad_input("inspect ./carousel", {"./carousel", "cannot be read as a model"});
}

TEST_F(Tool, AccuracyOfTheRegulatorOnABareModel) {
  const Outcome outcome = run(
      "accuracy --regulator cube.obj --frames 0-11 --size 64x48 --quality-every 4 --progress none --out o");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("threshold"), HasSubstr("oracle"), HasSubstr("results in o")));
  for (const char* name :
       {"regulator.csv", "regulator.svg", "regulator.json", "lookahead.csv", "calibration.csv"})
    EXPECT_TRUE(fs::exists(folder_ / ("o/" + std::string(name)))) << name;
  const std::string page = read("o/regulator.html");
  EXPECT_THAT(page, HasSubstr("<p class=\"verdict\" id=\"verdict\">Under a bound of "));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\"><a href=\"runs/threshold-4-px.html\">threshold</a></th>"));
  EXPECT_THAT(page, HasSubstr("<a href=\"runs/hold-N-3.html\" aria-label=\"hold N 3\"><circle"));
  EXPECT_EQ(
      run("accuracy --regulator cube.obj --frames 0-3 --size 32x24 --no-report --progress none --out bare")
          .exit_code,
      0);
  EXPECT_FALSE(fs::exists(folder_ / "bare/runs"));
  EXPECT_THAT(read("bare/regulator.html"), Not(HasSubstr("runs/")));
  expect_bad_input("report nowhere", {"nowhere: is no folder"});
  expect_bad_input("accuracy --renderer cube.obj --no-report",
                   {"--no-report is about the runs behind --regulator, must come with it"});
  expect_bad_input("accuracy --regulator nothing", {"nothing"});
  expect_bad_input("accuracy --regulator cube.obj --frames 5-2", {"--frames", "5-2"});
  expect_bad_input("accuracy --regulator cube.obj --size 0x9", {"--size", "0x9"});
  expect_bad_input("accuracy --regulator cube.obj --quality-every -2", {"--quality-every", "-2"});
  expect_bad_input("accuracy --solvers --regulator cube.obj", {"more than one experiment"});
  expect_bad_input("accuracy --factoring carousel", {"carousel: no layer factors a shade term"});
  expect_bad_input("accuracy", {"nothing to measure", "--regulator"});
}

TEST_F(Tool, DiffOfEqualFoldersIsIdentical) {
  ASSERT_EQ(run("render cube.obj --out a --frames 0-2 --size 64x48 --progress none").exit_code, 0);
  ASSERT_EQ(run("render cube.obj --out b --frames 0-2 --size 64x48 --progress none --threads 1").exit_code,
            0);
  const Outcome outcome = run("diff a/frames b/frames");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("identical"));
}

TEST_F(Tool, InspectTellsTheOrderOverTime) {
  const Outcome text = run("inspect cube.obj --no-stage --order");
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_THAT(text.output, AllOf(HasSubstr("visibility order of 480 frames"), HasSubstr("    0-479")));
  const Outcome json = run("inspect cube.obj --no-stage --order --json");
  EXPECT_EQ(json.exit_code, 0);
  // One layer: there is nothing to sort, and nothing was.
  EXPECT_EQ(nlohmann::json::parse(json.output)["frames_sorted"], 0);
  const Outcome wrong = run("plan cube.obj --cycles split");
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.output, HasSubstr("--cycles is 'split', must be one of merge, keep"));
  const Outcome unknown = run("plan cube.obj --compositor fancy");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.output, HasSubstr("--compositor is 'fancy', must be one of talisman, extended"));
}

TEST_F(Tool, AloneListsItsCommandsAndHasDoneNothing) {
  const Outcome outcome = run("");
  EXPECT_EQ(outcome.exit_code, 2);
  for (const char* command : {"render", "plan", "inspect", "diff", "warps", "accuracy"})
    EXPECT_THAT(outcome.output, HasSubstr(std::string("\n  ") + command + " ")) << command;
}

TEST_F(Tool, MisspeltCommandsAndOptionsAreAnsweredWithWhatIsNear) {
  expect_bad_input("rendr cube.obj", {"'rendr' is no command; did you mean 'render'?"});
  expect_bad_input("frobnicate", {"'frobnicate' is no command; must be one of render, plan, audit, explain, "
                                  "view, tune, compare, inspect"});
  expect_bad_input("plan cube.obj --geometrc-px 3", {"--geometrc-px", "did you mean '--geometric-px'?"});
  expect_bad_input("plan cube.obj --szie=64x48", {"'--szie' is no option of plan; did you mean '--size'?"});
  expect_bad_input("--versoin", {"'--versoin' is no option; did you mean '--version'?"});
  expect_bad_input("plan cube.obj --xyzzy", {"'--xyzzy' is no option of plan; --help lists them\n"});
  expect_bad_input("plan", {"sequence is required"});
}

TEST_F(Tool, VersionSaysWhatWasBuilt) {
  const Outcome outcome = run("--version");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.output, testing::MatchesRegex("talisman [0-9]+\\.[0-9]+\\.[0-9]+\n"
                                                    "commit: (unknown|[0-9a-f]{12}(-dirty)?)\n"
                                                    "effects: (all|[0-9]+ of) [0-9]+.*\n"
                                                    "simd: [A-Z0-9_]+\n"
                                                    "readers of models: limits of .*\n"));
}

}  // namespace
}  // namespace talisman
