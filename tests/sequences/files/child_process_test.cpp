// SPDX-License-Identifier: Apache-2.0
// Other programs: what they say, how they end, and what they may not use.
#include "sequences/files/child_process.h"

#include <csignal>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using ::testing::HasSubstr;
using tests::TemporaryFolder;

ChildResult limited(const std::vector<std::string>& arguments, const ChildLimits& limits,
                    const std::string& folder = {}) {
  ChildOptions options;
  options.directory = folder;
  options.limits = limits;
  return run_child(arguments, options);
}

TEST(RunChild, SaysWhatItSaidAndHowItEnded) {
  const ChildResult child = run_child({"sh", "-c", "echo one; echo two >&2; exit 7"});
  EXPECT_TRUE(child.started);
  EXPECT_FALSE(child.timed_out);
  EXPECT_EQ(child.exit_code, 7);
  EXPECT_THAT(child.output, HasSubstr("one\n"));
  EXPECT_EQ(child.reason(1), "two");
  EXPECT_FALSE(run_child({"no-such-program-at-all"}).started);
}

TEST(RunChild, WithinItsLimitsItIsAsWithoutThem) {
  const ChildResult child = limited({"sh", "-c", "echo done"}, {60, std::int64_t{1} << 30, 1 << 20});
  EXPECT_TRUE(child.succeeded());
  EXPECT_FALSE(child.timed_out);
  EXPECT_EQ(child.output, "done\n");
}

TEST(RunChild, OfNoProgramNothingStartsWithLimitsToo) {
  const ChildResult child = limited({"no-such-program-at-all"}, {60, 0, 0});
  EXPECT_FALSE(child.started);
  EXPECT_THAT(child.output, HasSubstr("no-such-program-at-all"));
}

TEST(RunChild, ALoopWithoutEndIsEnded) {
  const ChildResult child = limited({"sh", "-c", "while :; do :; done"}, {1, 0, 0});
  EXPECT_TRUE(child.timed_out);
  EXPECT_FALSE(child.succeeded());
}

TEST(RunChild, MoreMemoryThanItMayHaveIsRefused) {
  const std::vector<std::string> large = {"dd", "if=/dev/zero", "of=/dev/null", "bs=512M", "count=1"};
  EXPECT_TRUE(limited(large, {}).succeeded()) << "else this proves nothing";
  const ChildResult child = limited(large, {0, 128 << 20, 0});
  EXPECT_FALSE(child.succeeded());
  EXPECT_FALSE(child.timed_out);
}

TEST(RunChild, ALargerFileThanItMayWriteEndsIt) {
  const TemporaryFolder folder;
  const ChildResult child =
      limited({"dd", "if=/dev/zero", "of=file", "bs=1M", "count=4"}, {0, 0, 1 << 20}, folder.path());
  EXPECT_FALSE(child.succeeded());
  EXPECT_LE(std::filesystem::file_size(folder / "file"), std::uintmax_t{1} << 20);
}

}  // namespace
}  // namespace talisman::sequences
