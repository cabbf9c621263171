// SPDX-License-Identifier: Apache-2.0
// The derived figures of the published rates, as regression tests of the profile.
#include "regulator/profile.h"

#include <gtest/gtest.h>

namespace talisman::regulator {
namespace {

TEST(Talisman1996, CompositorReachesAboutThreeLayersOfDepthAt75Hz) {
  // 1344 × 1024 × 75 = 103.2 Mpixel/s against 320 Mpixel/s: mean depth 3.1.
  const double display = 1344.0 * 1024 * 75;
  EXPECT_NEAR(talisman_1996().compositor_pixels_per_s / display, 3.1, 0.01);
}

TEST(Talisman1996, RendererReachesAboutFortyPercentOfAScreenPerRefresh) {
  const double pixels_per_frame = talisman_1996().renderer_pixels_per_s / 75;
  EXPECT_NEAR(pixels_per_frame / (1344.0 * 1024), 0.39, 0.005);
}

TEST(Talisman1996, EveryNumberHasASourceAndNamesAreUnique) {
  for (const ProfileNumber& a : talisman_1996().numbers) {
    EXPECT_FALSE(a.source.empty()) << a.name;
    int same_name = 0;
    for (const ProfileNumber& b : talisman_1996().numbers) same_name += a.name == b.name;
    EXPECT_EQ(same_name, 1) << a.name;
  }
}

TEST(ModelledTime, SlowestOfTheParallelStagesDecides) {
  const HardwareProfile& p = talisman_1996();
  const ModelledTime fill_bound = modelled_time(p, 10, 400'000, 320'000);
  EXPECT_DOUBLE_EQ(fill_bound.render_ms, 10);
  EXPECT_DOUBLE_EQ(fill_bound.composite_ms, 1);
  EXPECT_DOUBLE_EQ(fill_bound.frame_ms, 10);
  EXPECT_DOUBLE_EQ(modelled_time(p, 15'000, 0, 0).frame_ms, 10) << "polygon bound";
  EXPECT_DOUBLE_EQ(modelled_time(p, 0, 0, 3'200'000).frame_ms, 10) << "compositor bound";
  EXPECT_DOUBLE_EQ(modelled_time(p, 0, 0, 0).frame_ms, 0);
}

}  // namespace
}  // namespace talisman::regulator
