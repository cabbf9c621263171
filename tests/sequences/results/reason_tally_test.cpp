// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/reason_tally.h"

#include <gtest/gtest.h>

namespace talisman::sequences {
namespace {

TEST(ReasonTally, TheMostFrequentKindComesWithItsMedian) {
  ReasonTally tally;
  tally.add("first_appearance");
  for (const char* reason :
       {"geometric 4.7 > 4 px", "geometric 18 > 4 px (0.845 of place + 1.675 of its own shadow)",
        "geometric 30 > 4 px; old shadow map of sun"})
    tally.add(reason);
  EXPECT_EQ(tally.text(), "geometric 18 px, 3 of 4");
  EXPECT_EQ(tally.total(), 4);
}

TEST(ReasonTally, KindsWithoutNumbersAndOfEqualFrequency) {
  ReasonTally tally;
  EXPECT_EQ(tally.text(), "");
  EXPECT_EQ(tally.most_frequent(), nullptr);
  tally.add("policy: hold 3");
  tally.add("first_appearance");
  EXPECT_EQ(tally.text(), "policy: hold 3, 1 of 2");  // the first to come
  EXPECT_FALSE(tally.most_frequent()->median());
}

TEST(ReasonTally, WordsBeforeTheNumberMakeTheKind) {
  ReasonTally tally;
  tally.add("sampling: minification 0.4 < 0.5");
  tally.add("sampling: magnification 1.75 > 1.5");
  tally.add("sampling: magnification 1.6 > 1.5");
  tally.add("photometric 0.08 > 0.05 (light 'sun')");
  tally.add("changed, geometric threshold 0 px");
  EXPECT_EQ(tally.text(), "sampling: magnification 1.75, 2 of 5");
}

TEST(ReasonTally, UnitStandsBehindTheLimit) {
  ReasonTally tally;
  tally.add("photometric: light angle 0.31 > 0.2 rad (highlights: the eye)");
  EXPECT_EQ(tally.text(), "photometric: light angle 0.31 rad, 1 of 1");
}

}  // namespace
}  // namespace talisman::sequences
