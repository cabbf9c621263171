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

TEST(SoftwareProfile, ADrawIsPricedByItsTerms) {
  DrawCounts counts;
  counts.vertices = 10;
  counts.polygons = 4;
  counts.pixels = 100;
  counts.lights = 2;
  counts.highlights = 0.5;
  counts.texture_lookups = 7;
  counts.shadow_lookups = 3;
  const DrawWork work = draw_work(counts);
  EXPECT_EQ(work, (DrawWork{1, 10, 20, 100, 200, 50, 7, 3})) << "edge pixels: sqrt(100 * 4)";
  EXPECT_DOUBLE_EQ(draw_ms({1e6, 2e6, 0, 0, 0, 0, 0, 5e6}, work), 1 + 20 + 15);
}

TEST(SoftwareProfile, EdgesAreAtMostAllPixels) {
  DrawCounts specks;
  specks.polygons = 1e6;
  specks.pixels = 9;
  EXPECT_EQ(draw_work(specks)[2], 9);
  EXPECT_EQ(draw_work({}), (DrawWork{1, 0, 0, 0, 0, 0, 0, 0})) << "nothing drawn is a draw all the same";
}

TEST(SoftwareProfile, NoTermIsNegative) {
  for (const double ns : software_1().terms) EXPECT_GT(ns, 0);
  // A square that fills 640x480, one light, no texture: 307,200 of 8.2 + 8.3 ns, 784 edge pixels, one draw.
  EXPECT_NEAR(draw_ms(software_1().terms, draw_work({4, 2, 307200, 1, 0, 0, 0})), 5.25, 0.01);
}

}  // namespace
}  // namespace talisman::regulator
