// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/words.h"

#include <gtest/gtest.h>

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
            "--format is '', must be one of png, exr, exr-layers, none");
}

TEST(Alternatives, TheLastIsJoinedByOr) {
  EXPECT_EQ(alternatives(kProgressWords), "auto, bar, plain or none");
  EXPECT_EQ(alternatives(kCyclesWords), "merge or keep");
}

TEST(WordOf, ValuesWithoutAWordGetTheOther) {
  EXPECT_EQ(word_of(layers::OrderGroup{7}, kOrderGroupWords, "own"), "own");
  EXPECT_EQ(word_of(layers::OrderGroup::Background, kOrderGroupWords, "own"), "background");
}

}  // namespace
}  // namespace talisman::sequences
