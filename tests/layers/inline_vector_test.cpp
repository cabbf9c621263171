// SPDX-License-Identifier: Apache-2.0
#include "layers/inline_vector.h"

#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace talisman::layers {
namespace {

using testing::ElementsAre;
using Small = InlineVector<int, 4>;

TEST(InlineVector, HoldsWhatIsPushedOnBothSidesOfItsRoom) {
  Small values;
  EXPECT_TRUE(values.empty());
  for (int i = 0; i < 4; ++i) values.push_back(i);
  EXPECT_THAT(values, ElementsAre(0, 1, 2, 3));
  values.push_back(4);  // the first that has no room
  EXPECT_THAT(values, ElementsAre(0, 1, 2, 3, 4));
  EXPECT_EQ(values.front(), 0);
  EXPECT_EQ(values.back(), 4);
}

// The element lies in the memory that is given up while it is pushed.
TEST(InlineVector, PushesItsOwnElementWhileItGrows) {
  Small values{7, 1, 2, 3};
  values.push_back(values.front());
  EXPECT_THAT(values, ElementsAre(7, 1, 2, 3, 7));
}

TEST(InlineVector, CopiesAreIndependent) {
  for (const std::size_t count : {0u, 3u, 4u, 9u}) {
    Small original;
    for (std::size_t i = 0; i < count; ++i) original.push_back(static_cast<int>(i));
    Small copy = original, assigned{1, 2, 3, 4, 5, 6, 7};
    assigned = original;
    EXPECT_EQ(copy, original);
    EXPECT_EQ(assigned, original);
    copy.push_back(100);
    EXPECT_EQ(original.size(), count);
    const Small& same = assigned;
    assigned = same;
    EXPECT_EQ(assigned, original);
  }
}

TEST(InlineVector, EqualsOnlyTheSameElements) {
  const Small values{1, 2, 3};
  EXPECT_TRUE(values == std::vector<int>({1, 2, 3}));
  EXPECT_FALSE(values == std::vector<int>({1, 2}));
  EXPECT_FALSE(values == std::vector<int>({1, 2, 4}));
  EXPECT_FALSE(values == std::vector<int>({1, 2, 3, 4}));
}

TEST(InlineVector, BehavesAsAVector) {
  std::mt19937 random(5);
  Small values;
  std::vector<int> expected;
  for (int step = 0; step < 4000; ++step) {
    const int value = static_cast<int>(random() % 1000);
    switch (random() % 8) {
      case 0:
        values.clear(), expected.clear();
        break;
      case 1:
        if (!expected.empty()) values.pop_back(), expected.pop_back();
        break;
      case 2:
        if (expected.size() > 2) values.truncate(2), expected.resize(2);
        break;
      case 3:
        values.append(std::vector<int>{value, value + 1}),
            expected.insert(expected.end(), {value, value + 1});
        break;
      default:
        values.push_back(value), expected.push_back(value);
    }
    ASSERT_EQ(values, expected) << "step " << step;
  }
}

}  // namespace
}  // namespace talisman::layers
