// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/cache.h"

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;
using tests::TemporaryFolder;

Bytes noise(std::size_t size, unsigned seed) {
  Bytes bytes(size);
  for (std::uint8_t& byte : bytes)
    byte = static_cast<std::uint8_t>((seed = seed * 1664525u + 1013904223u) >> 24);
  return bytes;
}

ContentHash key(int number) { return ContentHasher().add(number).hash(); }

std::string content_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::set<std::string> names_in(const std::string& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
  return names;
}

class CacheTest : public testing::Test {
 protected:
  std::string folder() const { return temporary_.path() + "/made/when needed"; }
  fs::path only_entry() const { return fs::directory_iterator(folder())->path(); }
  std::string entry(int number) const { return folder() + "/thing-" + key(number).hex() + ".entry"; }
  void set_age(int number, int minutes) const {
    fs::last_write_time(entry(number), fs::file_time_type::clock::now() - std::chrono::minutes(minutes));
  }

  const TemporaryFolder temporary_;
  Cache cache_{{folder(), 1}};
};

TEST_F(CacheTest, GivesBackWhatWasStoredUnderKindAndKey) {
  const Bytes content = noise(100000, 1);
  EXPECT_EQ(cache_.load("thing", key(1)), std::nullopt);
  EXPECT_FALSE(fs::exists(folder())) << "nothing to keep yet";
  cache_.store("thing", key(1), content);
  EXPECT_EQ(cache_.load("thing", key(1)), content);
  EXPECT_EQ(Cache({folder(), 1}).load("thing", key(1)), content) << "another program";
  EXPECT_EQ(cache_.load("thing", key(2)), std::nullopt);
  EXPECT_EQ(cache_.load("other", key(1)), std::nullopt);
  cache_.store("thing", key(2), {});
  EXPECT_EQ(cache_.load("thing", key(2)), Bytes());
  EXPECT_EQ(names_in(folder()).size(), 2u) << "no temporary file stays";
}

TEST_F(CacheTest, EveryFlippedByteIsAMissAndTheEntryIsRemoved) {
  const Bytes content = noise(40, 2);
  cache_.store("thing", key(1), content);
  const std::string whole = content_of(only_entry());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string damaged = whole;
    damaged[i] ^= 0x10;
    std::ofstream(entry(1), std::ios::binary) << damaged;
    ASSERT_EQ(cache_.load("thing", key(1)), std::nullopt) << "byte " << i;
    ASSERT_FALSE(fs::exists(entry(1)));
  }
  cache_.store("thing", key(1), content);
  EXPECT_EQ(cache_.load("thing", key(1)), content);
}

TEST_F(CacheTest, CutEmptyAndLongerEntriesAreMisses) {
  cache_.store("thing", key(1), noise(40, 3));
  const std::string whole = content_of(only_entry());
  for (std::size_t length = 0; length < whole.size(); ++length) {
    std::ofstream(entry(1), std::ios::binary) << whole.substr(0, length);
    ASSERT_EQ(cache_.load("thing", key(1)), std::nullopt) << length << " bytes";
  }
  std::ofstream(entry(1), std::ios::binary) << whole + "x";
  EXPECT_EQ(cache_.load("thing", key(1)), std::nullopt);
}

// An entry whose name says something else than it holds: copied by hand, or a damaged folder.
TEST_F(CacheTest, EntryOfAnotherKeyIsAMiss) {
  cache_.store("thing", key(1), noise(40, 4));
  fs::copy(entry(1), entry(2));
  EXPECT_EQ(cache_.load("thing", key(2)), std::nullopt);
  fs::create_directory(entry(3));
  EXPECT_EQ(cache_.load("thing", key(3)), std::nullopt);
}

