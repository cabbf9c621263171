// SPDX-License-Identifier: Apache-2.0
// One run per folder: whoever comes second is told, and what a dead run left is no obstacle.
#include "sequences/files/folder_lock.h"

#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/files/errors.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using ::testing::HasSubstr;

TEST(FolderLock, SecondOwnerIsToldWhoHasIt) {
  const tests::TemporaryFolder folder;
  const std::string out = folder / "out";
  std::optional<FolderLock> first(out);
  try {
    const FolderLock second(out);
    FAIL() << "two owners at once";
  } catch (const OutputError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("is being written by another run (process " + std::to_string(::getpid())));
  }
  first.reset();
  EXPECT_NO_THROW(FolderLock{out});
  EXPECT_TRUE(std::filesystem::is_empty(out)) << "the file goes with its owner";
}

// A killed process leaves the file, but not the lock.
TEST(FolderLock, WhatAKilledOwnerLeftIsTakenOver) {
  const tests::TemporaryFolder folder;
  const std::string out = folder / "out";
  const pid_t child = ::fork();
  if (child == 0) {
    new FolderLock(out);
    ::_exit(0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(std::filesystem::exists(out + "/.lock"));
  EXPECT_NO_THROW(FolderLock{out});
}

TEST(FolderLock, FolderBelowAFileIsBadInput) {
  const tests::TemporaryFolder folder;
  folder.write("file", "x");
  EXPECT_THROW(FolderLock(folder / "file/out"), InputError);
}

}  // namespace
}  // namespace talisman::sequences
