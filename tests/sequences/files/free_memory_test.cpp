// SPDX-License-Identifier: Apache-2.0
// What limits a process, in a made-up /proc and /sys.
#include "sequences/files/free_memory.h"

#include <gtest/gtest.h>

#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

constexpr std::int64_t kB = 1024;

TEST(FreeMemory, IsWhatTheMachineHasAndItsSwap) {
  const tests::TemporaryFolder root;
  root.write("proc/meminfo",
             "MemTotal: 900 kB\nMemFree:  10 kB\nMemAvailable:     600 kB\nSwapFree: 50 kB\n");
  EXPECT_EQ(free_memory_bytes(root.path()), 650 * kB);
}

TEST(FreeMemory, IsWhatTheNarrowestGroupLeaves) {
  const tests::TemporaryFolder root;
  root.write("proc/meminfo", "MemAvailable: 600 kB\n");
  root.write("proc/self/cgroup", "0::/a/b\n");
  root.write("sys/fs/cgroup/a/b/memory.max", "max\n");
  root.write("sys/fs/cgroup/a/b/memory.current", "7\n");
  EXPECT_EQ(free_memory_bytes(root.path()), 600 * kB) << "no limit";
  root.write("sys/fs/cgroup/a/memory.max", "5000\n");
  root.write("sys/fs/cgroup/a/memory.current", "4200\n");
  EXPECT_EQ(free_memory_bytes(root.path()), 800) << "of the group above";
  root.write("sys/fs/cgroup/a/memory.current", "6000\n");
  EXPECT_EQ(free_memory_bytes(root.path()), 0) << "more than it may have";
}

TEST(FreeMemory, WhatIsNotSaidLimitsNothing) {
  const tests::TemporaryFolder root;
  EXPECT_EQ(free_memory_bytes(root.path()), std::nullopt);
  for (const char* text : {"MemAvailable:", "MemAvailable: many kB\n", "MemAvailable: -3 kB\n",
                           "MemAvailable: 99999999999999999999 kB\n"}) {
    root.write("proc/meminfo", text);
    EXPECT_EQ(free_memory_bytes(root.path()), std::nullopt) << text;
  }
  root.write("proc/meminfo", "MemAvailable: 9223372036854775807 kB\n");
  EXPECT_GT(free_memory_bytes(root.path()), INT64_MAX / 2);
  root.write("proc/self/cgroup", "no group\n");
  root.write("proc/self/status", "VmRSS:\t    12 kB\n");
  EXPECT_EQ(held_memory_bytes(root.path()), 12 * kB);
  EXPECT_EQ(held_memory_bytes(root.path() + "/none"), 0);
}

TEST(FreeMemory, OfThisProcessIsKnown) {
  EXPECT_GT(held_memory_bytes(), 1'000'000);
  EXPECT_GT(free_memory_bytes().value_or(0), 0);
}

}  // namespace
}  // namespace talisman::sequences
