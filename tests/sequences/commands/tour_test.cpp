// SPDX-License-Identifier: Apache-2.0
// The small sequences of docs/tour.md: what holds for every sequence holds for them, and each shows what its page says.
#include <map>
#include <string>

#include "tests/sequences/commands/tool.h"

namespace talisman {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::ordered_json;

constexpr const char* kTour[] = {"factoring",   "factoring-whole", "warp",         "fiducial",
                                 "blind-spots", "regulator",       "shade-layers", "shade-layers-whole",
                                 "cycles",      "resolution",      "compositor",   "lookahead"};

class Tour : public Tool {
 protected:
  /// Renders by layer.
  std::map<std::string, int> planned(const std::string& arguments) const {
    const Outcome outcome = run("plan tour/" + arguments + " --out p --force --progress none");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    std::map<std::string, int> renders;
    const Json summary = Json::parse(read("p/summary.json"));
    for (const Json& layer : summary["layers"])
      renders[layer["name"].get<std::string>()] = layer["renders"].get<int>();
    return renders;
  }
};

// Reusing only what is identical is drawing everything: the same bytes.
TEST_F(Tour, ThresholdZeroIsTheReference) {
  for (const std::string name : kTour) {
    const std::string size = " --size 96x72 --frames 0-3 --progress none --force ";
    const Outcome zero = run("render tour/" + name + size + "--policy threshold --geometric-px 0 --out zero");
    ASSERT_EQ(zero.exit_code, 0) << zero.output;
    ASSERT_EQ(run("render tour/" + name + size + "--policy reference --out reference").exit_code, 0);
    for (int frame = 0; frame < 4; ++frame) {
      const std::string file = "/frames/000" + std::to_string(frame) + ".png";
      EXPECT_EQ(read("zero" + file), read("reference" + file)) << name << " " << frame;
      EXPECT_FALSE(read("zero" + file).empty()) << name;
    }
  }
}

TEST_F(Tour, EachIsSmallAndNeedsNothing) {
  for (const std::string name : kTour) {
    const Outcome outcome =
        run("plan tour/" + name + " --strict --progress none --force --out p", "TALISMAN_ASSETS=none");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr("of 320x240 px")) << name;
    EXPECT_LE(lines("p/frames.jsonl").size(), 61u) << name;
  }
}

// What the pages conclude, from the counts and not from the tables.
TEST_F(Tour, ConclusionsHold) {
  EXPECT_EQ(planned("factoring")["room"], 1);
  EXPECT_EQ(planned("factoring-whole")["everything"], 24);
  EXPECT_LT(planned("warp --warp per")["board"], planned("warp --warp aff")["board"]);
  EXPECT_LT(planned("warp --warp aff")["board"], planned("warp --warp trn")["board"]);
  EXPECT_EQ(planned("shade-layers")["floor"], 1);
  EXPECT_EQ(planned("shade-layers-whole")["floor"], 36);
  EXPECT_GT(planned("cycles")["wall+ball"], 0);
  EXPECT_EQ(planned("cycles --cycles keep").count("wall+ball"), 0u);
  EXPECT_GT(planned("compositor")["plank a+plank b+plank c"], 0);
  EXPECT_EQ(planned("compositor --compositor extended").count("plank a+plank b+plank c"), 0u);
  EXPECT_LT(planned("lookahead --policy lookahead")["door"], planned("lookahead")["door"]);
  EXPECT_EQ(planned("lookahead --policy lookahead --lookahead 0")["door"], planned("lookahead")["door"]);
}

}  // namespace
}  // namespace talisman
