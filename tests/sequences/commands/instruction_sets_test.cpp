// SPDX-License-Identifier: Apache-2.0
// The tool under every instruction set of this machine, and with its jobs in other orders: it draws the same.
#include <sstream>

#include "tests/sequences/commands/tool.h"

namespace talisman {
namespace {

using ::testing::HasSubstr;

class InstructionSets : public Tool {
 protected:
  /// As the tool lists them.
  std::vector<std::string> names() const {
    const Outcome refused = run("--version", "TALISMAN_SIMD=MMX");
    EXPECT_EQ(refused.exit_code, 2);
    const std::string before = "error: TALISMAN_SIMD is 'MMX', must be one of ";
    EXPECT_THAT(refused.output, ::testing::StartsWith(before));
    std::istringstream words(refused.output.substr(std::min(before.size(), refused.output.size())));
    std::vector<std::string> names;
    for (std::string name; words >> name;) names.push_back(name.substr(0, name.find(',')));
    return names;
  }
};

TEST_F(InstructionSets, DrawTheSame) {
  write("passing.yaml", kPassing);
  const std::vector<std::string> sets = names();
  ASSERT_FALSE(sets.empty());
  std::string first;
  for (const std::string& set : sets) {
    const std::string with = "TALISMAN_SIMD=" + set;
    EXPECT_THAT(run("--version", with).output, HasSubstr("simd: " + set + "\n"));
    const Outcome drawn =
        run("render passing.yaml --frames 0-3 --size 96x64 --quiet --no-report --out " + set, with);
    ASSERT_EQ(drawn.exit_code, 0) << drawn.output;
    const std::string frames = read(set + "/frames.jsonl");
    EXPECT_THAT(frames, HasSubstr("\"frame_hash\":\""));
    if (first.empty()) first = frames;
    EXPECT_EQ(frames, first) << set;
  }
}

using JobOrders = Tool;

TEST_F(JobOrders, DrawTheSame) {
  write("passing.yaml", kPassing);
  std::string first;
  for (const char* order : {"0", "1", "7", "4294967295"}) {
    const std::string out = std::string("order-") + order;
    const Outcome drawn =
        run("render passing.yaml --frames 0-3 --size 160x130 --quiet --no-report --out " + out,
            std::string("TALISMAN_ORDER=") + order);
    ASSERT_EQ(drawn.exit_code, 0) << drawn.output;
    const std::string frames = read(out + "/frames.jsonl");
    EXPECT_THAT(frames, HasSubstr("\"frame_hash\":\""));
    if (first.empty()) first = frames;
    EXPECT_EQ(frames, first) << order;
  }
  for (const char* order : {"-1", "", "4294967296", "1x", "nan"}) {
    const Outcome refused = run("--version", std::string("TALISMAN_ORDER='") + order + "'");
    EXPECT_EQ(refused.exit_code, 2) << order;
    EXPECT_THAT(refused.output, ::testing::StartsWith("error: TALISMAN_ORDER is '")) << order;
  }
}

}  // namespace
}  // namespace talisman
