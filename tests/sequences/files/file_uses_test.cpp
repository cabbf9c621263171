// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/file_uses.h"

#include <chrono>
#include <filesystem>
#include <thread>

#include <gtest/gtest.h>

#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using tests::TemporaryFolder;

/// Longer than the clock of the file system may stand still.
void let_it_settle() { std::this_thread::sleep_for(std::chrono::milliseconds(50)); }

FileUse use_of(const std::string& path) {
  FileUses uses;
  uses.look_for(path);
  return uses.take().at(0);
}

FileUse names_of(const std::string& path) {
  FileUses uses;
  uses.list(path);
  return uses.take().at(0);
}

TEST(FileUses, ContentIsSeenAndAChangeOfTheSameSizeIsNoticed) {
  const TemporaryFolder folder;
  const std::string file = folder.write("a", "one");
  let_it_settle();
  const FileUse use = use_of(file);
  EXPECT_EQ(use.kind, FileUse::Kind::Content);
  EXPECT_TRUE(is_unchanged(use));
  EXPECT_EQ(seen_now(use), hash_of_file(file));
  const auto before = seen_now(use);
  folder.write("a", "two");
  EXPECT_FALSE(is_unchanged(use));
  EXPECT_NE(seen_now(use), before);
  std::filesystem::remove(file);
  EXPECT_FALSE(is_unchanged(use));
  EXPECT_EQ(seen_now(use), std::nullopt);
}

TEST(FileUses, AMissingFileIsMissedUntilItIsThere) {
  const TemporaryFolder folder;
  const FileUse use = use_of(folder.path() + "/later");
  EXPECT_EQ(use.kind, FileUse::Kind::Missing);
  EXPECT_TRUE(is_unchanged(use));
  EXPECT_NE(seen_now(use), std::nullopt);
  folder.write("later", "");
  EXPECT_FALSE(is_unchanged(use));
  EXPECT_EQ(seen_now(use), std::nullopt);
}

TEST(FileUses, NamesInAFolderAndTheirKindCount) {
  const TemporaryFolder folder;
  folder.write("in/a", "1");
  let_it_settle();
  const FileUse use = names_of(folder.path() + "/in");
  const auto before = seen_now(use);
  folder.write("in/a", "another content");
  EXPECT_TRUE(is_unchanged(use));
  EXPECT_EQ(seen_now(use), before);
  folder.write("in/b", "1");
  EXPECT_FALSE(is_unchanged(use));
  EXPECT_NE(seen_now(use), before);
  std::filesystem::remove(folder.path() + "/in/b");
  EXPECT_EQ(seen_now(use), before);
  std::filesystem::remove(folder.path() + "/in/a");
  std::filesystem::create_directory(folder.path() + "/in/a");
  EXPECT_NE(seen_now(use), before) << "a folder is no file of that name";
}

TEST(FileUses, AFolderThatIsNotThereHasNoNames) {
  const TemporaryFolder folder;
  const FileUse use = names_of(folder.path() + "/in");
  const auto before = seen_now(use);
  EXPECT_TRUE(is_unchanged(use));
  folder.write("in/a", "1");
  EXPECT_FALSE(is_unchanged(use));
  EXPECT_NE(seen_now(use), before);
}

TEST(FileUses, EachPathOnceAndTheCodeThatAsks) {
  const TemporaryFolder folder;
  FileUses uses;
  for (int i = 0; i < 3; ++i) uses.look_for(folder.path() + "/a"), uses.list(folder.path());
  uses.add_code();
  const auto all = uses.take();
  ASSERT_GT(all.size(), 3u) << "two, the program and at least the C library";
  EXPECT_EQ(all[2].kind, FileUse::Kind::Code);
  EXPECT_EQ(all[2].path, std::filesystem::read_symlink("/proc/self/exe").string());
  for (std::size_t i = 2; i < all.size(); ++i)
    EXPECT_TRUE(std::filesystem::is_regular_file(all[i].path)) << all[i].path;
}

}  // namespace
}  // namespace talisman::sequences
