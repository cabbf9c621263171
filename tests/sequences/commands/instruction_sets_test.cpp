// SPDX-License-Identifier: Apache-2.0
// The tool under every instruction set of this machine: it says which, and draws the same.
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

}  // namespace
}  // namespace talisman
