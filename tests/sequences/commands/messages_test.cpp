// SPDX-License-Identifier: Apache-2.0
// What the tool says: each message names the file, the value and the rule, and nothing that was asked for is dropped
// without a word.
#include <filesystem>
#include <string>
#include <vector>

#include "tests/sequences/commands/tool.h"

namespace talisman {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// How often a text is said.
int count_of(const std::string& text, const std::string& in) {
  int count = 0;
  for (std::size_t at = in.find(text); at != std::string::npos; at = in.find(text, at + 1)) ++count;
  return count;
}

class Messages : public Tool {
 protected:
  /// Expects that `plan` warns of `warning` once and makes its plan, and that --strict makes it an error.
  void expect_warning(const std::string& arguments, const std::string& warning) const {
    const Outcome outcome = run("plan " + arguments + " --progress none");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    EXPECT_EQ(count_of(warning, outcome.output), 1) << outcome.output;
    EXPECT_EQ(count_of("warning: ", outcome.output), 1) << outcome.output;
    const Outcome strict = run("plan " + arguments + " --progress none --strict");
    EXPECT_EQ(strict.exit_code, 2) << strict.output;
    EXPECT_THAT(strict.output, AllOf(HasSubstr("1 warning, rule with --strict: none"), HasSubstr(warning)));
  }
};

constexpr const char* kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const std::string kShort = " --frames 0-1 --size 64x48";

// --- Numbers

TEST_F(Messages, NumbersAreFiniteWhereverTheyAreWritten) {
  for (const std::string option :
       {"geometric-px", "photometric", "light-angle-deg", "shadow-map-px", "turned-px", "budget-ms",
        "min-resolution", "cutoff-px", "depth-complexity", "expected-reuse", "exposure", "turntable"})
    for (const std::string value : {"inf", "-inf", "1e400", "nan"})
      expect_bad_input("plan cube.obj --" + option + "=" + value, {"--" + option, value, "a finite number"});
  expect_bad_input("render cube.obj --resolution infinity", {"--resolution", "infinity", "a finite number"});
  write("inf.yaml", "frames: 2\nshapes: [{id: a, box: [1, 1, 1]}]\nregulator: {geometric_px: .inf}\n");
  expect_bad_input("plan inf.yaml", {"inf.yaml:3", "geometric_px", ".inf", "a number from 0"});
  write("far.yaml", "frames: 2\nshapes: [{id: a, box: [1, 1, 1]}]\nregulator: {geometric_px: 1e400}\n");
  expect_bad_input("plan far.yaml", {"far.yaml:3", "geometric_px", "1e400", "a number from 0"});
}

TEST_F(Messages, WholeNumbersThatCannotBeHeldAreRefused) {
  expect_bad_input("plan cube.obj --policy budget --budget-polygons 99999999999999999999",
                   {"--budget-polygons", "99999999999999999999"});
  expect_bad_input("plan cube.obj --policy hold --hold 3000000000", {"--hold", "3000000000"});
  expect_bad_input("plan cube.obj --policy hold --hold 2.5", {"--hold", "2.5", "a whole number"});
}

// --- Options of other policies

TEST_F(Messages, OptionsOfAnotherPolicyAreRefusedWithThePoliciesThatHaveThem) {
  const std::string plan = "plan cube.obj" + kShort + " ";
  expect_bad_input(plan + "--budget-polygons 100",
                   {"--budget-polygons is no option of policy threshold; policy budget has it"});
  expect_bad_input(plan + "--hold 2",
                   {"--hold is no option of policy threshold; the policies hold and interpolate have it"});
  expect_bad_input(
      plan + "--policy oracle --lookahead 4",
      {"--lookahead is no option of policy oracle; the policies lookahead and predictive have it"});
  expect_bad_input(plan + "--choice best --cutoff-px 1",
                   {"--cutoff-px and --choice are no options of policy threshold; policy budget has them"});
  expect_bad_input(plan + "--policy reference --geometric-px 2",
                   {"--geometric-px is no option of policy reference; the policies threshold, lookahead, "
                    "oracle and predictive"});
  expect_bad_input("explain cube.obj --frame 1 --hold 3", {"--hold is no option of policy threshold"});
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out")) << "nothing was begun";
}

// The policy may be the sequence's own.
TEST_F(Messages, OptionsAreThoseOfTheSequencesPolicy) {
  write("held.yaml", "frames: 2\nshapes: [{id: a, box: [1, 1, 1]}]\nregulator: {policy: hold}\n");
  expect_bad_input("plan held.yaml --geometric-px 2", {"--geometric-px is no option of policy hold"});
  EXPECT_EQ(run("plan held.yaml --hold 2 --size 64x48 --progress none").exit_code, 0);
}

TEST_F(Messages, OptionsThatThePolicyReadsAreTakenWithoutAWord) {
  for (const std::string options :
       {"--policy budget --budget-polygons 100 --choice best", "--policy hold --hold 2",
        "--policy interpolate --hold 2", "--policy lookahead --lookahead 4 --geometric-px 2 --predict linear",
        "--policy oracle --geometric-px 2",
        "--policy predictive --lookahead 9 --tree-k 3 --joining copy --motion-norm axis --geometric-px 2",
        "--geometric-px 2 --shadow-map-px 1 --photometric 0.1 --color-warp off"})
    EXPECT_THAT(run("plan cube.obj --progress none --strict " + options + kShort).output,
                Not(HasSubstr("warning")))
        << options;
}

TEST_F(Messages, KeysOfASequenceMayServeOtherPolicies) {
  write("all.yaml",
        "frames: 2\nshapes: [{id: a, box: [1, 1, 1]}]\nregulator: {budget_polygons: 100, hold_frames: 2}\n");
  const Outcome outcome = run("plan all.yaml --size 64x48 --progress none --strict");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
}

// --- Content that is not in the picture

TEST_F(Messages, MissingMaterialsAreSaidOnceEach) {
  write("m.obj", "mtllib gone.mtl\n" + std::string(kTriangle) +
                     "usemtl red\nf 1 2 3\nusemtl blue\nf 1 2 3\n" +
                     "usemtl red\nf 1 3 2\nmtllib gone.mtl\n");
  const Outcome outcome = run("plan m.obj --progress none" + kShort);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_EQ(count_of("warning: m.obj: material library 'gone.mtl' is missing\n", outcome.output), 1)
      << outcome.output;
  EXPECT_EQ(count_of("warning: m.obj: materials 'red', 'blue' are in no library\n", outcome.output), 1)
      << outcome.output;
  const Outcome strict = run("plan m.obj --strict --progress none" + kShort);
  EXPECT_EQ(strict.exit_code, 2);
  EXPECT_THAT(strict.output, HasSubstr("m.obj: 2 warnings, rule with --strict: none"));
}

TEST_F(Messages, MaterialOfNoLibraryIsSaidThoughThereIsOne) {
  write("some.mtl", "newmtl blue\nKd 0 0 1\n");
  write("m.obj",
        "mtllib some.mtl\n" + std::string(kTriangle) + "usemtl red\nf 1 2 3\nusemtl blue\nf 1 2 3\n");
  expect_warning("m.obj" + kShort, "m.obj: material 'red' is in no library\n");
}

TEST_F(Messages, LibrariesAreContentOfTheRun) {
  write("some.mtl", "newmtl blue\nKd 0 0 1\n");
  write("m.obj", "mtllib some.mtl other.mtl\n" + std::string(kTriangle) + "usemtl blue\nf 1 2 3\n");
  const std::string render = "render m.obj --out o --progress none" + kShort;
  EXPECT_THAT(run(render).output, HasSubstr("material library 'other.mtl' is missing"));
  const nlohmann::json content = nlohmann::json::parse(read("o/run.json"))["content"];
  EXPECT_EQ(content.size(), 2u) << content.dump();
  EXPECT_TRUE(content.contains("some.mtl")) << content.dump();
  write("some.mtl", "newmtl blue\nKd 1 0 0\n");
  const Outcome edited = run(render + " --resume");
  EXPECT_EQ(edited.exit_code, 2) << edited.output;
  EXPECT_THAT(edited.output, HasSubstr("content file some.mtl has changed"));
  write("some.mtl", "newmtl blue\nKd 0 0 1\n");
  write("other.mtl", "newmtl green\nKd 0 1 0\n");
  const Outcome appeared = run(render + " --resume");
  EXPECT_EQ(appeared.exit_code, 2) << appeared.output;
  EXPECT_THAT(appeared.output, HasSubstr("content file other.mtl is new"));
}

TEST_F(Messages, TrianglesWithoutAreaAreSaid) {
  // All corners on a line of slope 1/3, whose places are no floats.
  write("line.obj", "v 0.1 0.1 0\nv 0.4 0.2 0\nv 0.7 0.3 0\nv 1 0.4 0\nf 1 2 3\nf 2 3 4\n");
  expect_warning("line.obj" + kShort, "line.obj: all 2 triangles have no area");
  write("one.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 4\n");
  EXPECT_THAT(run("plan one.obj --progress none" + kShort).output, Not(HasSubstr("area")));
}

TEST_F(Messages, CameraThatSeesNothingIsSaid) {
  const std::string scene =
      "frames: 3\nshapes: [{id: a, box: [1, 1, 1]}]\nlights: [{kind: ambient, color: [1, 1, 1]}]\n";
  write("away.yaml", scene + "camera: {position: [0, 0, 5], look_at: [0, 0, 9]}\n");
  expect_warning("away.yaml --size 64x48", "away.yaml: no layer is in view in any frame");
  // It comes into view in the last of three frames: of the first two the same is true.
  write("comes.yaml", scene +
                          "camera:\n  flight:\n    - {t: 0, position: [0, 0, 5], target: [0, 0, 9]}\n"
                          "    - {t: 0.0833333, position: [0, 0, 5], target: [0, 0, 0]}\n");
  EXPECT_THAT(run("plan comes.yaml --size 64x48 --progress none").output, Not(HasSubstr("in view")));
  EXPECT_THAT(run("plan comes.yaml --size 64x48 --frames 0-0 --progress none").output,
              HasSubstr("no layer is in view"));
}

TEST_F(Messages, PartsThatNoLayerTakesAreNamed) {
  std::string shapes = "frames: 2\nshapes:\n  - {id: used, box: [1, 1, 1]}\n";
  for (int k = 1; k <= 7; ++k) shapes += "  - {id: spare" + std::to_string(k) + ", box: [1, 1, 1]}\n";
  write("spare.yaml", shapes + "layers: [{name: l, parts: [used]}]\n");
  expect_warning(
      "spare.yaml --size 64x48",
      "spare.yaml: 7 parts are taken by no layer and are not drawn: 'spare1', 'spare2', 'spare3', 'spare4', "
      "'spare5' and 2 more");
}

TEST_F(Messages, SpritesThatHadToStaySmallAreOneLine) {
  std::string shapes = "frames: 1\ndisplay: [256, 256]\nplacement: {max_sprite_px: 64}\nshapes:\n",
              layers = "layers:\n";
  for (int k = 1; k <= 6; ++k) {
    const std::string n = std::to_string(k);
    shapes += "  - {id: wall" + n + ", box: [4, 4, 0.1], position: [0, 0, -" + n + "]}\n";
    layers += "  - {name: wall" + n + ", parts: [wall" + n + "]}\n";
  }
  write("walls.yaml", shapes + "camera: {position: [0, 0, 5], look_at: [0, 0, 0]}\n" + layers);
  const Outcome outcome = run("render walls.yaml --format none --progress none");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_EQ(count_of("max_sprite_px", outcome.output), 1) << outcome.output;
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("'wall1'"), HasSubstr("and 1 more"), HasSubstr("64 texels")));
}

