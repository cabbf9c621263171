// SPDX-License-Identifier: Apache-2.0
#include "regulator/refresh_ledger.h"

#include <gtest/gtest.h>

namespace talisman::regulator {
namespace {

TEST(RefreshLedger, TheFirstTimeChunksAreTried) {
  const RefreshLedger fresh = after_whole({}, 10);
  EXPECT_TRUE(asks_for_chunks(fresh));
  EXPECT_TRUE(pays(fresh, 11, 0.6));
  EXPECT_TRUE(pays(fresh, 25, 1.0));
  EXPECT_FALSE(pays(fresh, 25, 1.01)) << "dearer than all of it";
}

TEST(RefreshLedger, GoesOnWhileAFrameCostsLessThanFramesHaveCost) {
  // Drawn at 0, off at 2; from then on a third of it is off in every frame. Whole: 1/2 a frame. With chunks the mean falls
  // towards 1/3, which it never reaches.
  RefreshLedger ledger = after_whole({}, 0);
  for (int frame = 2; frame < 60; ++frame) {
    ASSERT_TRUE(pays(ledger, frame, 1.0 / 3)) << frame;
    ledger = after_chunks(ledger, frame, 1.0 / 3);
  }
  EXPECT_NEAR(ledger.spent, 58.0 / 3, 1e-9);
}

TEST(RefreshLedger, EndsWhereAFrameCostsMoreAndRemembersThat) {
  // It has lasted for ten frames, at a tenth a frame; then half of it is off in every frame.
  RefreshLedger ledger = after_whole({}, 0);
  ledger = after_chunks(ledger, 10, 0.5);
  EXPECT_FALSE(pays(ledger, 11, 0.5));  // 0.5 a frame > 1.5 / 11
  ledger = after_whole(ledger, 11);
  EXPECT_FALSE(asks_for_chunks(ledger)) << "1.5 for 11 frames is more than 1 for 10";
  ledger = after_whole(ledger, 21);
  EXPECT_TRUE(asks_for_chunks(ledger)) << "one render was skipped";
  ledger = after_chunks(ledger, 31, 0.5);
  ledger = after_whole(ledger, 32);
  for (int skipped = 0; skipped < 3; ++skipped) {  // 1, 3, 7, …
    EXPECT_FALSE(asks_for_chunks(ledger));
    ledger = after_whole(ledger, 40 + 10 * skipped);
  }
  EXPECT_TRUE(asks_for_chunks(ledger));
}

TEST(RefreshLedger, ASuccessForgetsFailures) {
  RefreshLedger ledger = after_whole({}, 0);
  ledger = after_whole(after_chunks(ledger, 10, 0.5), 11);
  ledger = after_whole(ledger, 21);
  ledger = after_whole(after_chunks(ledger, 31, 0.2), 60);  // 1.2 for 39 frames, not 1 for 10
  EXPECT_TRUE(asks_for_chunks(ledger));
  EXPECT_EQ(ledger.wait, 0);
}

TEST(RefreshLedger, WhatIsHopelessIsAskedAboutMoreAndMoreRarely) {
  RefreshLedger ledger = after_whole({}, 0);
  int asked = 0;
  for (int frame = 1; frame <= 100; ++frame) {
    if (asks_for_chunks(ledger)) {
      ++asked;
      ledger.hopeless = true;
    }
    ledger = after_whole(ledger, frame);
  }
  EXPECT_LE(asked, 10);
  EXPECT_GE(asked, 6);
}

}  // namespace
}  // namespace talisman::regulator
