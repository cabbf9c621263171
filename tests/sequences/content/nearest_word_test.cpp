// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/nearest_word.h"

#include <gtest/gtest.h>

namespace talisman::sequences {
namespace {

const std::vector<std::string> kWords = {"frames", "fps", "display", "fade", "parts"};

TEST(NearestWord, OneEditOfEachKind) {
  EXPECT_EQ(nearest_word("frame", kWords), "frames");    // left out
  EXPECT_EQ(nearest_word("framess", kWords), "frames");  // added
  EXPECT_EQ(nearest_word("frimes", kWords), "frames");   // changed
  EXPECT_EQ(nearest_word("framse", kWords), "frames");   // neighbours exchanged
  EXPECT_EQ(nearest_word("rfames", kWords), "frames");
}

TEST(NearestWord, AsManyEditsAsAThirdOfTheLetters) {
  EXPECT_EQ(nearest_word("frmaez", kWords), "frames");  // two of six
  EXPECT_EQ(nearest_word("frzzzs", kWords), "");        // three of six
  EXPECT_EQ(nearest_word("pfs", kWords), "fps");        // one of three
  EXPECT_EQ(nearest_word("px", kWords), "") << "two letters are too few to guess";
}

TEST(NearestWord, NearestWinsThenTheFirst) {
  EXPECT_EQ(nearest_word("farts", {"frames", "parts", "carts"}), "parts");
  EXPECT_EQ(nearest_word("fades", {"faded", "fade", "fades"}), "fades");
}

TEST(NearestWord, EmptyOnBothSides) {
  EXPECT_EQ(nearest_word("", kWords), "");
  EXPECT_EQ(nearest_word("frames", {}), "");
  EXPECT_EQ(nearest_word("a", {""}), "");
}

}  // namespace
}  // namespace talisman::sequences