// --- Files that cannot be read

TEST_F(Messages, SequenceFilesThatAreWrongNameTheFileTheValueAndTheRule) {
  write("empty.yaml", "");
  write("comment.yaml", "# nothing yet\n");
  expect_bad_input("plan empty.yaml", {"empty.yaml: is empty", "a YAML map"});
  expect_bad_input("plan comment.yaml", {"comment.yaml: is empty", "a YAML map"});
  const std::string box = "frames: 3\nshapes: [{id: hull, box: [1, 1, 1]}, {id: mast, box: [1, 1, 1]}]\n";
  write("twice.yaml", box + "fps: 24\nframes: 4\n");
  expect_bad_input("plan twice.yaml", {"twice.yaml:4", "frames", "only once", "line 1"});
  write("near.yaml", box + "camera: {near_m: 5, far_m: 2, position: [0, 0, 5], look_at: [0, 0, 0]}\n");
  expect_bad_input("plan near.yaml", {"near.yaml:3", "near_m '5'", "far_m '2'", "near_m below far_m"});
  write("far.yaml", box + "camera: {near_m: 20000, position: [0, 0, 5], look_at: [0, 0, 0]}\n");
  expect_bad_input("plan far.yaml", {"far.yaml:3", "near_m '20000'", "far_m '10000' (by default)"});
}

