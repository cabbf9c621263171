// SPDX-License-Identifier: Apache-2.0
// A disk that fails once, at each write, sync, rename and new file or folder of a run in turn; and a run that is killed at
// random instants. What is there afterwards is whole, the tool says what it could not write, and --resume ends with the
// files of a run without faults.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <map>
#include <random>
#include <string>
#include <thread>

#include "tests/sequences/commands/tool.h"

namespace talisman {
namespace {

namespace fs = std::filesystem;
using ::testing::AnyOf;
using ::testing::HasSubstr;

/// What depends on the clock, or was made by an earlier process as well.
bool is_comparable(const std::string& file) { return file != "timing.jsonl" && file != "report.html"; }

class DiskFaults : public Tool {
 protected:
  void SetUp() override {
    Tool::SetUp();
    write("passing.yaml", kPassing);
    ASSERT_EQ(run(kRender + "whole --separate").exit_code, 0);
  }
  /// The n-th operation on a file of the folder `out` fails; 0: none.
  std::string disk(int n, const std::string& out) const {
    return on_failing_disk("FAULT_BELOW='" + path(out) + "' FAULT_AT=" + std::to_string(n) +
                           " FAULT_COUNT='" + path("count") + "'");
  }
  /// All files below a folder that two runs of the same must share.
  std::map<std::string, std::string> results(const std::string& out) const {
    std::map<std::string, std::string> all;
    if (!fs::exists(folder_ / out)) return all;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / out)) {
      const std::string name = entry.path().lexically_relative(folder_ / out).string();
      if (entry.is_regular_file() && is_comparable(name)) all[name] = read(out + "/" + name);
    }
    return all;
  }
  void expect_resumed(const std::string& out, const std::string& what) const {
    const Outcome resumed = run(kRender + out + " --separate --resume");
    EXPECT_EQ(resumed.exit_code, 0) << what << "\n" << resumed.output;
    EXPECT_EQ(results(out), results("whole")) << what;
  }

  const std::string kRender =
      "render passing.yaml --frames 0-2 --size 48x36 --progress none --threads 1 --no-thumbnails --out ";
};

TEST_F(DiskFaults, EachOperationOfARunFailsOnce) {
  const Outcome counted = run(kRender + "counted --separate", disk(0, "counted"));
  ASSERT_EQ(counted.exit_code, 0) << counted.output;
  const int operations = std::stoi(read("count"));
  ASSERT_GT(operations, 40) << "run.json, three files of lines, three frames, the summary";
  std::map<int, int> codes;
  for (int n = 1; n <= operations; ++n) {
    const std::string out = "o" + std::to_string(n), what = "operation " + std::to_string(n);
    const Outcome failed = run(kRender + out + " --separate", disk(n, out));
    ++codes[failed.exit_code];
    EXPECT_THAT(failed.exit_code, AnyOf(1, 3)) << what << "\n" << failed.output;
    EXPECT_THAT(failed.output, HasSubstr("error: ")) << what;
    EXPECT_THAT(failed.output, HasSubstr(out)) << what << "\n" << failed.output;
    for (const auto& [name, bytes] : results(out))
      if (name.find(".partial") == std::string::npos && name != ".lock") {
        EXPECT_EQ(bytes, read("whole/" + name)) << what << ": " << name << " is not whole";
      }
    expect_resumed(out, what);
    fs::remove_all(folder_ / out);
  }
  EXPECT_GT(codes[1], 0);
  EXPECT_GT(codes[3], 0) << "once a frame is complete the result is partial";
}

/// Starts the tool in the test's folder and kills it after so long. True: it was killed before its end.
bool killed_after(const std::string& tool, const fs::path& folder, const std::string& arguments,
                  std::chrono::microseconds delay) {
  const std::string command =
      "cd '" + folder.string() + "' && exec '" + tool + "' " + arguments + " > /dev/null 2>&1";
  const pid_t child = ::fork();
  if (child == 0) {
    ::execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
    ::_exit(127);
  }
  std::this_thread::sleep_for(delay);
  ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFSIGNALED(status);
}

TEST_F(DiskFaults, KilledAtRandomInstantsARunIsContinuedToTheSameFiles) {
  const auto began = std::chrono::steady_clock::now();
  ASSERT_EQ(run(kRender + "timed --separate").exit_code, 0);
  const auto whole_us =
      std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - began).count();
  constexpr unsigned kSeed = 21;
  std::mt19937 random(kSeed);
  int killed = 0;
  for (int k = 0; k < 20; ++k) {
    const std::string out = "k" + std::to_string(k);
    const std::chrono::microseconds delay(std::uniform_int_distribution<std::int64_t>(
        whole_us / 10, std::max<std::int64_t>(whole_us, 10))(random));
    killed += killed_after(tool(), folder_, kRender + out + " --separate", delay);
    expect_resumed(out, "killed after " + std::to_string(delay.count()) + " us, seed 21");
  }
  EXPECT_GT(killed, 3) << "most were over before";
}

TEST_F(DiskFaults, FolderThatGoesAwayEndsTheRunWithALine) {
  write("gone.sh", "'" + tool() +
                       "' render passing.yaml --size 48x36 --progress none --no-report --out gone & pid=$!\n"
                       "while [ ! -e gone/frames/0003.png ] && kill -0 $pid; do sleep 0.01; done\nmv gone "
                       "elsewhere\nwait $pid\n");
  const Outcome outcome = run_shell("bash gone.sh");
  EXPECT_THAT(outcome.exit_code, AnyOf(0, 1, 3)) << outcome.output;
  if (outcome.exit_code != 0) {
    EXPECT_THAT(outcome.output, HasSubstr("error: gone"));
  }
  EXPECT_THAT(outcome.output, ::testing::Not(HasSubstr("check failed")));
}

TEST_F(DiskFaults, InterruptedTwiceTheFrameAtWorkIsStillWhole) {
  write("twice.sh", "'" + tool() +
                        "' render passing.yaml --size 48x36 --progress none --separate --out twice & pid=$!\n"
                        "while [ ! -e twice/frames/0002.png ] && kill -0 $pid; do sleep 0.01; done\n"
                        "kill -INT $pid; kill -TERM $pid; kill -INT $pid\nwait $pid\n");
  const Outcome outcome = run_shell("bash -m twice.sh");
  EXPECT_THAT(outcome.exit_code, AnyOf(0, 3)) << outcome.output;
  const Outcome resumed =
      run("render passing.yaml --size 48x36 --progress none --separate --resume --out twice");
  EXPECT_EQ(resumed.exit_code, 0) << resumed.output;
  ASSERT_EQ(run("render passing.yaml --size 48x36 --progress none --separate --out never").exit_code, 0);
  EXPECT_EQ(results("twice"), results("never"));
}

}  // namespace
}  // namespace talisman
