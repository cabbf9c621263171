// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What the tests of all experiments ask of their options, files and tables.

#include <functional>
#include <initializer_list>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/commands/experiment_options.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::tests {

/// Few frames, small pictures, nothing on the terminal.
inline sequences::ExperimentOptions quick_options(const std::string& frames, const std::string& size,
                                                  int quality_every = 0) {
  return {"", frames, size, quality_every, "none"};
}

inline void expect_files(const TemporaryFolder& folder, std::initializer_list<const char*> names) {
  for (const char* name : names) EXPECT_GT(folder.read(name).size(), 100u) << name;
}

template <typename Report>
std::string printed(const Report& report) {
  return plain_text(page_of(report));
}

/// All of the texts are in the table, and no number that is none.
inline void expect_table(const std::string& table, std::initializer_list<const char*> texts) {
  for (const char* text : texts) EXPECT_THAT(table, testing::HasSubstr(text));
  EXPECT_EQ(table.find("nan"), std::string::npos);
}

/// `measure` must refuse each wrong option by its name and value.
inline void expect_bad_options_named(
    const sequences::ExperimentOptions& right,
    const std::function<void(const sequences::ExperimentOptions&)>& measure) {
  const auto complaint = [&](auto change) {
    sequences::ExperimentOptions options = right;
    change(options);
    return message_of([&] { measure(options); });
  };
  using testing::HasSubstr;
  EXPECT_THAT(complaint([](auto& o) { o.frames = "3-99"; }), HasSubstr("--frames is '3-99'"));
  EXPECT_THAT(complaint([](auto& o) { o.size = "64"; }), HasSubstr("--size is '64'"));
  EXPECT_THAT(complaint([](auto& o) { o.quality_every = -1; }), HasSubstr("--quality-every is -1"));
  EXPECT_THAT(complaint([](auto& o) { o.progress = "loud"; }), HasSubstr("--progress is 'loud'"));
}

}  // namespace talisman::tests