TEST_F(Messages, GlobOfNoPartIsAnsweredWithPartsThatAreThere) {
  const std::string box = "frames: 3\nshapes: [{id: hull, box: [1, 1, 1]}, {id: mast, box: [1, 1, 1]}]\n";
  write("near.yaml", box + "layers:\n  - {name: ship, parts: [hul]}\n");
  expect_bad_input("plan near.yaml", {"near.yaml:4", "'ship'", "'hul'", "did you mean 'hull'"});
  write("other.yaml", box + "layers:\n  - {name: ship, parts: [hull, 'rotor*']}\n");
  expect_bad_input("plan other.yaml", {"other.yaml:4", "'rotor*'", "parts are 'hull', 'mast'"});
  // Names of models' parts have the instance in front; that is what is forgotten.
  write("in_model.yaml",
        "frames: 3\nmodels: [{id: ship, file: two.obj}]\nlayers: [{name: a, parts: ['Hull*']}]\n");
  write("two.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\no hull\nf 1 2 3\no mast\nf 1 3 2\n");
  expect_bad_input("plan in_model.yaml", {"in_model.yaml:3", "'Hull*'", "did you mean 'ship/two.obj/hull'"});
  write("pairs.yaml", box + "order: [{behind: hul, front: mast}]\n");
  expect_bad_input("plan pairs.yaml", {"pairs.yaml:3", "'hul' matches no layer", "did you mean 'hull'"});
}

