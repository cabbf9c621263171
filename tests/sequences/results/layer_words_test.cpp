// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/layer_words.h"

#include <gtest/gtest.h>

namespace talisman::sequences {
namespace {

TEST(LayerWords, ColumnIsTwentyFourCharactersWide) {
  EXPECT_EQ(column_of("sky"), "sky                     ");
  EXPECT_EQ(column_of("123456789012345678901234"), "123456789012345678901234");
  EXPECT_EQ(column_of("1234567890123456789012345"), "123456789012345678901...");
  EXPECT_EQ(column_of(""), std::string(24, ' '));
}

TEST(LayerWords, CharactersAreNotCutNorCountedTwice) {
  std::string name;
  for (int k = 0; k < 25; ++k) name += "é";  // two bytes each
  std::string cut;
  for (int k = 0; k < 21; ++k) cut += "é";
  EXPECT_EQ(column_of(name), cut + "...");
  EXPECT_EQ(column_of("Tür"), "Tür" + std::string(21, ' '));
}

TEST(LayerWords, PicturesHaveNoFolders) {
  EXPECT_EQ(picture_of("wall/shadow of sun"), "wall-shadow of sun.png");
  EXPECT_EQ(picture_of(17, "a/b/c"), "0017-a-b-c.png");
}

}  // namespace
}  // namespace talisman::sequences
