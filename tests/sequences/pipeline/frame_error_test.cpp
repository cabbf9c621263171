// SPDX-License-Identifier: Apache-2.0
// The mean error of a frame, by hand.
#include "sequences/pipeline/frame_error.h"

#include <gtest/gtest.h>

namespace talisman::sequences {
namespace {

using layers::dmat3;

/// x' = scale · x + shift.
dmat3 moved(double scale, double x, double y) { return {scale, 0, 0, 0, scale, 0, x, y, 1}; }

/// Layers 0 and 1 are shown with errors of 1 and 3 px, layer 2 is out of view.
FrameReport report_of_two() {
  FrameReport report;
  report.display_px = {100, 50};
  report.plan.decisions.resize(3);
  const double px[] = {1, 3, 9};
  for (int k = 0; k < 3; ++k) {
    report.plan.decisions[k].layer = k;
    report.plan.decisions[k].action = k < 2 ? regulator::Action::Reuse : regulator::Action::Drop;
    report.plan.decisions[k].shown_geometric_px = px[k];
  }
  report.shown.push_back({0, moved(1, 10, 10), {10, 20}, 0, {}});  // 200 px²
  report.shown.push_back({1, moved(2, 80, 0), {30, 30}, 0, {}});   // 60 × 60 px, of which 20 × 50 are seen
  return report;
}

TEST(FrameError, IsTheMeanOfTheLayersInView) { EXPECT_DOUBLE_EQ(error_of(report_of_two()).mean_px, 2); }

TEST(FrameError, ByPixelsWeighsEachLayerByWhatItsSpriteCoversOfTheDisplay) {
  EXPECT_DOUBLE_EQ(error_of(report_of_two()).mean_by_pixels_px, (200 * 1 + 1000 * 3) / 1200.0);
}

TEST(FrameError, IsZeroWhereNothingIsInView) {
  FrameReport report = report_of_two();
  report.shown.clear();
  for (auto& decision : report.plan.decisions) decision.action = regulator::Action::Drop;
  EXPECT_EQ(error_of(report).mean_px, 0);
  EXPECT_EQ(error_of(report).mean_by_pixels_px, 0);
}

// A sprite beside the display, one of no size, and a map that is all zeros.
TEST(CoveredPx, IsNothingOfWhatIsNotSeen) {
  EXPECT_EQ(covered_px(moved(1, 200, 0), {10, 10}, {100, 50}), 0);
  EXPECT_EQ(covered_px(moved(1, 0, 0), {0, 10}, {100, 50}), 0);
  EXPECT_EQ(covered_px(dmat3(0.0), {10, 10}, {100, 50}), 0);
}

TEST(CoveredPx, IsAtMostTheDisplay) {
  EXPECT_DOUBLE_EQ(covered_px(moved(100, -5000, -5000), {1000, 1000}, {100, 50}), 100 * 50);
}

// w = 1 - y / 20: the rows from 20 on lie behind the eye. Before it (0, y) is at y / w, which grows without end, so the
// part that is seen reaches the lower edge of the display: x' from 0 to 10 / w.
TEST(CoveredPx, LeavesOutWhatAPerspectiveMapThrowsBehindTheEye) {
  dmat3 map(1.0);
  map[1][2] = -1.0 / 20;
  // In the rows y' of the display w = 1 / (1 + y' / 20), so the sprite is 10 (1 + y' / 20) wide: from 0 to 40 rows 10 … 30.
  EXPECT_NEAR(covered_px(map, {10, 30}, {100, 40}), 40 * 20, 1e-3);
}

TEST(SpriteDepth, IsWhatAllSpritesCoverOverTheDisplay) {
  EXPECT_DOUBLE_EQ(sprite_depth(report_of_two()), 1200.0 / 5000);
}

}  // namespace
}  // namespace talisman::sequences