TEST_F(Messages, BytesThatAreNoGlbNameTheirMagicNumber) {
  write("noise.glb", std::string("\x01\xfe\x20\x7f and then more of the same", 30));
  expect_bad_input("plan noise.glb", {"noise.glb", "01 fe 20 7f", "67 6c 54 46"});
  write("cut.glb", "glTF\x02");
  expect_bad_input("plan cut.glb", {"cut.glb: ends inside a GLB header"});
  write("none.glb", "");
  expect_bad_input("plan none.glb", {"none.glb: is empty", "rule: a GLB file begins with"});
}

TEST_F(Messages, NamesThatAreNearAreAnswered) {
  std::filesystem::create_directories(folder_ / "models");
  expect_bad_input("render carousal", {"'carousal'", "did you mean 'carousel'"});
  expect_bad_input("render xyzzy", {"'xyzzy'", "canyon", "carousel"});
  expect_bad_input("render models", {"'models' is a folder", "rule: "});
  expect_bad_input("plan cube.obj --geom 3",
                   {"'--geom' is no option of plan; did you mean '--geometric-px'?"});
  expect_bad_input("diff cube.obj cube.obj --mapp x",
                   {"'--mapp' is no option of diff; did you mean '--map'?"});
  expect_bad_input("plan cube.obj other.obj", {"'other.obj' is one argument too many for plan"});
}

