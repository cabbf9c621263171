// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The tool as a user meets it: a program that is started in a folder of its own, for tests.

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace talisman {

/// The tool is built with a sanitizer, as the tests are: its memory is not the tool's, and limits of address space are off.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kIsSanitized = true;
#else
inline constexpr bool kIsSanitized = false;
#endif

struct Outcome {
  int exit_code = -1;
  std::string output;  ///< stdout and stderr
};

class Tool : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("talisman_tool_test_" + std::to_string(getpid()) + "_" + unique_name());
    std::filesystem::create_directories(folder_);
    write("cube.obj", kCube);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  static std::string unique_name() { return ::testing::UnitTest::GetInstance()->current_test_info()->name(); }
  static std::string tool() {
    return (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "talisman").string();
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  std::string read(const std::string& name) const {
    std::ifstream in(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  /// Runs "cd FOLDER && PREFIX talisman ARGUMENTS".
  Outcome run(const std::string& arguments, const std::string& prefix = "") const {
    return run_shell(prefix + " '" + tool() + "' " + arguments);
  }
  Outcome run_shell(const std::string& shell) const {
    const std::string command = "cd '" + folder_.string() + "' && " + shell + " 2>&1";
    std::FILE* pipe = popen(command.c_str(), "r");
    Outcome outcome;
    char buffer[4096];
    for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;)
      outcome.output.append(buffer, n);
    const int status = pclose(pipe);
    outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return outcome;
  }

  /// What stands before a command that runs on a disk with faults (tests/sequences/faults/failing_disk.cpp). The address
  /// sanitizer would else insist on being loaded first.
  static std::string on_failing_disk(const std::string& settings) {
    const std::string shim = std::filesystem::path(tool()).parent_path().string() + "/failing_disk.so";
    return "env ASAN_OPTIONS=\"verify_asan_link_order=0:$ASAN_OPTIONS\" LD_PRELOAD='" + shim + "' " +
           settings;
  }

  /// Runs the tool, which gets the signal in the very operation that makes `file`: on any machine at the same instant.
  Outcome run_and_signal(const std::string& arguments, const std::string& file, int signal) const {
    Outcome outcome =
        run(arguments, on_failing_disk("SIGNAL_AT='" + path(file) + "' SIGNAL=" + std::to_string(signal)));
    if (signal == SIGKILL) {
      EXPECT_EQ(outcome.exit_code, 128 + SIGKILL) << file << " was not made";
    }
    return outcome;
  }

  /// Expects exit code 2 and exactly one error line that holds all of `parts`.
  void expect_bad_input(const std::string& arguments, const std::vector<std::string>& parts) const {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments << "\n" << outcome.output;
    EXPECT_EQ(outcome.output.rfind("error: ", 0), 0u) << outcome.output;
    EXPECT_EQ(outcome.output.find('\n'), outcome.output.size() - 1)
        << "one line, and nothing behind it: " << outcome.output;
    for (const std::string& part : parts)
      EXPECT_THAT(outcome.output, ::testing::HasSubstr(part)) << arguments;
  }

  std::set<std::string> files_in(const std::string& name) const {
    std::set<std::string> names;
    if (std::filesystem::exists(folder_ / name))
      for (const auto& entry : std::filesystem::directory_iterator(folder_ / name))
        names.insert(entry.path().filename().string());
    return names;
  }

  std::vector<std::string> frame_hashes(const std::string& out) const {
    std::vector<std::string> hashes;
    std::ifstream in(folder_ / out / "frames.jsonl");
    for (std::string line; std::getline(in, line);)
      hashes.push_back(nlohmann::json::parse(line)["frame_hash"]);
    return hashes;
  }

  std::vector<std::string> lines(const std::string& name) const {
    std::vector<std::string> lines;
    std::ifstream in(folder_ / name, std::ios::binary);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
  }

  static constexpr const char* kCube =
      "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
      "f 5 6 7 8\nf 2 1 4 3\nf 6 2 3 7\nf 1 5 8 4\nf 8 7 3 4\nf 1 2 6 5\n";

  /// A ball passes through a wall again and again, beside a lamp: aggregates and shadows come and go.
  static constexpr const char* kPassing =
      "frames: 40\nfps: 1\ndisplay: [480, 360]\n"
      "shapes:\n  - {id: wall, box: [1, 4, 4], color: [0.6, 0.5, 0.4]}\n"
      "  - {id: ball, sphere: 2, flight: [{t: 0, position: [5, 0, 0], target: [-100, 0, 0]},"
      " {t: 10, position: [-5, 0, 0], target: [-100, 0, 0]}, {t: 20, position: [5, 0, 0], target: [-100, 0, "
      "0]},"
      " {t: 30, position: [-5, 0, 0], target: [-100, 0, 0]}]}\n"
      "camera: {fov_deg: 60, near_m: 1, far_m: 100, position: [2, 1, 12], look_at: [0, 0, 0]}\n"
      "lights:\n  - {kind: ambient, color: [0.3, 0.3, 0.3]}\n"
      "  - {kind: spot, name: lamp, position: [9, 7, 3], look_at: [0, 0, 0], inner_deg: 30, outer_deg: 40,"
      " casts_shadow: true}\n"
      "layers:\n  - {name: wall, parts: [wall], shading: {shadows: {}}}\n  - {name: ball, parts: [ball]}\n";

  std::filesystem::path folder_;
};

}  // namespace talisman
