// SPDX-License-Identifier: Apache-2.0
//
// The canyon as a user plans it: what decisions.jsonl promises over every layer and frame.

#include <atomic>
#include <fstream>
#include <map>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sequences/commands/options.h"
#include "sequences/results/run.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

struct PlannedCanyon {
  std::vector<nlohmann::json> decisions;
  Summary summary;
};

/// Empty decisions if the content is not there.
PlannedCanyon plan_canyon(CommandLine line) {
  PlannedCanyon planned;
  const tests::TemporaryFolder folder;
  try {
    const Sequence canyon = load_sequence("canyon");
    line.out = folder.path();
    line.progress = "none";
    const ResolvedRun resolved = resolve(line, canyon, true);
    const std::atomic<bool> stop = false;
    planned.summary = run(canyon, resolved.settings, resolved.options, stop).summary;
  } catch (const InputError&) {
    return planned;
  }
  std::ifstream file(folder.path() + "/decisions.jsonl");
  for (std::string text; std::getline(file, text);) planned.decisions.push_back(nlohmann::json::parse(text));
  return planned;
}

class PlanOfTheCanyon : public ::testing::TestWithParam<const char*> {};

// At 4 px nothing that is displayed is off by more, whichever policy keeps the bound; and the update rates of
// the table are the counts of the file.
TEST_P(PlanOfTheCanyon, KeepsItsBoundInEveryLayerAndFrame) {
  CommandLine line;
  line.policy = GetParam();
  line.geometric_px = 4;
  const PlannedCanyon planned = plan_canyon(line);
  if (planned.decisions.empty()) GTEST_SKIP() << "content was not fetched";
  ASSERT_EQ(planned.decisions.size(), 250u * 11u);
  std::map<std::string, int> renders;
  for (const nlohmann::json& d : planned.decisions) {
    EXPECT_LE(d["geometric_px"].get<double>(), 4) << d["frame"] << " " << d["layer"];
    EXPECT_FALSE(d["reason"].get<std::string>().empty()) << d["frame"] << " " << d["layer"];
    renders[d["layer"]] += d["decision"] == "rerender";
  }
  for (const LayerSummary& layer : planned.summary.layers)
    EXPECT_EQ(layer.renders, renders[layer.name]) << layer.name;
}
INSTANTIATE_TEST_SUITE_P(Policies, PlanOfTheCanyon, ::testing::Values("threshold", "lookahead", "oracle"),
                         [](const auto& info) { return std::string(info.param); });

// Lookahead and oracle save renders under the same bound; the oracle is the floor.
TEST(PlanOfTheCanyonByPolicy, FewerRendersTheMoreIsKnownAhead) {
  std::map<std::string, int> renders;
  for (const char* policy : {"threshold", "lookahead", "oracle"}) {
    CommandLine line;
    line.policy = policy;
    line.geometric_px = 4;
    const PlannedCanyon planned = plan_canyon(line);
    if (planned.decisions.empty()) GTEST_SKIP() << "content was not fetched";
    for (const LayerSummary& layer : planned.summary.layers) renders[policy] += layer.renders;
  }
  EXPECT_LT(renders["lookahead"], renders["threshold"]);
  EXPECT_LE(renders["oracle"], renders["lookahead"]);
}

}  // namespace
}  // namespace talisman::sequences
