// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/words.h"

#include <gtest/gtest.h>

#include "sequences/commands/nearest_word.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

TEST(Choice, EveryWordIsReadAndPrintedBack) {
  for (const auto& word : kPolicyWords) {
    EXPECT_EQ(choice("--policy", word.text, kPolicyWords), word.value);
    EXPECT_EQ(word_of(word.value, kPolicyWords), word.text);
  }
  EXPECT_EQ(choice("--bound", "dop14", kBoundWords), layers::BoundKind::Dop14);
  EXPECT_EQ(choice("--color-warp", "off", kSwitchWords), false);
}

TEST(Choice, UnknownWordsAreRefusedWithTheKnownOnes) {
  EXPECT_EQ(tests::message_of([] { choice("--bound", "ball", kBoundWords); }),
            "--bound is 'ball', must be one of box8, dop14, dop26");
  EXPECT_EQ(tests::message_of([] { choice("--format", "", kFormatWords); }),
            "--format is '', must be one of png, exr, none");
}

TEST(Alternatives, TheLastIsJoinedByOr) {
  EXPECT_EQ(alternatives(kProgressWords), "auto, bar, plain or none");
  EXPECT_EQ(alternatives(kCyclesWords), "merge or keep");
}

TEST(WordOf, ValuesWithoutAWordGetTheOther) {
  EXPECT_EQ(word_of(layers::OrderGroup{7}, kOrderGroupWords, "own"), "own");
  EXPECT_EQ(word_of(layers::OrderGroup::Background, kOrderGroupWords, "own"), "background");
}

TEST(EditDistance, CountsLettersAddedLeftOutChangedAndSwapped) {
  EXPECT_EQ(edit_distance("render", "render"), 0);
  EXPECT_EQ(edit_distance("rendr", "render"), 1);
  EXPECT_EQ(edit_distance("rendder", "render"), 1);
  EXPECT_EQ(edit_distance("rander", "render"), 1);
  EXPECT_EQ(edit_distance("redner", "render"), 1);
  EXPECT_EQ(edit_distance("", "plan"), 4);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
}

TEST(NearestWord, IsEmptyWhereNothingIsNear) {
  const std::vector<std::string> known{"render", "plan", "inspect"};
  EXPECT_EQ(nearest_word("rendr", known), "render");
  EXPECT_EQ(nearest_word("plna", known), "plan");
  EXPECT_EQ(nearest_word("pln", known), "plan");
  EXPECT_EQ(nearest_word("frobnicate", known), "");
  EXPECT_EQ(nearest_word("", known), "");
}

}  // namespace
}  // namespace talisman::sequences
