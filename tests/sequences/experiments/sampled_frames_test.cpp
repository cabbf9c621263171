// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/sampled_frames.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace talisman::sequences {
namespace {

TEST(SampledFrames, OnePerStratumAndAllOfThemWhenEveryIsOne) {
  for (const int every : {1, 2, 7, 12}) {
    const std::vector<int> frames = sampled_frames({10, 109, every});
    ASSERT_EQ(frames.size(), std::size_t(99 / every + 1)) << every;
    for (std::size_t k = 0; k < frames.size(); ++k) {
      EXPECT_EQ((frames[k] - 10) / every, int(k));
      EXPECT_LE(frames[k], 109);
    }
  }
}

TEST(SampledFrames, MeetEveryPhaseOfEveryHoldAboutEquallyOften) {
  // With a regular stride of 5, hold 5 would be seen at its renders only, and would look perfect. Twenty
  // frames are what the tool draws by default.
  for (const int every : {1, 2, 3, 4, 5, 6, 8, 10, 12, 13, 16})
    for (const int hold : compared_holds()) {
      std::vector<int> hits(hold, 0);
      for (const int frame : sampled_frames({0, 20 * every - 1, every})) ++hits[frame % hold];
      const auto [least, most] = std::minmax_element(hits.begin(), hits.end());
      EXPECT_GE(*least, std::max(1, 20 / hold - 2)) << "every " << every << ", hold " << hold;
      EXPECT_LE(*most, 20 / hold + 2) << "every " << every << ", hold " << hold;
    }
}

TEST(SampledFrames, HaveAPredecessorWhereTheyCan) {
  EXPECT_THAT(sampled_frames({0, 1, 2}), testing::ElementsAre(1));
  EXPECT_THAT(sampled_frames({0, 0, 2}), testing::ElementsAre(0));
}

TEST(SampledFrames, AreDrawnWithTheirPredecessorsEachOnce) {
  using testing::ElementsAre;
  EXPECT_THAT(drawn_frames({0, 3, 1}), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(drawn_frames({5, 5, 9}), ElementsAre(4, 5));
  EXPECT_THAT(drawn_frames({0, 0, 1}), ElementsAre(0)) << "there is none before the first";
}

TEST(SampledFrames, OneFrameIsEnough) { EXPECT_THAT(sampled_frames({5, 5, 9}), testing::ElementsAre(5)); }

TEST(IsSampled, OnlyWhatIsInTheList) {
  EXPECT_TRUE(is_sampled({1, 4, 7}, 4));
  EXPECT_FALSE(is_sampled({1, 4, 7}, 5));
  EXPECT_FALSE(is_sampled({}, 0));
}

}  // namespace
}  // namespace talisman::sequences
