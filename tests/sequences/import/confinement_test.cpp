// SPDX-License-Identifier: Apache-2.0
// What a reader of models may not do, tried by a program that confines itself in the same way.
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/files/child_process.h"
#include "sequences/files/program_folder.h"
#include "sequences/import/confinement.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using tests::TemporaryFolder;

ChildResult tried(const std::string& what, const std::string& file) {
  return run_child({program_folder() + "/confined_child", what, file});
}

TEST(Confinement, NetworkProcessesAndNewFilesAreRefused) {
  const TemporaryFolder folder;
  const std::string there = folder.write("there", "text");
  if (tried("read", there).exit_code == 77) GTEST_SKIP() << tried("read", there).output;
  for (const std::string what :
       {"socket", "local socket", "fork", "exec", "kill", "rename", "unlink", "open to write"})
    EXPECT_EQ(tried(what, there).output, "Operation not permitted\n") << what;
  for (const std::string what : {"creat", "open to make", "mkdir"})
    EXPECT_EQ(tried(what, folder / "new").output, "Operation not permitted\n") << what;
  EXPECT_EQ(folder.names(), std::set<std::string>{"there"});
  EXPECT_EQ(folder.read("there"), "text");
}

// Models have textures beside them, and the picture library has threads.
TEST(Confinement, ReadingAndThreadsAreNot) {
  const TemporaryFolder folder;
  const ChildResult read = tried("read", folder.write("there", "text"));
  if (read.exit_code == 77) GTEST_SKIP() << read.output;
  EXPECT_EQ(read.output, "done\n");
  EXPECT_EQ(tried("thread", "").output, "done\n");
}

TEST(Confinement, OfTheReaderIsTheSame) {
  const ChildResult reader = run_child({importer_program(), kAskForConfinement});
  EXPECT_EQ(reader.exit_code, 0);
  EXPECT_THAT(reader.output, ::testing::StartsWith("limits of time, memory and files"));
}

}  // namespace
}  // namespace talisman::sequences
