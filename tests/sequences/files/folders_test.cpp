// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/folders.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using ::testing::HasSubstr;

void begin(const std::string& path) { begin_report_folder(path, "report.json", "a report"); }

std::string refusal(const std::string& path) {
  try {
    begin(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(ReportFolder, NewAndEmptyOnesAreTaken) {
  const tests::TemporaryFolder folder;
  begin(folder.path() + "/new/one");
  EXPECT_TRUE(std::filesystem::exists(folder.path() + "/new/one/report.json.partial"));
  std::filesystem::create_directory(folder.path() + "/empty");
  EXPECT_EQ(refusal(folder.path() + "/empty"), "");
}

TEST(ReportFolder, OneOfOursIsTakenAgainWhetherItWasFinishedOrKilled) {
  const tests::TemporaryFolder folder;
  const std::string path = folder.path() + "/mine";
  begin(path);
  EXPECT_EQ(refusal(path), "") << "killed";
  folder.write("mine/report.json", "{}");
  finish_report_folder(path, "report.json");
  EXPECT_FALSE(std::filesystem::exists(path + "/report.json.partial"));
  EXPECT_EQ(refusal(path), "") << "finished";
}

TEST(ReportFolder, OthersFilesAreNotTouched) {
  const tests::TemporaryFolder folder;
  folder.write("theirs/video.mp4", "a holiday");
  EXPECT_THAT(refusal(folder.path() + "/theirs"), HasSubstr("holds files that are not of a report"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() + "/theirs/report.json.partial"));
  folder.write("file", "no folder");
  EXPECT_THAT(refusal(folder.path() + "/file"), HasSubstr("holds files that are not of a report"));
}

}  // namespace
}  // namespace talisman::sequences
