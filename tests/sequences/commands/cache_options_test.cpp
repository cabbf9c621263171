// SPDX-License-Identifier: Apache-2.0
// The words --cache, --no-cache and --cache-mb, and output that cannot be written.
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/sequences/commands/tool.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Of a file that changed a moment ago nothing is kept (file_uses.h), and the tool may be quicker than that.
constexpr auto kSettled = std::chrono::milliseconds(100);

class CacheOptions : public testing::Test {
 protected:
  CacheOptions() {
    folder_.write("tetra.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    std::this_thread::sleep_for(kSettled);
  }
  /// In a folder of its own, without a home.
  Outcome run(const std::string& command, const std::string& redirection = "2>&1") const {
    const std::string tool = (fs::read_symlink("/proc/self/exe").parent_path() / "talisman").string();
    const std::string shell = "cd '" + folder_.path() + "' && env -u HOME -u XDG_CACHE_HOME " + environment_ +
                              " '" + tool + "' " + command + " " + redirection;
    Outcome outcome;
    std::FILE* pipe = ::popen(shell.c_str(), "r");
    std::array<char, 4096> buffer;
    while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe))
      outcome.output.append(buffer.data(), n);
    outcome.exit_code = WEXITSTATUS(::pclose(pipe));
    return outcome;
  }
  std::size_t entries(const std::string& folder) const {
    const std::string path = folder_.path() + "/" + folder;
    if (!fs::exists(path)) return 0;
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(path), fs::directory_iterator()));
  }

  const tests::TemporaryFolder folder_;
  std::string environment_;
};

TEST_F(CacheOptions, ModelsAreKeptWhereTheUserSaysAndTheOutputIsTheSame) {
  const Outcome without = run("inspect tetra.obj --no-cache");
  ASSERT_EQ(without.exit_code, 0) << without.output;
  for (int i = 0; i < 2; ++i) {
    const Outcome kept = run("inspect --cache kept tetra.obj");
    EXPECT_EQ(kept.exit_code, 0);
    EXPECT_EQ(kept.output, without.output);
    EXPECT_EQ(entries("kept"), 1u);
  }
  EXPECT_EQ(entries("."), 2u) << "the model and that folder";
}

TEST_F(CacheOptions, DefaultIsTheUsersCacheAndWithoutAHomeThereIsNone) {
  EXPECT_EQ(run("inspect tetra.obj").exit_code, 0);
  EXPECT_EQ(entries("."), 1u);
  environment_ = "XDG_CACHE_HOME='" + folder_.path() + "/caches'";
  EXPECT_EQ(run("inspect tetra.obj").exit_code, 0);
  EXPECT_EQ(entries("caches/talisman"), 1u);
  environment_ = "HOME='" + folder_.path() + "'";
  EXPECT_EQ(run("inspect tetra.obj --no-cache").exit_code, 0);
  EXPECT_EQ(entries(".cache/talisman"), 0u);
  EXPECT_EQ(run("inspect tetra.obj").exit_code, 0);
  EXPECT_EQ(entries(".cache/talisman"), 1u);
}

TEST_F(CacheOptions, FolderThatCannotBeWrittenIsAWarning) {
  const Outcome outcome = run("inspect tetra.obj --cache tetra.obj/cache", "2>&1 >/dev/null");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.output, StartsWith("warning: cache "));
  EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1);
  environment_ = "XDG_CACHE_HOME='" + folder_.path() + "/tetra.obj'";
  EXPECT_EQ(run("inspect tetra.obj", "2>&1 >/dev/null").output, "") << "nobody asked for it";
}

TEST_F(CacheOptions, BadWordsExitWithTwo) {
  for (const char* words : {"--cache-mb 0", "--cache-mb -3", "--cache-mb many", "--cache ''"}) {
    const Outcome outcome = run(std::string("inspect tetra.obj ") + words);
    EXPECT_EQ(outcome.exit_code, 2) << words;
    EXPECT_THAT(outcome.output, StartsWith("error: ")) << words;
    EXPECT_THAT(outcome.output, HasSubstr("--cache")) << words;
  }
}

TEST_F(CacheOptions, ProgramsAtTheSameTimeShareACache) {
  const Outcome without = run("inspect tetra.obj --no-cache");
  std::array<Outcome, 4> outcomes;
  std::vector<std::thread> programs;
  for (Outcome& outcome : outcomes)
    programs.emplace_back([&] { outcome = run("inspect tetra.obj --cache kept"); });
  for (std::thread& program : programs) program.join();
  for (const Outcome& outcome : outcomes) {
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(outcome.output, without.output);
  }
  EXPECT_EQ(entries("kept"), 1u);
}

// A full device takes no byte; what a command printed there is lost, and it must not say that all is well.
TEST(StandardOutput, ThatCannotBeWrittenIsExitCodeOne) {
  const std::string tool = (fs::read_symlink("/proc/self/exe").parent_path() / "talisman").string();
  for (const char* words : {"inspect --profile", "--help", "inspect carousel --json", "inspect --help"}) {
    const std::string shell = "'" + tool + "' " + words + " 2>&1 >/dev/full";
    std::FILE* pipe = ::popen(shell.c_str(), "r");
    std::array<char, 1000> message{};
    EXPECT_GT(std::fread(message.data(), 1, message.size() - 1, pipe), 0u);
    EXPECT_EQ(WEXITSTATUS(::pclose(pipe)), 1) << words;
    EXPECT_THAT(message.data(), HasSubstr("error: standard output: cannot be written")) << words;
  }
}

}  // namespace
}  // namespace talisman