// --- Help

TEST_F(Messages, ToolAloneListsItsCommands) {
  const Outcome outcome = run("");
  EXPECT_EQ(outcome.exit_code, 2);
  for (const char* command : {"render", "plan", "explain", "inspect", "init", "diff", "warps"})
    EXPECT_THAT(outcome.output, HasSubstr(std::string("\n  ") + command + " ")) << command;
}

TEST_F(Messages, HelpOfRenderHasGroupsDefaultsAndExamples) {
  const std::string help = run("render --help").output;
  for (const char* group : {"Run:", "Content:", "Policy:", "Thresholds:", "Budget, of the policy budget:",
                            "Layers:", "Pictures:", "Examples:"})
    EXPECT_THAT(help, HasSubstr(std::string("\n") + group)) << group;
  // regulator/plan.h, layers/sprite_transform.h
  for (const char* option : {"--policy TEXT=threshold", "--hold INT=3", "--geometric-px FLOAT=4",
                             "--photometric FLOAT=0.05", "--cutoff-px FLOAT=0.004", "--lookahead INT=16",
                             "--warp TEXT=aff", "--size TEXT=1024x1024", "--expected-reuse FLOAT=8"})
    EXPECT_THAT(help, HasSubstr(option)) << option;
  EXPECT_THAT(help,
              HasSubstr("trn, trni, iso, isoi, so, soi, aff, affi, per, peri, per2, per2i, pers or pers2"));
}

TEST_F(Messages, WordsOfAnEnumerationAreAllNamed) {
  expect_bad_input(
      "plan cube.obj --warp bend",
      {"must be one of trn, trni, iso, isoi, so, soi, aff, affi, per, peri, per2, per2i, pers, pers2"});
  expect_bad_input("plan cube.obj --policy often", {"must be one of direct, reference, hold, interpolate, "
                                                    "threshold, budget, lookahead, oracle, predictive"});
}

// --- Runs that are stopped

TEST_F(Messages, StoppedPlanDoesNotAdviseToResume) {
  write("long.yaml",
        "frames: 200000\nshapes: [{id: a, box: [1, 1, 1], spin: {deg_per_s: 9}}]\ncamera: {position: [0, 0, "
        "5]}\n");
  const Outcome outcome =
      run_and_signal("plan long.yaml --progress none --out p", "p/decisions.jsonl.partial", SIGINT);
  EXPECT_EQ(outcome.exit_code, 3) << outcome.output;
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("stopped after "), Not(HasSubstr("--resume"))));
}

TEST_F(Messages, ProgressOfAFileIsALineForTenPerCent) {
  const Outcome outcome = run("plan cube.obj --frames 0-199 --size 64x48 --quiet --progress plain");
  EXPECT_EQ(count_of("%", outcome.output), 0) << "quiet is quiet";
  const Outcome told =
      run_shell("( '" + tool() + "' plan cube.obj --frames 0-199 --size 64x48 --progress plain > t.txt )");
  EXPECT_EQ(count_of("% planned ", told.output), 11) << told.output;  // the first frame, then 10 % … 100 %
  EXPECT_THAT(told.output, AllOf(HasSubstr("10% "), HasSubstr("50% "), HasSubstr("100% ")));
}

// --- Runs that take the place of others

