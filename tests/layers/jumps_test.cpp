// SPDX-License-Identifier: Apache-2.0
#include "layers/jumps.h"

#include <cmath>

#include <gmock/gmock.h>

namespace talisman::layers {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Scene scene_of(TransformTrack track) {
  Scene scene;
  scene.nodes.push_back({"n", -1, {}});
  scene.tracks = {{0, std::move(track)}};
  return scene;
}

TransformTrack jump_keys(std::vector<double> times, const std::vector<double>& x,
                         Interpolation interpolation = Interpolation::Linear) {
  TransformTrack track;
  track.translation.times_s = std::move(times);
  for (const double value : x) track.translation.values.push_back({value, 0, 0});
  track.translation.interpolation = interpolation;
  return track;
}

TEST(Jumps, AreKeysThatDifferWithinANanosecond) {
  const double after = std::nextafter(2.0, 3.0);
  EXPECT_THAT(jumps_of(scene_of(jump_keys({0, 2, after, 3}, {0, 5, -5, 0})), 9), ElementsAre(after));
  EXPECT_THAT(jumps_of(scene_of(jump_keys({0, 2, after, 3}, {0, 5, 5, 0})), 9), IsEmpty());
  EXPECT_THAT(jumps_of(scene_of(jump_keys({0, 2, 2.001, 3}, {0, 5, -5, 0})), 9), IsEmpty())
      << "fast, not at once";
}

TEST(Jumps, OfStepsAreAllKeysThatDiffer) {
  EXPECT_THAT(jumps_of(scene_of(jump_keys({0, 1, 2, 3}, {0, 1, 1, 4}, Interpolation::Step)), 9),
              ElementsAre(1, 3));
}

TEST(Jumps, OfWhatRepeatsComeAgain) {
  TransformTrack track = jump_keys({0, 1, 2}, {0, 1, 3});
  track.loop = true;
  EXPECT_THAT(jumps_of(scene_of(track), 5), ElementsAre(2, 4, 6));
  track.translation.values.back() = track.translation.values.front();
  EXPECT_THAT(jumps_of(scene_of(track), 5), IsEmpty());
}

TEST(Jumps, AnyBetweenTakesTheEndAndNotTheBeginning) {
  const std::vector<double> jumps = {1, 3};
  EXPECT_TRUE(any_between(jumps, 0.5, 1));
  EXPECT_FALSE(any_between(jumps, 1, 2));
  EXPECT_TRUE(any_between(jumps, 2, 4));
  EXPECT_FALSE(any_between(jumps, 3, 9));
  EXPECT_FALSE(any_between({}, 0, 9));
}

}  // namespace
}  // namespace talisman::layers
