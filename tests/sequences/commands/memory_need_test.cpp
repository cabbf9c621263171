// SPDX-License-Identifier: Apache-2.0
// Runs that do not fit into memory say so before they start, and what they say is near the truth.
#include "sequences/results/memory/memory_need.h"

#include "sequences/commands/options.h"
#include "sequences/commands/run_words.h"
#include "sequences/files/errors.h"
#include "tests/sequences/commands/peak_memory.h"
#include "tests/sequences/commands/tool.h"

namespace talisman {
namespace {

using namespace sequences;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::int64_t kMB = 1'000'000;

TEST(MemoryWarning, IsSaidWhereTheEstimateIsMoreThanWhatIsFreeAndRefusedWhereHalfIs) {
  MemoryNeed need;
  need.content = 700 * kMB;  // held already
  need.sprites = 60 * kMB;
  need.pictures = 30 * kMB;
  need.kept_frames = 10 * kMB;
  EXPECT_EQ(memory_warning(need, 100 * kMB), "");
  EXPECT_THAT(memory_warning(need, 99 * kMB), HasSubstr("some 100 MB"));
  EXPECT_THAT(memory_warning(need, 50 * kMB), HasSubstr("50 MB are free"));
  EXPECT_THROW(memory_warning(need, 49 * kMB), InputError);
  EXPECT_THROW(memory_warning(need, 0), InputError);
}

class MemoryNeeded : public Tool {
 protected:
  /// Estimate and peak, bytes, both without what the smallest run takes.
  std::pair<std::int64_t, std::int64_t> estimate_and_peak(std::vector<std::string> words,
                                                          const std::string& size) const {
    const std::vector<std::string> common{"--frames=0-4", "--quiet", "--no-report", "--force"};
    words.insert(words.end(), common.begin(), common.end());
    std::vector<std::string> small{"render", "carousel", "--size=32x32", "--out=" + path("small")};
    std::vector<std::string> large{"render", "carousel", "--size=" + size, "--out=" + path("large")};
    small.insert(small.end(), words.begin(), words.end());
    large.insert(large.end(), words.begin(), words.end());
    const long peak_kB = tests::peak_memory_kB(tool(), large) - tests::peak_memory_kB(tool(), small);
    static const Sequence sequence = load_sequence("carousel");
    const auto line = command_line_from("carousel", {large.begin() + 2, large.end()}, false);
    const auto run = resolve(line, sequence, false);
    const MemoryNeed need = memory_need(sequence, run.settings, run.options);
    return {need.total() - need.content, peak_kB * std::int64_t{1024}};
  }
};

TEST_F(MemoryNeeded, IsWithinTwiceThePeak) {
  if (kIsSanitized) GTEST_SKIP() << "a sanitizer takes memory of its own";
  constexpr std::int64_t kLittle = 24 * kMB;  // frames that might be looked at ahead
  for (const char* size : {"1024x768", "2048x1536", "4096x3072"})
    for (const auto& words : {std::vector<std::string>{"--format=none"},
                              {"--format=none", "--policy=direct"},
                              {"--format=none", "--policy=lookahead"},
                              {"--format=png"}}) {
      const auto [estimate, peak] = estimate_and_peak(words, size);
      EXPECT_GT(2 * estimate, peak) << size << " " << words.back();
      EXPECT_LT(estimate, 2 * peak + kLittle) << size << " " << words.back();
    }
}

TEST_F(MemoryNeeded, WhatCannotFitIsRefusedBeforeAnythingIsTouched) {
  if (kIsSanitized) GTEST_SKIP() << "a sanitizer's address space is larger than any limit";
  const Outcome refused =
      run("render carousel --size 16384x16384 --frames 0 --quiet --out o", "ulimit -v 1500000;");
  EXPECT_EQ(refused.exit_code, 2) << refused.output;
  EXPECT_THAT(refused.output, HasSubstr("error: the run needs some "));
  EXPECT_THAT(refused.output, HasSubstr("rule: at most twice what is free"));
  EXPECT_FALSE(std::filesystem::exists(path("o")));
  const Outcome fits = run("render carousel --size 320x240 --frames 0 --quiet --out o", "ulimit -v 1500000;");
  EXPECT_EQ(fits.exit_code, 0) << fits.output;
  EXPECT_THAT(fits.output, Not(HasSubstr("memory")));
}

TEST_F(MemoryNeeded, TheOracleSaysWhatAFrameTakes) {
  write("long.yaml",
        "frames: 100000\nfps: 10\ndisplay: [64, 48]\nshapes:\n  - {id: ball, sphere: 1}\n"
        "camera: {fov_deg: 60, near_m: 1, far_m: 100, position: [0, 1, 9], look_at: [0, 0, 0]}\n");
  const Outcome said = run("plan long.yaml --policy oracle --frames 0 --quiet --out o");
  EXPECT_EQ(said.exit_code, 0) << said.output;
  EXPECT_THAT(said.output, HasSubstr("warning: policy oracle keeps each frame that it looks at, "));
  EXPECT_THAT(run("plan long.yaml --policy lookahead --frames 0 --quiet --out o --force").output,
              Not(HasSubstr("keeps")));
}

}  // namespace
}  // namespace talisman