TEST_F(CacheTest, ConcurrentWritersAndReadersSeeTheWholeContentOrNothing) {
  const Bytes content = noise(200000, 5);
  std::vector<std::thread> threads;
  std::atomic<int> wrong{0}, found{0};
  for (int t = 0; t < 8; ++t)
    threads.emplace_back([&] {
      Cache own({folder(), 1});
      for (int i = 0; i < 20; ++i) {
        own.store("thing", key(1), content);
        const auto seen = own.load("thing", key(1));
        seen == content ? ++found : seen ? ++wrong : 0;
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(found, 0);
  EXPECT_EQ(cache_.load("thing", key(1)), content);
  EXPECT_EQ(names_in(folder()).size(), 1u);
}

TEST_F(CacheTest, BeyondTheLimitTheLeastRecentlyUsedIsDropped) {
  for (const int number : {1, 2}) cache_.store("thing", key(number), noise(400000, 6));
  set_age(1, 30);
  set_age(2, 20);
  EXPECT_TRUE(cache_.load("thing", key(1))) << "from now on it is the younger";
  cache_.store("thing", key(3), noise(400000, 7));
  EXPECT_TRUE(fs::exists(entry(1)));
  EXPECT_FALSE(fs::exists(entry(2)));
  EXPECT_TRUE(fs::exists(entry(3)));
}

TEST_F(CacheTest, LargerThanTheLimitIsNotKept) {
  cache_.store("thing", key(1), noise(1 << 20, 8));
  EXPECT_EQ(cache_.load("thing", key(1)), std::nullopt);
  EXPECT_EQ(cache_.trouble(), "");
}

TEST_F(CacheTest, OnlyItsOwnFilesAreDropped) {
  fs::create_directories(folder());
  std::ofstream(folder() + "/letter.txt") << std::string(2 << 20, 'x');
  const std::string abandoned = folder() + "/.tmp-1-0-thing-0.entry",
                    fresh = folder() + "/.tmp-1-1-thing-0.entry";
  for (const std::string& file : {abandoned, fresh}) std::ofstream(file) << "half";
  fs::last_write_time(abandoned, fs::file_time_type::clock::now() - std::chrono::hours(2));
  cache_.store("thing", key(1), noise(900000, 9));
  EXPECT_TRUE(fs::exists(entry(1)));
  EXPECT_TRUE(fs::exists(folder() + "/letter.txt"));
  EXPECT_TRUE(fs::exists(fresh)) << "somebody writes it";
  EXPECT_FALSE(fs::exists(abandoned)) << "its writer was killed";
}

TEST(Cache, FolderThatCannotBeWrittenIsTroubleAndNoError) {
  const TemporaryFolder folder;
  Cache cache({folder.write("file", "x") + "/cache", 1});
  cache.store("thing", key(1), noise(10, 1));
  EXPECT_EQ(cache.load("thing", key(1)), std::nullopt);
  EXPECT_THAT(cache.trouble(), testing::StartsWith(folder.path() + "/file/cache: "));
  Cache full({"/proc/self/fd", 1});  // a folder in which nobody can make a file
  full.store("thing", key(1), noise(10, 1));
  EXPECT_THAT(full.trouble(), testing::StartsWith("/proc/self/fd: "));
}

TEST(Cache, WithoutAFolderNothingIsKept) {
  Cache none;
  EXPECT_FALSE(none.is_on());
  none.store("thing", key(1), noise(10, 1));
  EXPECT_EQ(none.load("thing", key(1)), std::nullopt);
  EXPECT_EQ(none.trouble(), "");
}

/// Sets a variable for one test.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    value ? ::setenv(name, value, 1) : ::unsetenv(name);
  }
  ~Variable() { before_ ? ::setenv(name_, before_->c_str(), 1) : ::unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

TEST(DefaultCacheFolder, IsWhereTheUserKeepsCachesAndNeverInTheWorkingFolder) {
  const Variable home("HOME", "/home/someone");
  {
    const Variable caches("XDG_CACHE_HOME", "/caches");
    EXPECT_EQ(default_cache_folder(), "/caches/talisman");
  }
  for (const char* useless : {static_cast<const char*>(nullptr), "", "relative"}) {
    const Variable caches("XDG_CACHE_HOME", useless);
    EXPECT_EQ(default_cache_folder(), "/home/someone/.cache/talisman");
    for (const char* nowhere : {static_cast<const char*>(nullptr), "", "here"}) {
      const Variable no_home("HOME", nowhere);
      EXPECT_EQ(default_cache_folder(), "");
    }
  }
}

}  // namespace
}  // namespace talisman::sequences
