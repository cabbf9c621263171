// SPDX-License-Identifier: Apache-2.0
// --visibility, the keys of cells, and what finding what can be seen costs, as a user meets them.
#include <string>

#include "tests/sequences/commands/tool.h"

namespace talisman {
namespace {

using ::testing::HasSubstr;

const std::string kSmall = " --frames 0-3 --size 64x48 --progress none";

/// Two rooms with a box in each, and a door between them; the camera looks through it.
const std::string kTwoRooms = R"(frames: 4
display: [64, 48]
shapes:
  - {id: near, box: [1, 1, 1], position: [2, 1, 1]}
  - {id: far, box: [1, 1, 1], position: [6, 1, 3.4]}
  - {id: wall before the door, box: [0.2, 3, 1], position: [4, 1.5, 0.5]}
  - {id: wall behind the door, box: [0.2, 3, 2], position: [4, 1.5, 3]}
  - {id: wall above the door, box: [0.2, 1, 1], position: [4, 2.5, 1.5]}
camera: {position: [1, 1.5, 3], look_at: [8, 1, 1]}
regulator: {policy: direct}
cells:
  - {name: hall, lo: [0, 0, 0], hi: [4, 3, 4]}
  - {name: store, lo: [4, 0, 0], hi: [8, 3, 4]}
portals:
  - {from: hall, to: store, corners: [[4, 0, 1], [4, 2, 1], [4, 2, 2], [4, 0, 2]]}
)";

class Visibility : public Tool {
 protected:
  void expect_refused(const std::string& from, const std::string& to, const std::string& line,
                      const std::string& what) {
    std::string text = kTwoRooms;
    text.replace(text.find(from), from.size(), to);
    write("bad.yaml", text);
    expect_bad_input("plan bad.yaml" + kSmall, {"bad.yaml:" + line, what, "rule: "});
  }
};

TEST_F(Visibility, BadCellsAndPortalsAreRefusedWithTheirLine) {
  expect_refused("name: store", "name: hall", "13:", "named twice");
  expect_refused("lo: [4, 0, 0]", "lo: [3, 0, 0]", "13:", "overlap");
  expect_refused("hi: [8, 3, 4]", "hi: [4, 3, 4]", "13:", "inside out along x");
  expect_refused("to: store", "to: stor", "15:", "'stor' is no cell");
  expect_refused("to: store", "to: hall", "15:", "one cell twice");
  expect_refused("[4, 2, 2]", "[4.1, 2, 2]", "15:", "off the shared face");
  expect_refused("[4, 2, 2]", "[4, 3.5, 2]", "15:", "outside of 'hall' or 'store'");
  expect_refused("[4, 2, 2]", "[4, 0.2, 1.1]", "15:", "not convex");
  expect_refused("portals:", "visibility: cto,frustum,eye\nportals:", "14:", "visibility");
}

TEST_F(Visibility, TriplesThatCannotBeAreRefused) {
  write("rooms.yaml", kTwoRooms);
  for (const std::string bad : {"eye", "cto,eye", "none,frustum,eye", "cto,eye,eye,eye"})
    expect_bad_input("plan rooms.yaml --visibility " + bad + kSmall,
                     {"--visibility is '" + bad + "', must be PRE,CELL,OBJECT"});
  for (const std::string policy : {"hold", "interpolate", "lookahead", "oracle"})
    expect_bad_input("plan rooms.yaml --visibility cto,eye,eye --policy " + policy + kSmall,
                     {"visibility is cto,eye,eye, but the policy is " + policy});
  std::string without = kTwoRooms.substr(0, kTwoRooms.find("cells:"));
  write("without.yaml", without);
  expect_bad_input("plan without.yaml --visibility cto,eye,eye" + kSmall,
                   {"only none,none,frustum without `cells`"});
}

TEST_F(Visibility, AllTriplesAreMeasuredAndShowTheSame) {
  write("rooms.yaml", kTwoRooms);
  const Outcome outcome =
      run("accuracy --visibility rooms.yaml --frames 0-3 --size 64x48 --progress none --out o");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("cto,eye,eye"));
  EXPECT_THAT(outcome.output, HasSubstr("2 cells, 1 portals"));
  const std::string csv = read("o/visibility.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 22);
}

// Faces that are not opaque are a lie about the scene: the pictures tell, and so does the exit code.
TEST_F(Visibility, ADifferentPictureIsExitCode1) {
  std::string text = kTwoRooms;
  text.erase(text.find("  - {id: wall before"), text.find("camera:") - text.find("  - {id: wall before"));
  write("open.yaml", text);
  EXPECT_EQ(
      run("accuracy --visibility open.yaml --frames 0-3 --size 64x48 --progress none --out o").exit_code, 1);
}

TEST_F(Visibility, StructuresAreMeasured) {
  write("rooms.yaml", kTwoRooms);
  const Outcome outcome =
      run("accuracy --culling rooms.yaml --frames 0-1 --size 64x48 --progress none --out o");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(read("o/culling.csv"), HasSubstr("loose octree"));
}

// Little memory, and how far ahead is best read.
TEST_F(Visibility, MemoryIsMeasuredWithoutAPicture) {
  write("rooms.yaml", kTwoRooms);
  const Outcome outcome = run("accuracy --memory rooms.yaml --progress none --out o");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("1280x1024 px, 5 things in 2 cells"));
  EXPECT_THAT(outcome.output, HasSubstr("Nothing is skipped with any N."));
  const std::string csv = read("o/memory.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 8 * 6);
  EXPECT_THAT(csv, HasSubstr("direction + frustum"));
  EXPECT_THAT(read("o/memory.json"), HasSubstr("talisman.memory/1"));
  EXPECT_THAT(read("o/memory-skipped.svg"), HasSubstr("<svg"));
  EXPECT_THAT(run("accuracy --memory rooms.yaml --memory-mb 0 --progress none --out p").output,
              HasSubstr("Least is skipped with N = 1"));
  expect_bad_input("accuracy --memory rooms.yaml --memory-mb -1", {"memory_mb is -1, must be at least 0"});
  expect_bad_input("accuracy --memory rooms.yaml --io-mb-per-s -0.5",
                   {"io_mb_per_s is -0.5, must be at least 0"});
  expect_bad_input("accuracy --culling rooms.yaml --memory-mb 3",
                   {"--memory-mb and --io-mb-per-s are limits of --memory, must come with it"});
  EXPECT_THAT(run("accuracy --memory rooms.yaml --culling rooms.yaml").output,
              HasSubstr("more than one experiment"));
}

TEST_F(Visibility, CellsAreInspectedAndDrawn) {
  write("rooms.yaml", kTwoRooms);
  const Outcome outcome = run("inspect rooms.yaml --cells --frame 3 --out plans/here.svg");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("2 cells, 1 portals, 5 parts, of which 0 are in no cell"));
  EXPECT_THAT(outcome.output, HasSubstr("the eye is in hall"));
  EXPECT_THAT(outcome.output, HasSubstr("plan: plans/here.svg"));
  EXPECT_THAT(read("plans/here.svg"), HasSubstr("<title>wall above the door</title>"));
  const Outcome json = run("inspect rooms.yaml --cells --json");
  EXPECT_THAT(json.output, HasSubstr("\"cells_seen\""));
  EXPECT_THAT(read("out/rooms-cells.svg"), HasSubstr("</svg>"));
}

TEST_F(Visibility, QuestionsAboutCellsThatCannotBeAnsweredAreRefused) {
  std::string text = kTwoRooms;
  write("rooms.yaml", text);
  text.erase(text.find("cells:"));
  write("without.yaml", text);
  expect_bad_input("inspect without.yaml --cells", {"without.yaml: has no cells, --cells must be asked of"});
  expect_bad_input("inspect rooms.yaml --cells --frame 4", {"--frame is 4, must be 0 … 3"});
  expect_bad_input("inspect rooms.yaml --cells --out plan.png", {"--out is 'plan.png', must be a .svg file"});
  expect_bad_input("inspect rooms.yaml --frame 1",
                   {"--frame is that of the plan of --cells, must come with it"});
  expect_bad_input("inspect rooms.yaml --cells --parts", {"are several questions, must be one"});
}

}  // namespace
}  // namespace talisman
