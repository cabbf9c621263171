// SPDX-License-Identifier: Apache-2.0
// `reproduce` from the command to its files.
#include "sequences/commands/reproduce.h"

#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sequences/files/errors.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using testing::HasSubstr;

ReproduceOptions options_for(const std::string& out, const std::vector<std::string>& only) {
  ReproduceOptions options;
  options.quick = true;
  options.only = only;
  options.out = out;
  options.progress = "none";
  return options;
}

TEST(RunReproduce, AnItemThatNeedsNoContentIsMeasured) {
  const tests::TemporaryFolder folder;
  std::ostringstream out;
  EXPECT_EQ(run_reproduce(options_for(folder.path() + "/r", {"LS97:appendix"}), out), kSuccess) << out.str();
  EXPECT_THAT(out.str(), HasSubstr("3 rows say yes, 0 no, 0 are not measured"));
  EXPECT_EQ(nlohmann::json::parse(folder.read("r/reproduce.json"))["yes"], 3);
}

// All rows, all figures; those whose content was not fetched say so.
TEST(RunReproduce, AQuickRunMeasuresEveryRowThatHasItsContent) {
  const tests::TemporaryFolder folder;
  std::ostringstream out;
  const int code = run_reproduce(options_for(folder.path() + "/r", {}), out);
  const auto json = nlohmann::json::parse(folder.read("r/reproduce.json"));
  int failed = 0;
  for (const auto& item : json["items"])
    for (const auto& row : item["rows"]) {
      failed += row["same"] == false && row["must"] == true;
      EXPECT_FALSE(row["same"] == false && row["why"].is_null()) << row["id"] << " says no without a reason";
    }
  EXPECT_EQ(code, failed > 0 ? kFailed : json["not_measured"] > 0 ? kPartialResult : kSuccess) << out.str();
  for (const auto& item : json["items"])
    for (const auto& figure : item["figures"])
      EXPECT_THAT(folder.read("r/" + figure["file"].get<std::string>()), HasSubstr("<svg"));
}

TEST(RunReproduce, RefusesWhatItDoesNotKnowBeforeItMakesAFolder) {
  const tests::TemporaryFolder folder;
  std::ostringstream out;
  EXPECT_THAT(tests::message_of([&] { run_reproduce(options_for(folder.path() + "/r", {"LS98"}), out); }),
              HasSubstr("--only is 'LS98', must be one of LS97, LS97:15"));
  ReproduceOptions loud = options_for(folder.path() + "/r", {});
  loud.progress = "loud";
  EXPECT_THAT(tests::message_of([&] { run_reproduce(loud, out); }), HasSubstr("--progress is 'loud'"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() + "/r"));
}

TEST(RunReproduce, TakesNoFolderThatHoldsOthersFiles) {
  const tests::TemporaryFolder folder;
  folder.write("thesis.txt", "years of work");
  std::ostringstream out;
  EXPECT_THROW(run_reproduce(options_for(folder.path(), {"LS97:appendix"}), out), InputError);
  EXPECT_EQ(folder.read("thesis.txt"), "years of work");
}

}  // namespace
}  // namespace talisman::sequences