TEST_F(Messages, RunThatReplacesAnotherSaysSo) {
  const std::string render = "render cube.obj --out o --format none" + kShort;
  EXPECT_THAT(run(render).output, Not(HasSubstr("replaces")));
  EXPECT_THAT(run(render).output,
              HasSubstr("replaces the run of 2 frames in o; --resume would continue it\n"));
  EXPECT_THAT(run(render + " --geometric-px 1").output,
              AllOf(HasSubstr("replaces the run of 2 frames in o\n"), Not(HasSubstr("would continue"))));
  EXPECT_THAT(run(render + " --geometric-px 1 --resume").output, Not(HasSubstr("replaces")));
  EXPECT_THAT(run(render + " --progress none").output, Not(HasSubstr("replaces")));
  const std::string plan = "plan cube.obj --out p" + kShort;
  EXPECT_THAT(run(plan).output, Not(HasSubstr("replaces")));
  EXPECT_THAT(run(plan).output, HasSubstr("replaces the plan of 2 frames in p\n"));
}

TEST_F(Messages, NothingToContinueIsSaid) {
  const Outcome outcome = run("render cube.obj --out o --format none --resume" + kShort);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("nothing to continue in o: begins anew"));
}

// --- Words of the house

TEST_F(Messages, ReadmeNamesEveryCommand) {
  std::ifstream in(std::string(TALISMAN_SOURCE_DIR) + "/README.md");
  const std::string readme(std::istreambuf_iterator<char>(in), {});
  const std::string help = run("--help").output;
  std::istringstream lines(help.substr(help.find("Subcommands:")));
  int commands = 0;
  std::string line;
  for (std::getline(lines, line); std::getline(lines, line);) {
    std::istringstream words(line);
    std::string command;
    if (line.rfind("  ", 0) != 0 || line[2] == ' ' || !(words >> command)) continue;
    ++commands;
    EXPECT_THAT(readme, HasSubstr("| `talisman " + command)) << command;
  }
  EXPECT_GE(commands, 8) << help;
}

TEST_F(Messages, ScriptsAnswerHelpWithoutBuildingAnything) {
  // Neither setup nor cmake can be reached: what would be run fails.
  write("cmake", "#!/bin/sh\necho built\nexit 9\n");
  write("dpkg-query", "#!/bin/sh\necho built\nexit 9\n");
  for (const std::string script :
       {"sequences/run --help", "sequences/run carousel --help", "tests/run --help"}) {
    const Outcome outcome =
        run_shell("chmod +x cmake dpkg-query && PATH=\"$PWD:$PATH\" '" + std::string(TALISMAN_SOURCE_DIR) +
                  "/" + script.substr(0, script.find(' ')) + "'" + script.substr(script.find(' ')));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    EXPECT_THAT(outcome.output,
                AllOf(HasSubstr("usage: " + script.substr(0, script.find(' '))), Not(HasSubstr("built\n"))));
  }
}

TEST_F(Messages, ScriptFetchesWhatItRuns) {
  // A copy of the script between programs that only say what they are told.
  std::filesystem::create_directories(folder_ / "sequences");
  std::filesystem::create_directories(folder_ / "build/release/bin");
  std::filesystem::copy_file(std::string(TALISMAN_SOURCE_DIR) + "/sequences/run", folder_ / "sequences/run");
  write("setup", "#!/bin/sh\n");
  write("cmake", "#!/bin/sh\n");
  write("sequences/fetch-assets", "#!/bin/sh\necho fetch \"$@\"\n");
  write("build/release/bin/talisman", "#!/bin/sh\necho talisman \"$@\"\n");
  const auto said = [&](const std::string& arguments) {
    return run_shell(
               "chmod +x setup cmake sequences/* build/release/bin/* && PATH=\"$PWD:$PATH\" sequences/run " +
               arguments)
        .output;
  };
  EXPECT_EQ(said("warps --object vase"), "fetch warps\ntalisman warps --object vase\n");
  EXPECT_EQ(said("warps"), "fetch warps\ntalisman warps\n");
  EXPECT_EQ(said("carousel --policy hold"), "fetch carousel\ntalisman render carousel --policy hold\n");
  EXPECT_EQ(said(""), "fetch canyon\ntalisman render canyon --video\n");
}

}  // namespace
}  // namespace talisman
